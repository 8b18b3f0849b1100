"""A bar between two places is the bar of that length and angle, in Python and in study files."""

from pathlib import Path

import numpy as np
import pytest

import dalembert as da
from dalembert.study import load
from support import says

START, END = (0.1, 0.2), (-0.5, 1.0)
LENGTH, ANGLE = 1.0, np.pi - np.arctan2(0.8, 0.6)
TIMES = np.linspace(0.0, 0.3, 4)
CHANNELS = ["bar.end.x", "bar.end.y"]
SOLVER = da.GeneralizedAlpha(step=5e-3, newton_tolerance=1e-18)


def swing(bar: da.RigidBar | da.RigidBarBetween) -> da.System:
    system = da.System()
    system.add(bar)
    system.add(da.RevoluteJoint("pin", system.ground, bar.start))
    return system


@pytest.mark.parametrize(
    ("given", "same"),
    [
        ({"mass": 2.0}, {"mass": 2.0}),
        ({"line_density": 3.0}, {"mass": 3.0}),
        (
            {"mass": 2.0, "line_density": 3.0, "inertia": 0.4, "centre": 0.3},
            {"mass": 5.0, "inertia": 0.4, "centre": 0.3},
        ),
    ],
)
def test_it_moves_as_the_bar_of_its_length_and_angle(given: dict, same: dict) -> None:
    between = da.simulate(swing(da.RigidBarBetween("bar", START, END, **given)), 0.3, times=TIMES)
    bar = da.simulate(swing(da.RigidBar("bar", LENGTH, angle=ANGLE, start=START, **same)), 0.3, times=TIMES)
    channels = ["bar.end.x", "bar.end.vy", "bar.centre.angle"]
    np.testing.assert_allclose(between.channels(channels), bar.channels(channels), atol=1e-9)


def test_derivatives_by_coordinates_are_exact() -> None:
    """Length, angle, mass and inertia follow from the coordinates."""

    def build(x: float, y: float) -> da.System:
        system = swing(da.RigidBarBetween("bar", START, (x, y), line_density=3.0))
        system.add(da.Spring("coil", system.ground.point(0.0, 2.0), system.bodies[0].point("end"), 20.0))
        return system

    model = da.TimeResponse(build, {"x": (-1.0, 0.5), "y": (0.5, 1.5)}, CHANNELS, TIMES, SOLVER)
    at, step = np.array(END), 1e-6
    slopes = model.jacobian(at)
    moved = model.evaluate(np.concatenate([at + step * np.eye(2), at - step * np.eye(2)])).values
    differences = np.moveaxis(moved[:2] - moved[2:], 0, -1) / (2 * step)
    np.testing.assert_allclose(slopes, differences, atol=1e-7)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (
            {"end": START, "mass": 1.0},
            "rigid bar 'bar': start and end are both at (0.1, 0.2); give two different positions",
        ),
        ({}, "rigid bar 'bar': mass and line_density are both 0; expected a positive one"),
        ({"mass": -1.0}, "RigidBarBetween 'bar': mass is -1 kg; expected zero or a positive number"),
        ({"mass": 1.0, "inertia": 0.0}, "rigid bar 'bar': inertia is 0 kg*m**2; expected a positive number"),
    ],
)
def test_a_bar_that_cannot_be_is_refused(given: dict, sentence: str) -> None:
    with pytest.raises(da.InputError, match=says(sentence)):
        da.RigidBarBetween("bar", **{"start": START, "end": END, **given})


STUDY = """
[parameters]
reach = { lower = "100 mm", upper = "900 mm", start = "600 mm" }
[constants]
h = "800 mm"
[model]
[[model.body]]
kind = "RigidBarBetween"
name = "bar"
start = [0.1, "200 mm"]
end = ["0.1 - reach", "0.2 + h"]
line_density = "3 kg/m"
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "bar.start"
[solver]
step = "1 ms"
[simulate]
times = [0.0, 0.1]
"""


def test_a_study_file_gives_the_coordinates(tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_text(STUDY)
    (bar,) = load(path).builder(reach=0.6).bodies
    assert bar == da.RigidBarBetween("bar", START, (-0.5, 1.0), line_density=3.0)
    assert bar.length == pytest.approx(LENGTH)
    assert bar.angle == pytest.approx(ANGLE)
