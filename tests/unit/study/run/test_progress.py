"""What a user sees of a run while it goes on."""

import io

import pytest
from rich.console import Console

from dalembert.study.run.progress import ProgressText, Watch


def _printed(event: dict, names: tuple[str, ...] = ()) -> str:
    stream = io.StringIO()
    with Watch(Console(file=stream, width=200), names) as watch:
        watch(event)
    return stream.getvalue().rstrip("\n")


@pytest.mark.parametrize(
    ("event", "text"),
    [
        ({"event": "ran", "method": "scan", "runs": 128, "failed": 0, "most": 441}, "scan · 128 simulations"),
        ({"event": "ran", "method": "scan", "runs": 9, "failed": 2, "most": 9}, "scan · 9 simulations, 2 failed"),
        ({"event": "sampled", "runs": 45, "simulations": 57}, "surrogate · 45 simulations"),
        (
            {"event": "checked", "runs": 8, "simulations": 93, "misfit": 3e-7, "error": 9.3e-6},
            "check by 8 simulations · wrong by 9.3e-06",
        ),
        ({"event": "checked", "runs": 8, "simulations": 9, "misfit": None, "error": None}, "check by 8 simulations"),
        (
            {"event": "paved", "inside": 3, "boundary": 4, "waiting": 5},
            "3 boxes inside, 4 on the boundary, 5 to look at",
        ),
        (
            {"event": "penalised", "round": 2, "of": 8, "weight": 108.5, "simulations": 401},
            "round 2 of at most 8 · weight 108 · 401 simulations",
        ),
        ({"event": "simulating", "end": 2.0}, "simulating to 2 s"),
        ({"event": "run-damaged", "message": "checkpoint is damaged"}, "checkpoint is damaged"),
        (
            {"event": "balanced", "parameter": "push", "value": 3.8, "points": 7, "stable": True},
            "push = 3.8 · 7 equilibria",
        ),
        (
            {"event": "swept", "parameter": "a", "value": 0.5, "done": 3, "total": 9, "failure": None},
            "a = 0.5 · 3 of 9",
        ),
        (
            {"event": "followed", "frequency": 12.5, "amplitude": 0.002, "dof": "m.x", "done": 0.374},
            "12.5 Hz · m.x 0.002 m · 37% of the way",
        ),
        ({"event": "run-started", "task": "propagate"}, ""),
    ],
)
def test_events_are_told_in_a_line(event, text):
    assert _printed(event) == text


ITERATION = {"event": "iteration", "start": 0, "iteration": 2, "simulations": 85, "best": 2.5, "values": [0.75]}


def test_many_values_are_told_in_part():
    names = tuple(f"k{number}" for number in range(1, 12))
    told = _printed(ITERATION | {"values": [1.0] * 11}, names)
    assert told.endswith("k7 = 1, k8 = 1, and 3 more")


def test_segments_are_told_with_what_is_minimised():
    told = _printed(ITERATION | {"minimised": 4.5, "gap": 0.013}, ("mass",))
    minimised = "minimised 4.5 = misfit 2.5 + weighted gaps, largest gap 0.013"
    assert told == f"start 1 · 85 simulations · {minimised} · mass = 0.75"


def test_a_growing_horizon_says_why_the_best_rises():
    told = _printed(ITERATION | {"samples": 25, "of": 100}, ("mass",))
    horizon = "first 25 of 100 samples; the best misfit grows with their number"
    assert told == f"start 1 · 85 simulations · {horizon} · best 2.5 · mass = 0.75"
    assert "samples" not in _printed(ITERATION | {"samples": 100, "of": 100}, ("mass",))


def test_the_best_values_have_the_names_of_the_unknowns():
    event = {"event": "iteration", "start": 0, "iteration": 2, "simulations": 85, "best": 1e-6, "values": [0.75, 0.05]}
    told = _printed(event, ("theta1 middle", "theta1 radius"))
    assert told == "start 1 · 85 simulations · best 1e-06 · theta1 middle = 0.75, theta1 radius = 0.05"


def test_values_are_listed_in_their_units():
    told = ProgressText(("angle", "drag"), units={"angle": ("mrad", 1e-3)})
    told.take({"event": "iteration", "start": 0, "simulations": 3, "best": 0.5, "values": [0.25, 0.1]})
    assert told.last[0] == "start 1 · 3 simulations · best 0.5 · angle = 250 mrad, drag = 0.1"
