"""The fixed joint."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.planar import pairs
from dalembert.multibody.components.planar.joint import OUTPUTS, Joint, observe_joint
from dalembert.multibody.components.planar.pairs import (
    push_pair,
    relative_angle,
    relative_spin,
    relative_spin_rate,
    separation,
    separation_rate,
    separation_second,
    twist_pair,
)
from dalembert.multibody.kernels.dual import sin_cos
from dalembert.multibody.kernels.kind import Kind

if TYPE_CHECKING:
    from dalembert.multibody.lowering import Lowering


@inlined
def _residual(x, v, a, p, m, inputs, r):
    push_pair(x, p, m, x[8], x[9], r)
    r[8], r[9] = separation(x, p, m)
    sine, cosine = sin_cos(relative_angle(x, p, m) - p.rest_angle)
    twist_pair(x, m, cosine * x[10], r)
    r[10] = sine


@inlined
def _rates(x, v, a, p, m, inputs, rate, second):
    rate[0], rate[1] = separation_rate(x, v, p, m)
    second[0], second[1] = separation_second(x, v, a, p, m)
    sine, cosine = sin_cos(relative_angle(x, p, m) - p.rest_angle)
    turn = relative_spin(x, v, m)
    rate[2] = cosine * turn
    second[2] = cosine * relative_spin_rate(x, v, a, m) - sine * turn * turn


@inlined
def _observe(x, v, a, p, m, inputs, out):
    observe_joint(x, v, p, m, -x[8], -x[9], -x[10], out)


FIXED = Kind(
    "fixed",
    coordinates=pairs.COORDINATES,
    multipliers=3,
    numbers=(*pairs.NUMBERS, "rest_angle"),
    integers=pairs.INTEGERS,
    residual=_residual,
    rates=_rates,
    outputs=OUTPUTS,
    observe=_observe,
    lengths=("a_x", "a_y", "b_x", "b_y"),
)


@dataclass(frozen=True)
class FixedJoint(Joint):
    """A weld: both points coincide and keep their relative angle. A beam's end offers its section's direction."""

    kind = FIXED

    def lower(self, lowering: "Lowering") -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        self._oriented()
        index = pair.slots + lowering.multipliers(self.name, 3)
        lowering.add(FIXED, index, [*pair.data, pair.rest_angle], pair.integers, self.name)
