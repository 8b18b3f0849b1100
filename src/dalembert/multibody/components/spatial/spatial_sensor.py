"""What is read at a marker, in the fixed axes."""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.rotations import euler_angles, quaternion, rotation_vector
from dalembert.multibody.components.spatial.spatial_markers import SLOTS, axis, position, position_rate, spin
from dalembert.multibody.components.spatial.spatial_pairs import A_AXES
from dalembert.multibody.kernels.kind import Kind

_SIDE = ("a_x", "a_y", "a_z", "a_11", "a_12", "a_13", "a_21", "a_22", "a_23", "a_31", "a_32", "a_33")
_a1, _a2, _a3 = A_AXES


@inlined
def _observe(x, v, a, p, m, inputs, out):
    s = (p.a_x, p.a_y, p.a_z)
    out[0], out[1], out[2] = position(m.kind, 0, x, s)
    out[3], out[4], out[5] = position_rate(m.kind, 0, v, s)
    out[6], out[7], out[8] = position_rate(m.kind, 0, a, s)
    out[9], out[10], out[11] = spin(m.kind, 0, x, v)
    out[12], out[13], out[14] = spin(m.kind, 0, x, a)
    e1, e2, e3 = axis(m.kind, 0, x, _a1(p)), axis(m.kind, 0, x, _a2(p)), axis(m.kind, 0, x, _a3(p))
    out[15], out[16], out[17], out[18] = quaternion(e1, e2, e3)
    out[19], out[20], out[21] = rotation_vector(e1, e2, e3)
    out[24], out[23], out[22] = euler_angles(e1, e2, e3, 2, 1, 0)


SENSOR = Kind(
    "sensor_in_space",
    coordinates=SLOTS,
    numbers=_SIDE,
    integers=("kind",),
    outputs=(
        ("x", "m"), ("y", "m"), ("z", "m"),
        ("vx", "m/s"), ("vy", "m/s"), ("vz", "m/s"),
        ("ax", "m/s**2"), ("ay", "m/s**2"), ("az", "m/s**2"),
        ("wx", "rad/s"), ("wy", "rad/s"), ("wz", "rad/s"),
        ("wx_rate", "rad/s**2"), ("wy_rate", "rad/s**2"), ("wz_rate", "rad/s**2"),
        ("q0", ""), ("q1", ""), ("q2", ""), ("q3", ""),
        ("rotation_x", "rad"), ("rotation_y", "rad"), ("rotation_z", "rad"),
        ("roll", "rad"), ("pitch", "rad"), ("yaw", "rad"),
    ),
    observe=_observe,
)  # fmt: skip
#: Outputs that a point without axes does not have.
AXIAL = tuple(name for name, _ in SENSOR.outputs[9:])
