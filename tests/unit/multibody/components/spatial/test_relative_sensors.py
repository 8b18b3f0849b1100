"""Relative sensors against rotation matrices of SciPy and closed forms."""

from itertools import permutations

import numpy as np
import pytest
from inline_snapshot import snapshot
from scipy.spatial.transform import Rotation

import dalembert.multibody as mb
from dalembert.errors import InputError, ModelError
from dalembert.multibody.components.spatial.relative_sensor import CONVENTIONS
from dalembert.multibody.components.spatial.rotations import euler_angles
from dalembert.multibody.spatial import (
    Inertia,
    Orientation,
    PointMass,
    Pose,
    RelativeSensor,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
)
from refusals import refused

PLACE, AXES = (0.2, -0.1, 0.4), Orientation.by_angles("xyz", [0.4, -0.8, 0.3])
ANGLES = [f"see.angle_{k}" for k in (1, 2, 3)]


def two_bodies(angles: str = "zyx") -> SpatialSystem:
    """Two bodies that swing on one another, with a sensor from a marker of the first to one of the second."""
    system = SpatialSystem()
    box = Inertia.box(1.0, (0.1, 0.2, 0.4))
    first = system.add(
        RigidBody("first", box, points={"eye": Pose(PLACE, AXES)}, angular_velocity=(0.5, 1.0, -2.0), anchor="origin")
    )
    turned = Orientation.by_angles("zyx", [0.3, 0.5, -0.2])
    tip = Pose((0.0, 0.3, 0.1), Orientation.by_angles("y", [0.7]))
    points = {"top": (0.0, 0.0, 0.3), "tip": tip}
    second = system.add(
        RigidBody("second", box, first.point("origin"), turned, anchor="top", points=points, angular_velocity=(1, 2, 3))
    )
    system.add(SphericalJoint("ball", system.ground.point((0.0, 0.0, 0.0)), first.point("origin")))
    system.add(SphericalJoint("middle", first.point("origin"), second.point("top")))
    system.add(RelativeSensor("see", first.point("eye"), second.point("tip"), angles))
    return system


def marker(motion, name: str) -> tuple[np.ndarray, Rotation]:
    """Positions and axes of a marker in the fixed axes."""
    place = motion.channels([f"{name}.{axis}" for axis in "xyz"])
    return place, Rotation.from_quat(motion.channels([f"{name}.q{k}" for k in range(4)]), scalar_first=True)


@pytest.mark.parametrize("angles", ["zyx", "XYZ", "zxz", "YXY"])
def test_pose_is_that_of_rotation_matrices(angles: str) -> None:
    motion = mb.simulate(two_bodies(angles), 0.4, mb.GeneralizedAlpha(step=1e-3), times=np.linspace(0, 0.4, 9))
    (a, first), (b, second) = marker(motion, "first.eye"), marker(motion, "second.tip")
    relative = first.inv() * second
    gap = first.inv().apply(b - a)
    np.testing.assert_allclose(motion.channels(["see.x", "see.y", "see.z"]), gap, atol=1e-12)
    np.testing.assert_allclose(motion.channels(["see.distance"])[:, 0], np.linalg.norm(gap, axis=1), rtol=1e-12)
    quaternions = motion.channels([f"see.q{k}" for k in range(4)])
    np.testing.assert_allclose(quaternions, relative.as_quat(scalar_first=True, canonical=True), atol=1e-12)
    np.testing.assert_allclose(
        motion.channels([f"see.rotation_{axis}" for axis in "xyz"]), relative.as_rotvec(), atol=1e-12
    )
    # SciPy writes fixed axes in small letters.
    np.testing.assert_allclose(motion.channels(ANGLES), relative.as_euler(angles.swapcase()), atol=1e-12)


def test_rates_are_the_slopes_of_the_pose() -> None:
    step = 1e-4
    motion = mb.simulate(two_bodies(), 0.1, mb.RadauIIA(tolerance=1e-12), times=np.linspace(0, 0.1, 1001))
    for value, rate in (("x", "vx"), ("y", "vy"), ("z", "vz"), ("distance", "distance_rate")):
        values, rates = motion.channels([f"see.{value}", f"see.{rate}"]).T
        np.testing.assert_allclose((values[2:] - values[:-2]) / (2 * step), rates[1:-1], atol=2e-6)
    turns = Rotation.from_quat(motion.channels([f"see.q{k}" for k in range(4)]), scalar_first=True)
    spins = motion.channels([f"see.w{axis}" for axis in "xyz"])
    np.testing.assert_allclose((turns[2:] * turns[:-2].inv()).as_rotvec() / (2 * step), spins[1:-1], atol=2e-5)


def test_all_conventions() -> None:
    """Angles of a matrix, from their own product of rotations."""
    given = np.array([0.4, 0.9, -1.3])
    assert len(CONVENTIONS) == 24
    for name in (one for one in CONVENTIONS if one.islower()):
        matrix = Orientation.by_angles(name, given).matrix
        axes = ["xyz".index(letter) for letter in name]
        np.testing.assert_allclose(euler_angles(*map(tuple, matrix.T), *axes), given, atol=1e-14)
    assert len(set(permutations("xyz", 2))) * 2 * 2 == len(CONVENTIONS)


def test_wrong_inputs() -> None:
    system = SpatialSystem()
    ball = system.add(PointMass("ball", mass=1.0))
    with refused(
        InputError,
        snapshot("RelativeSensor 'see': unknown angles 'zzx'; did you mean 'zyz' or 'zyx'?"),
    ):
        RelativeSensor("see", system.ground, ball.point("centre"), angles="zzx")
    system.add(RelativeSensor("see", system.ground, ball.point("centre")))
    with refused(
        ModelError,
        snapshot("RelativeSensor 'see': ball.centre has no direction; use a rigid body"),
    ):
        mb.simulate(system, 0.1)
