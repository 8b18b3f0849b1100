"""A run's events as a page reads them while they come."""

import json

from dalembert.studio.live import POINTS, SHOWN, Live


def line(number: int, **details: object) -> str:
    event = {
        "n": number,
        "event": "iteration",
        "start": 0,
        "simulations": number,
        "best": 1 / (number + 1),
        "samples": 9,
    }
    return json.dumps(event | {"values": [float(number)]} | details) + "\n"


def test_events_are_read_once_and_only_whole_lines(tmp_path):
    path = tmp_path / "events.jsonl"
    live = Live(path)
    assert not live.advance()
    path.write_text(line(0) + line(1)[:20])
    assert live.advance()
    assert live.count == 1
    assert not live.advance()
    path.write_text(line(0) + line(1))
    assert live.advance()
    assert (live.count, live.best, live.values) == (2, 0.5, [1.0])
    live.name(("rate",))
    path.write_text(line(0) + line(1) + line(2))
    live.advance()
    assert live.progress[0] == "start 1 · 2 simulations · best 0.3333 · rate = 2"


def test_a_long_run_keeps_a_short_curve(tmp_path):
    path = tmp_path / "events.jsonl"
    path.write_text("".join(line(number) for number in range(10_000)))
    live = Live(path)
    live.advance()
    assert live.count == 10_000
    assert POINTS // 2 <= len(live.convergence) <= POINTS
    assert len(live.recent) == SHOWN
    assert live.best == 1e-4
    assert [y for _, y in live.convergence] == sorted((y for _, y in live.convergence), reverse=True)


def test_a_fitness_over_more_samples_begins_another_curve(tmp_path):
    path = tmp_path / "events.jsonl"
    path.write_text(line(0, best=1e-9, samples=4) + line(1, best=0.1, samples=9))
    live = Live(path)
    live.advance()
    assert (live.best, live.convergence) == (0.1, [(1, 0.1)])
