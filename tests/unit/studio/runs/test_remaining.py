"""How long the stage of a run still takes."""

from pathlib import Path

import pytest

from dalembert.studio.runs.live import Live, Remaining

STEP = {"event": "iteration", "start": 0, "best": 1.0, "values": [1.0], "samples": 9}


def at(second: float) -> dict:
    return {"at": f"2026-01-01T00:00:{second:06.3f}+00:00"}


def searched(left: Remaining, *simulations: int, begin: float = 0.0) -> str:
    """What is said after iterations, one a second."""
    for second, count in enumerate(simulations):
        left.take(STEP | at(begin + second) | {"simulations": count}, 0, None)
    return left.sentence()


def drawn(left: Remaining, *draws: int, of: int = 100, every: float = 1.0) -> str:
    """What is said after draws, some a second."""
    for number, count in enumerate(draws):
        left.take({"event": "drawn", "draws": count, "of": of} | at(every * number), count, of)
    return left.sentence()


def test_it_is_known_from_the_speed_where_the_amount_of_work_is_settled():
    assert drawn(Remaining(), 10, 20) == ""
    assert drawn(Remaining(), 10, 20, 30, 40) == "about 6 s left in this stage"
    assert drawn(Remaining(), 70, 80, 90, 100) == ""
    assert drawn(Remaining(), 10, 20, 30, 40, every=0.0) == ""


def test_a_search_that_stops_where_it_converges_has_none():
    assert searched(Remaining(), 0, 20, 40, 60, 80) == ""


def test_a_swarm_has_a_settled_number_of_simulations_and_what_follows_it_has_none():
    left = Remaining(planned=260)
    assert searched(left, 0, 20, 40, 60) == "about 10 s left in this stage"
    for second in range(5):
        profiled = {"event": "profiled", "parameter": "c", "simulations": 3 * second}
        left.take(profiled | at(10 + second), 0, None)
    assert left.sentence() == ""


def test_a_speed_that_changes_is_not_extrapolated():
    assert drawn(Remaining(), 1, 2, 3, 4, 14, 24) == ""
    assert drawn(Remaining(), 10, 20, 30, 38, 46, 54) != ""


def test_each_stage_has_its_speed():
    left = Remaining()
    drawn(left, 10, 20, 30, 40, of=1000, every=0.1)
    for number, runs in enumerate((2, 4, 6)):
        left.take({"event": "ran", "method": "vertex", "runs": runs, "most": 64} | at(10 + number), runs, 64)
    assert left.sentence() == ""
    left.take({"event": "ran", "method": "vertex", "runs": 8, "most": 64} | at(13), 8, 64)
    assert left.sentence() == "about 28 s left in this stage"


def test_what_was_repeated_after_a_pause_does_not_count():
    left = Remaining(planned=1000)
    assert searched(left, 0, 100, 200, 300) != ""
    left.begin()
    assert searched(left, 300, 300, 301, begin=10.0) == ""


@pytest.mark.parametrize("kind", ["run-resumed", "run-compiling"])
def test_a_run_that_goes_on_begins_anew(kind):
    live = Live(Path("events.jsonl"))
    for second in range(4):
        live._take({"event": "drawn", "draws": 10 * second, "of": 100} | at(second))
    assert live.remaining.sentence() != ""
    live._take({"event": kind, "done": 1, "total": 2} | at(5))
    assert live.remaining.sentence() == ""
