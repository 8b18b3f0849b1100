"""The pose and the motion of one marker as another one sees them."""

__all__ = ["RelativeSensor"]

from dataclasses import dataclass
from itertools import permutations

from dalembert.errors import require_known
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.points import require_direction
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.kinds import sensor_kind
from dalembert.multibody.components.spatial.rotations import euler_angles, quaternion, rotation_vector
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_markers import spin
from dalembert.multibody.components.spatial.spatial_pairs import (
    along_axes,
    f1,
    f2,
    f3,
    relative_spin,
    separation,
    separation_rate,
)
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import cross, dot, minus
from dalembert.multibody.kernels.elementary import reciprocal, root

_TURNING = [f"{i}{j}{k}" for i, j in permutations("xyz", 2) for k in "xyz" if k != j]
CONVENTIONS = (*_TURNING, *(name.upper() for name in _TURNING))
_TINY = 1e-30  # m^2: keeps the distance differentiable where the points meet


@inlined
def _observe(x, v, a, p, m, inputs, out):
    """With the axes R_a and R_b of the markers: R_a^T (b - a), its rate, R_a^T (omega_b - omega_a), and R_a^T R_b."""
    gap = separation(x, p, m)
    rate = minus(separation_rate(v, p, m), cross(spin(m.a_kind, 0, x, v), gap))
    distance = root(dot(gap, gap) + _TINY)
    out[0], out[1], out[2] = along_axes(gap, x, p, m)
    out[3], out[4], out[5] = along_axes(rate, x, p, m)
    out[6], out[7] = distance, dot(gap, rate) * reciprocal(distance)
    out[8], out[9], out[10] = along_axes(relative_spin(x, v, m), x, p, m)
    first, second = along_axes(f1(x, p, m), x, p, m), along_axes(f2(x, p, m), x, p, m)
    third = along_axes(f3(x, p, m), x, p, m)
    out[11], out[12], out[13], out[14] = quaternion(first, second, third)
    out[15], out[16], out[17] = rotation_vector(first, second, third)
    one, two, three = euler_angles(first, second, third, m.i, m.j, m.k)
    if m.fixed == 1:
        one, three = three, one
    out[18], out[19], out[20] = one, two, three


RELATIVE_SENSOR = sensor_kind(
    "relative_sensor",
    __name__,
    integers=("i", "j", "k", "fixed"),
    outputs=(
        ("x", "m"), ("y", "m"), ("z", "m"),
        ("vx", "m/s"), ("vy", "m/s"), ("vz", "m/s"),
        ("distance", "m"), ("distance_rate", "m/s"),
        ("wx", "rad/s"), ("wy", "rad/s"), ("wz", "rad/s"),
        ("q0", ""), ("q1", ""), ("q2", ""), ("q3", ""),
        ("rotation_x", "rad"), ("rotation_y", "rad"), ("rotation_z", "rad"),
        ("angle_1", "rad"), ("angle_2", "rad"), ("angle_3", "rad"),
    ),
    observe=_observe,
)  # fmt: skip


@dataclass(frozen=True)
class RelativeSensor(Load):
    """Position, velocity and orientation of a marker b, seen from a marker a and in its axes.

    The sensor exerts no force. One of both may be the ground: with ``a`` a pose of the ground, the channels are those
    of b in these axes.

    Parameters
    ----------
    name : str
    a, b : Point or ground
        Markers of rigid bodies or of the ground.
    angles : str
        Axes of the angles, in the order of the rotations: small letters such as ``"zyx"`` turn with the rotations
        before, capital letters such as ``"XYZ"`` are fixed, as in
        :meth:`~dalembert.multibody.spatial.Orientation.by_angles`. All 24 conventions are known.

    Raises
    ------
    InputError
        For an unknown convention.
    ModelError
        For a marker of a point mass, which has no axes.

    Notes
    -----
    Outputs: ``x``, ``y``, ``z`` (m) and their rates ``vx``, ``vy``, ``vz``; ``distance`` (m) and ``distance_rate``,
    without a derivative where the points meet; the relative angular velocity ``wx``, ``wy``, ``wz``; the quaternion
    ``q0`` (the scalar, not negative) to ``q3``; the rotation vector ``rotation_x`` to ``rotation_z`` (rad), which jumps
    where its length passes pi; and the angles ``angle_1``, ``angle_2``, ``angle_3`` (rad). With three different axes
    the angles are singular where the second one is 90 or -90 degrees; with the first axis again as the third, where it
    is 0 or 180 degrees. The first and the third angle turn about the same axis there. Formulas: Diebel, Representing
    Attitude (2006).

    Examples
    --------
    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import Inertia, RelativeSensor, RevoluteJoint, RigidBody, SpatialSystem
    >>> system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    >>> box = Inertia.box(1.0, (0.1, 0.1, 0.1))
    >>> body = system.add(RigidBody("body", box, points={"tip": (0.5, 0.0, 0.0)}, angular_velocity=(0.0, 0.0, 2.0)))
    >>> _ = system.add(RevoluteJoint("pin", system.ground, body.point("origin")))
    >>> _ = system.add(RelativeSensor("camera", system.ground.point((0.0, 0.0, 1.0)), body.point("tip"), angles="xyz"))
    >>> motion = simulate(system, end=0.25)
    >>> motion.channels(["camera.x", "camera.z", "camera.vx", "camera.angle_3"])[-1].round(4).tolist()
    [0.4388, -1.0, -0.4794, 0.5]
    """

    a: Side
    b: Side
    angles: str = "zyx"

    kind = RELATIVE_SENSOR

    def __post_init__(self) -> None:
        require_known("angles", self.angles, CONVENTIONS, f"RelativeSensor {self.name!r}")

    def lower(self, lowering: SpatialRows) -> None:
        require_direction(f"RelativeSensor {self.name!r}", "a rigid body", self.a, self.b)
        pair = lowering.pair(self.a, self.b, self.name)
        fixed = self.angles.isupper()
        axes = ["xyz".index(letter) for letter in self.angles.lower()]
        order = axes[::-1] if fixed else axes  # rotations about fixed axes are those about turned ones, last first
        lowering.add(RELATIVE_SENSOR, pair.slots, pair.data, [*pair.integers, *order, int(fixed)], self.name)
