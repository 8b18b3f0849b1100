"""Work that is only worth doing for the newest state."""

import asyncio

import pytest

from dalembert.studio.latest import Latest


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
