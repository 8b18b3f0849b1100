"""Work beside a run takes a part of the time."""

import pytest

from dalembert.studio.sparing import Sparing


def test_work_waits_until_it_takes_its_part_of_the_time() -> None:
    now = 0.0
    sparing = Sparing(0.05, lambda: now)
    for begins in (0.0, 40.0):
        now = begins
        assert sparing.is_due
        with sparing.work():
            now = begins + 2.0
        for after, due in ((begins + 2.0, False), (begins + 39.9, False), (begins + 40.0, True)):
            now = after
            assert sparing.is_due == due


def test_work_that_fails_has_taken_its_time_too() -> None:
    times = iter([0.0, 1.0, 1.5])
    sparing = Sparing(0.5, lambda: next(times))
    with pytest.raises(ZeroDivisionError), sparing.work():
        1 / 0  # noqa: B018
    assert not sparing.is_due
