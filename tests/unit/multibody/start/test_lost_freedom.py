"""Mechanisms that cannot move: the joints that hold them."""

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import ModelError
from dalembert.multibody.spatial import Inertia, Orientation, Pose, RevoluteJoint, RigidBody, SpatialSystem
from support import says


def truss(weld: bool = False) -> da.System:
    """Two bars on three pins: a triangle with the ground."""
    system = da.System()
    left = system.add(da.RigidBar("left", length=1.0, mass=1.0, angle=1.0))
    right = system.add(da.RigidBar("right", length=1.0, mass=1.0, start=left.end, angle=-1.0))
    system.add(da.RevoluteJoint("A", system.ground, left.start))
    system.add(da.RevoluteJoint("B", left.end, right.start))
    system.add(da.RevoluteJoint("C", system.ground, right.end))
    if weld:
        system.add(da.FixedJoint("weld", left.end, right.start))
    return system


def loop(askew: float) -> SpatialSystem:
    """A four-bar in space whose last axis is at an angle (rad) to the others."""
    system, axes = SpatialSystem(), Orientation.by_angles("x", [askew])
    corners = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 1.5, 0.0], [2.0, 0.0, 0.0]])
    side = system.ground.point((0.0, 0.0, 0.0))
    for name, first, last in zip("abc", corners, corners[1:], strict=False):
        way = tuple((last - first).tolist())
        points = {"start": (0.0, 0.0, 0.0), "end": Pose(way, axes) if name == "c" else way}
        body = system.add(RigidBody(name, Inertia.box(1.0, (0.1, 0.1, 0.1)), tuple(first.tolist()), points=points))
        system.add(RevoluteJoint(f"pin {name}", side, body.point("start")))
        side = body.point("end")
    system.add(RevoluteJoint("last pin", side, system.ground.point((2.0, 0.0, 0.0), axes)))
    return system


@pytest.mark.parametrize("solver", [da.RungeKutta4(step=0.01), da.GeneralizedAlpha(step=0.01)])
def test_an_axis_that_is_askew_locks_a_loop_in_space(solver):
    found = {angle: _codes(loop(angle), solver) for angle in (0.0, 1e-3)}
    redundant = "redundant-constraints" if solver.takes_redundancy else "the constraints are redundant"
    locked = "no-freedom" if solver.takes_redundancy else "the mechanism cannot move"
    assert found[0.0].startswith(redundant)
    assert found[1e-3].startswith(locked)


def _codes(system: SpatialSystem, solver: da.RungeKutta4 | da.GeneralizedAlpha) -> str:
    try:
        return ", ".join(finding.code for finding in da.simulate(system, 0.01, solver).findings)
    except ModelError as error:
        return str(error)


def test_joints_that_lock_a_mechanism_are_named():
    sentence = (
        "the mechanism cannot move: its joints have 9 constraints, its bodies 6 degrees of freedom, and none is left. "
        "Take one of the joints 'A', 'C' out, or replace it by one that holds less. If the chain should move as it is, "
        "check axes and lengths: they have to fit exactly."
    )
    for call in (lambda: da.simulate(truss(weld=True), 0.1), lambda: da.equilibrium(truss(weld=True))):
        with pytest.raises(ModelError, match=says(sentence)):
            call()


def test_motions_without_a_freedom_have_a_finding():
    (finding,) = da.simulate(truss(), 0.1).findings
    assert (finding.code, finding.severity) == ("no-freedom", "warning")
    assert finding.values == {"constraints": 6, "freedoms": 6, "joints": "'A', 'B', 'C'"}
    (finding,) = da.simulate(truss(weld=True), 0.1, da.RungeKutta4(step=0.01)).findings
    assert finding.values == {"constraints": 9, "freedoms": 6, "joints": "'A', 'C'"}


def test_modes_without_a_freedom_are_refused():
    with pytest.raises(ModelError, match=r"^the mechanism cannot move: its joints have 6 constraints"):
        da.modes(truss())


def test_prescribed_motions_do_not_lock():
    system = da.System()
    bar = system.add(da.RigidBar("bar", length=1.0, mass=1.0))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start))
    system.add(da.PrescribedMotion("motor", system.ground, bar.start, motion=da.signals.Polynomial((0.0, 1.0))))
    assert da.simulate(system, 0.1).findings == ()
