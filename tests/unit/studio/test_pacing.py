"""Work that is repeated: for the newest state alone, or in a part of the time."""

import asyncio

import pytest

from dalembert.studio.pacing import Latest, Throttle


@pytest.mark.parametrize("pause", [0.0, 0.001])
def test_requests_during_the_work_become_one_more_turn(monkeypatch, pause):
    state, seen = [0], []

    async def work():
        seen.append(state[0])
        await asyncio.sleep(0.01)

    async def changes():
        latest = Latest(work, pause)
        for wait in (0.0, 0.005, 0.0, 0.05):
            state[0] += 1
            latest()
            await asyncio.sleep(wait)

    monkeypatch.setattr("nicegui.background_tasks.create", asyncio.ensure_future)
    asyncio.run(changes())
    assert seen == [1, 4] if pause == 0 else seen[-1] == 4


def test_the_work_waits_for_a_pause(monkeypatch):
    state, seen = [0], []

    async def work():
        seen.append(state[0])

    async def changes():
        latest = Latest(work, 0.1)
        for _ in range(5):
            state[0] += 1
            latest()
            await asyncio.sleep(0.002)
        await asyncio.sleep(0.5)

    monkeypatch.setattr("nicegui.background_tasks.create", asyncio.ensure_future)
    asyncio.run(changes())
    assert seen == [5]


def test_work_waits_until_it_takes_its_part_of_the_time() -> None:
    now = 0.0
    throttle = Throttle(0.05, lambda: now)
    for begins in (0.0, 40.0):
        now = begins
        assert throttle.is_due
        with throttle.work():
            now = begins + 2.0
        for after, due in ((begins + 2.0, False), (begins + 39.9, False), (begins + 40.0, True)):
            now = after
            assert throttle.is_due == due


def test_work_that_fails_has_taken_its_time_too() -> None:
    times = iter([0.0, 1.0, 1.5])
    throttle = Throttle(0.5, lambda: next(times))
    with pytest.raises(ZeroDivisionError), throttle.work():
        1 / 0  # noqa: B018
    assert not throttle.is_due
