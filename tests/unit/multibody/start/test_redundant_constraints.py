"""The finding on joints whose constraints follow from those of others."""

import pytest

from dalembert.errors import ModelError
from dalembert.multibody import GeneralizedAlpha, RungeKutta4, simulate
from dalembert.multibody.spatial import Inertia, RevoluteJoint, RigidBody, SpatialSystem


def door(hinges: int) -> SpatialSystem:
    """A door on hinges with the same vertical axis."""
    system = SpatialSystem()
    points = {f"hinge{k}": (-0.4, 0.0, 0.8 * k) for k in range(hinges)}
    leaf = system.add(RigidBody("leaf", Inertia.box(20.0, (0.8, 0.04, 2.0)), points=points))
    for name in points:
        system.add(RevoluteJoint(name, system.ground, leaf.point(name)))
    return system


def test_a_door_needs_one_hinge():
    motion = simulate(door(2), 0.01, RungeKutta4(step=5e-3))
    (found,) = motion.findings
    assert found.code == "redundant-constraints"
    assert not found.doubtful
    assert found.values["constraints"] == 10
    assert found.values["independent"] == 5
    joints = found.values["joints"]
    assert str(found) == (
        f"The joints have 10 constraints, 5 of them independent at the start. Those of {joints} follow from the others. "
        "Of all possible joint forces, the result has the smallest ones. If you need the joint forces, replace a joint by "
        "one that holds less, or a bushing."
    )
    assert str(found) in motion.summary()


def test_the_error_counts_the_constraints_of_joints_alone():
    with pytest.raises(ModelError, match=r"^the constraints are redundant: 10 were given, 5 are independent"):
        simulate(door(2), 0.01, GeneralizedAlpha(step=5e-3))


def test_nothing_follows_from_others_on_one_hinge():
    assert simulate(door(1), 0.01, RungeKutta4(step=5e-3)).findings == ()
