"""Paths of equilibria: ends, imperfections, shapes and messages."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import InputError, SolveError


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
