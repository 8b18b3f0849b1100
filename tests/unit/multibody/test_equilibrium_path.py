"""Paths of equilibria: ends, imperfections, shapes and messages."""

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.errors import InputError, SolveError
from dalembert.structure import Material, box, free_body_modes, solid
from flat_arch import flat_arch


def hinged_column(push: float, side: float = 0.0) -> mb.System:
    """A rigid bar of length 1 that stands on a torsion spring of 2 N m/rad, pushed down at its top."""
    system = mb.System(gravity=(0.0, 0.0))
    bar = system.add(mb.RigidBar("bar", length=1.0, mass=1.0, angle=np.pi / 2))
    pin = system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
    del pin
    system.add(mb.TorsionSpring("spring", system.ground.point(0.0, 0.0, np.pi / 2), bar.start, 2.0, free_angle=0.0))
    system.add(mb.Force("push", bar.end, x=side, y=-push))
    return system


def test_a_bar_on_a_spring_buckles_where_the_push_is_the_stiffness() -> None:
    path = mb.equilibrium_path(hinged_column, 0.0, 4.0)
    (point,) = path.critical
    assert (point.kind, point.load) == ("branch", pytest.approx(2.0, rel=1e-9))
    assert path.loads[0] == 0.0
    assert path.loads[-1] == 4.0
    np.testing.assert_array_equal(path.stable, path.loads < 2.0)
    assert np.abs(point.shape).max() == 1.0
    np.testing.assert_allclose(path.channels(["bar.end.x"]), 0.0, atol=1e-12)


def test_with_an_imperfection_the_path_bends_away() -> None:
    path = mb.equilibrium_path(lambda push: hinged_column(push, 0.02), 0.0, 4.0)
    assert path.critical == ()
    assert path.stable.all()
    x, y = path.channels(["bar.end.x", "bar.end.y"]).T
    angle = np.arctan2(x, y)  # from the vertical: 2 angle = push sin(angle) + 0.02 cos(angle)
    np.testing.assert_allclose(2.0 * angle, path.loads * x + 0.02 * y, atol=1e-8)
    assert angle[-1] > 1.8


def test_a_path_may_run_to_lower_loads_and_end_early() -> None:
    path = mb.equilibrium_path(hinged_column, 0.0, -1.0, steps=5)
    assert path.loads[-1] == -1.0
    assert np.all(np.diff(path.loads) < 0.0)
    assert len(mb.equilibrium_path(hinged_column, 0.0, 4.0, most_points=3).loads) == 3


def two_springs(height: float, unit: float):
    """A flat arch of two springs, of the half span ``unit``, and its limit load."""

    def build(load: float) -> mb.System:
        system, own = mb.System(gravity=(0.0, 0.0)), (1 + height**2) ** 0.5
        apex = system.add(mb.PointMass("apex", mass=1.0, position=(0.0, height * unit)))
        for name, x in (("left", -unit), ("right", unit)):
            ground = system.ground.point(x, 0.0)
            system.add(mb.Spring(name, ground, apex.centre, stiffness=1e4 / unit, free_length=own * unit))
        system.add(mb.Force("push", apex.centre, y=-load))
        return system

    longest, length = (1 + height**2) ** 0.5, (1 + height**2) ** (1 / 6)
    return build, 2e4 * (longest - length) * (length**2 - 1) ** 0.5 / length


@pytest.mark.parametrize(
    ("height", "end", "steps", "unit"),
    [(0.1, 2.6, 20, 1.0), (0.1, 2.6, 5, 1.0), (0.1, 2.6, 20, 1000.0), (0.1, 50.0, 20, 1.0), (0.1, 1.3, 20, 1.0),
     (0.05, 8.0, 20, 1.0), (0.05, 200.0, 20, 1.0), (0.2, 2.0, 20, 1.0), (0.2, 3.0, 20, 1.0)],
)  # fmt: skip
def test_both_limit_points_are_met_whatever_the_steps_and_units(height, end, steps, unit) -> None:
    build, load = two_springs(height, unit)
    path = mb.equilibrium_path(build, 0.0, end * load, steps=steps)
    assert [point.kind for point in path.critical] == ["limit", "limit"]
    np.testing.assert_allclose([point.load for point in path.critical], [load, -load], rtol=1e-7)
    assert path.ended == "end"
    assert path.stable[-1]


def test_a_path_says_why_it_ends() -> None:
    build, load = two_springs(0.1, 1.0)
    assert mb.equilibrium_path(build, 0.0, 2 * load, most_points=3).ended == "points"
    path = mb.equilibrium_path(build, 0.8 * load, 1.1 * load)
    assert path.ended == "away"
    assert path.loads[-1] < 0.2 * load + 1e-9


def test_follower_loads_are_judged_by_the_symmetric_part() -> None:
    # Ziegler's column: two bars on torsion springs with a force along the second one; det K = k^2 at any load.
    def build(load: float) -> mb.System:
        system, up = mb.System(gravity=(0.0, 0.0)), np.pi / 2
        first = system.add(mb.RigidBar("first", length=1.0, mass=1.0, angle=up))
        second = system.add(mb.RigidBar("second", length=1.0, mass=1.0, angle=up, start=first.end))
        system.add(mb.RevoluteJoint("foot", system.ground, first.start))
        system.add(mb.RevoluteJoint("knee", first.end, second.start))
        system.add(mb.TorsionSpring("low", system.ground.point(0.0, 0.0, up), first.start, 1.0, free_angle=0.0))
        system.add(mb.TorsionSpring("high", first.end, second.start, 1.0, free_angle=0.0))
        system.add(mb.Force("push", second.end, x=-load, follower=True))
        return system

    kinds = [point.kind for point in mb.equilibrium_path(build, 0.0, 3.0).critical]
    assert kinds
    assert set(kinds) == {"symmetric part"}


def test_reduced_bodies_are_refused() -> None:
    bar = solid(box((0.4, 0.02, 0.02), (4, 2, 2)), Material(2e9, 0.3, 1200.0))
    modes = free_body_modes(bar, {"foot": "left", "tip": "right"}, modes=2)

    def build(load: float) -> sp.SpatialSystem:
        system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
        body = system.add(sp.ReducedBody("bar", modes, anchor="foot"))
        system.add(sp.FixedJoint("clamp", system.ground, body.point("foot")))
        system.add(sp.Force("push", body.point("tip"), x=-load))
        return system

    with pytest.raises(InputError, match=r"body 'bar' is a reduced body, .* buckles at wrong loads\. Use a Beam"):
        mb.equilibrium_path(build, 0.0, 100.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"steps": 0}, "steps is 0"),
        ({"most_points": 1}, "most_points 1"),
        ({"build": 3}, "build is 3; expected a function"),
    ],
)
def test_wrong_arguments(options: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        mb.equilibrium_path(**({"build": hinged_column, "start": 0.0, "end": 1.0} | options))


def test_messages() -> None:
    with pytest.raises(InputError, match=r"start and end are 1\.0 and 1\.0; expected two loads"):
        mb.equilibrium_path(hinged_column, 1.0, 1.0)

    def growing(load: float) -> mb.System:
        system = hinged_column(load)
        if load > 0.0:
            system.add(mb.PointMass("more", mass=1.0))
        return system

    with pytest.raises(InputError, match=r"has 7 unknowns, and build.*expected the same components at all loads"):
        mb.equilibrium_path(growing, 0.0, 1.0)

    def sinking(load: float) -> mb.System:
        system = mb.System(gravity=(0.0, 0.0))
        ball = system.add(mb.PointMass("ball", mass=1.0))
        system.add(mb.Force("push", ball.centre, y=-1.0 - load))
        return system

    with pytest.raises(SolveError, match="no equilibrium was found"):
        mb.equilibrium_path(sinking, 0.0, 1.0)


def test_angles_are_counted_along_a_path() -> None:
    """A lever on a torsion spring turns by more than half a turn."""

    def build(moment: float) -> mb.System:
        system = mb.System(gravity=(0.0, 0.0))
        lever = system.add(mb.RigidBar("lever", 1.0, 1.0))
        system.add(mb.RevoluteJoint("pin", system.ground, lever.start))
        system.add(mb.TorsionSpring("spring", system.ground, lever.start, 1.0))
        system.add(mb.Torque("push", lever.start, moment))
        return system

    path = mb.equilibrium_path(build, 0.0, 6.0, channels=["pin.angle"])
    np.testing.assert_allclose(path.values[:, 0], path.loads, atol=1e-9)


@pytest.mark.parametrize(("start", "steps", "ended"), [(3.0, 20, "away"), (3.7, 20, "away"), (0.0, 1, "end")])
def test_a_path_of_a_narrow_range_turns_at_its_limit_point(start: float, steps: int, ended: str) -> None:
    path = mb.equilibrium_path(flat_arch, start, 3.9, steps)
    assert path.ended == ended
    assert path.critical[0].load == pytest.approx(3.8298788, rel=1e-7)
