"""Sensors: what is read off a marker against another one, or against the ground."""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.planar.pairs import (
    pair_kind,
    relative_angle,
    relative_spin,
    relative_spin_rate,
    separation,
    separation_rate,
    separation_second,
)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    out[0], out[1] = separation(x, p, m)
    out[2] = relative_angle(x, p, m)
    out[3], out[4] = separation_rate(x, v, p, m)
    out[5] = relative_spin(x, v, m)
    out[6], out[7] = separation_second(x, v, a, p, m)
    out[8] = relative_spin_rate(x, v, a, m)


SENSOR = pair_kind(
    "sensor",
    outputs=(
        ("x", "m"), ("y", "m"), ("angle", "rad"),
        ("vx", "m/s"), ("vy", "m/s"), ("rate", "rad/s"),
        ("ax", "m/s**2"), ("ay", "m/s**2"), ("acceleration", "rad/s**2"),
    ),
    observe=_observe,
)  # fmt: skip
#: Outputs that a point without a direction does not have.
DIRECTIONAL = ("angle", "rate", "acceleration")
