"""Lanes: eight samples side by side have the bits that each has alone."""

from dataclasses import replace

import numpy as np
import pytest

from dalembert.kernels.lanes import WIDTH
from dalembert.multibody.components.spatial.kinds import no_residual
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.model.lane_models import lane_model
from dalembert.multibody.model.lowered import Lowered
from kind_scenes import HOMES

TIME = 0.3
#: Kinds whose kernels other tests need, too; the others are compiled for this test alone.
COMMON = ("structural_beam", "rigid_body", "revolute", "spring")
KINDS = [
    pytest.param(kind, role, id=f"{kind.name}-{role}", marks=() if kind.name in COMMON else pytest.mark.slow)
    for kind in HOMES
    for role in ("residual",)
    if kind.has(role) and kind.takes_lanes and kind.residual is not no_residual
]


def sample(lowered: Lowered, seed: int) -> Lowered:
    """Other numbers, of which the same are zero."""
    chance = np.random.default_rng(seed)
    data = {kind: array * chance.uniform(0.9, 1.1, array.shape) for kind, array in lowered.data.items()}
    return replace(lowered, data=data)


@pytest.mark.parametrize(("kind", "role"), KINDS)
def test_residuals_of_lanes_have_the_bits_of_real_numbers(kind: Kind, role: str) -> None:
    lowered = HOMES[kind]()
    samples = [sample(lowered, seed) for seed in range(WIDTH)]
    model, row = lane_model(samples, "spread"), list(lowered.data).index(kind)
    state = np.random.default_rng(9).normal(size=(3, lowered.structure.size + 1, WIDTH))
    state[:, -1] = 0.0
    together, call = np.zeros(state.shape[1:]), model.call()
    signals = []
    alone = np.zeros((WIDTH, len(together)))
    for lane, other in enumerate(samples):
        parts = dict(zip("xva", np.ascontiguousarray(state[:, :, lane]), strict=True))
        own = other.real.call().set(**parts, r=alone[lane])
        other.real.evaluate(own, TIME, TIME)
        signals.append(own.signals.copy())
        kind.kernel(role, float)(own.address, other.real.block(row))
    call.signals[:] = np.stack(signals, axis=-1)
    call.set(**dict(zip("xva", state, strict=True)), r=together)
    kind.kernel(role, model.dtype)(call.address, model.block(row))
    np.testing.assert_array_equal(together.T, alone)
    assert np.abs(alone).max() > 0.01
