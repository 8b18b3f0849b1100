"""Kinds of users in lanes: a select has the bits of each sample alone, a branch on the state is refused with its line."""

from dataclasses import dataclass

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import ModelError
from dalembert.kernels.kernel import inner
from dalembert.multibody.components.planar import pairs
from dalembert.multibody.components.points import Side
from dalembert.multibody.kernels.elementary import is_zero, where
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.model.lane_models import takes_lanes
from dalembert.multibody.model.lowering import lower

NUMBERS = (*pairs.NUMBERS, "stiffness", "damping")


@inner
def selects(x, v, a, p, m, inputs, r):
    """A spring that pulls to one side only, with a damper."""
    dx, dy = pairs.separation(x, p, m)
    pull = where(dx.real > 0.0, p.stiffness * dx, 0.0 * dx)
    if not is_zero(p.damping):
        pull += p.damping * pairs.separation_rate(x, v, p, m)[0]
    pairs.push_pair(x, p, m, pull, 0.0 * dy, r)


@inner
def branches(x, v, a, p, m, inputs, r):
    dx, dy = pairs.separation(x, p, m)
    pull = 0.0 * dx
    if dx.real > 0.0:
        pull = p.stiffness * dx
    pairs.push_pair(x, p, m, pull, 0.0 * dy, r)


KINDS = {
    function.__name__: Kind(
        f"own_{function.__name__}", 8, NUMBERS, pairs.INTEGERS, residual=function, dissipates=True, lanes=True
    )
    for function in (selects, branches)
}


@dataclass(frozen=True)
class OneSided(mb.Load):
    a: Side
    b: Side
    stiffness: float
    damping: float

    def lower(self, lowering) -> None:
        pair = lowering.pair(self.a, self.b, self.name)
        numbers = [*pair.data, self.stiffness, self.damping]
        lowering.add(self.kind, pair.slots, numbers, pair.integers, self.name)


class Selecting(OneSided):
    kind = KINDS["selects"]


class Branching(OneSided):
    kind = KINDS["branches"]


def response(load: type[OneSided]) -> mb.TimeResponse:
    def build(stiffness: float, damping: float) -> mb.System:
        system = mb.System(gravity=(0.0, -9.81))
        bar = system.add(mb.RigidBar("bar", 1.0, 1.0, angle=-1.2))
        system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
        system.add(load("rope", system.ground.point(0.0, -1.0), bar.end, stiffness, damping))
        return system

    ranges = {"stiffness": (10.0, 90.0), "damping": (0.1, 0.9)}
    return mb.TimeResponse(
        build, ranges, ("bar.end.x", "bar.end.vy"), np.linspace(0.0, 1.0, 9), mb.GeneralizedAlpha(5e-3), 1
    )


def test_samples_have_the_bits_of_each_alone() -> None:
    model, chance = response(Selecting), np.random.default_rng(3)
    batch = np.stack([chance.uniform(10.0, 90.0, 8), chance.uniform(0.1, 0.9, 8)], axis=1)
    assert takes_lanes(lower(model.builder(*batch[0])))
    alone = np.stack([model.evaluate(row).only()[0] for row in batch])
    np.testing.assert_array_equal(model.evaluate(batch).only(), alone)


def test_a_branch_on_the_state_is_refused() -> None:
    model = response(Branching)
    with pytest.raises(ModelError) as error:
        model.evaluate(np.full((4, 2), 0.5) * [100.0, 1.0])
    line = branches.__code__.co_firstlineno + 4
    assert str(error.value) == (
        f"{__file__}, line {line}: a branch depends on the state, but samples side by side take the same branches. "
        "Select by where(condition, a, b), branch on a number by is_zero(number), or declare the kind with lanes=False"
    )
