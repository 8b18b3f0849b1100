"""Work that is repeated: for the newest state alone, or in a part of the time."""

import asyncio
from types import SimpleNamespace

import pytest

from dalembert.studio.pacing import Latest, Throttle


@pytest.fixture(autouse=True)
def tasks(monkeypatch):
    """Tasks in the background are those of the test's event loop."""
    monkeypatch.setattr("nicegui.background_tasks.create", asyncio.ensure_future)


async def idle() -> None:
    """Let all tasks go on until each of them waits."""
    for _ in range(20):
        await asyncio.sleep(0.0)


def test_requests_during_the_work_become_one_more_turn():
    seen = []

    async def changes():
        state, done = 0, asyncio.Event()

        async def work():
            seen.append(state)
            await done.wait()

        latest = Latest(work)
        for state in range(1, 5):  # noqa: B007 - the work reads it
            latest()
            await idle()
        done.set()
        await idle()

    asyncio.run(changes())
    assert seen == [1, 4]


def test_the_work_waits_for_a_pause(monkeypatch):
    seen, pauses = [], []

    async def sleep(seconds):
        pauses.append((seconds, asyncio.Event()))
        await pauses[-1][1].wait()

    monkeypatch.setattr("dalembert.studio.pacing.asyncio", SimpleNamespace(sleep=sleep))

    async def changes():
        state = 0

        async def work():
            seen.append(state)

        latest = Latest(work, 0.1)
        for state in range(1, 6):  # noqa: B007 - the work reads it
            latest()
            await idle()
        assert seen == []
        pauses[0][1].set()  # requests came meanwhile, so that another pause begins
        await idle()
        assert seen == []
        pauses[1][1].set()
        await idle()

    asyncio.run(changes())
    assert seen == [5]
    assert [seconds for seconds, _ in pauses] == [0.1, 0.1]


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
