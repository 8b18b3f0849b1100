"""Independent coordinates: their choice, and the dependent ones at all three levels with their derivatives."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.multibody.integrators.shared import partitioning
from dalembert.multibody.integrators.shared.problem import ACCELERATION, SampleModels
from dalembert.multibody.integrators.shared.run import make_problem
from dalembert.multibody.kernels.block_table import Call, addresses
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.states import MotionState, resting
from dalembert.multibody.model import evaluate
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.start.assemble import assembled


def four_bar(length: float = 2.0, bars: int = 2) -> mb.System:
    """Uprights of length 1 on feet along the ground, across their ends a coupler."""
    system = mb.System()
    uprights = [
        system.add(
            mb.RigidBar(f"upright{k}", 1.0, 1.0, angle=1.2, start=system.ground.point(k * length / (bars - 1), 0))
        )
        for k in range(bars)
    ]
    points = {f"hole{k}": ((k / (bars - 1) - 0.5) * length, 0.0) for k in range(bars)}
    coupler = system.add(mb.RigidBody("coupler", 2.0, 0.7, uprights[0].end, anchor="hole0", points=points))
    for k, upright in enumerate(uprights):
        system.add(mb.RevoluteJoint(f"foot{k}", system.ground, upright.start))
        system.add(mb.RevoluteJoint(f"head{k}", upright.end, coupler.point(f"hole{k}")))
    return system


def dense(lowered: Lowered):
    """The problem with a dense matrix, as the partition needs it."""
    slots, layout = lowered.structure.full.dense
    return make_problem(lowered, np.array([0.0]))._replace(exact_slots=slots, exact_layout=layout)


def calls_of(lowered: Lowered) -> tuple[Call, Call, np.ndarray]:
    """Calls in real and in complex numbers, and complex work."""
    complex_state = np.zeros((7, lowered.structure.size + 1), complex)
    return lowered.real.need("rates").call(), lowered.complex_model.need("rates").call(), complex_state


def chosen(lowered: Lowered, problem, state: MotionState, directions: int = 0):
    """Independent coordinates at a state; the functions run in plain Python."""
    call = lowered.tangents.call()
    partition = partitioning.scratch(problem, directions)
    lowered.tangents.evaluate(call, 0.0, 0.0)
    partitioning.linearise(problem, lowered.tangents.address, state, call.address, partition)
    partitioning.choose(problem, partition, partitioning.DEPENDENT)
    assert partitioning.invert(problem, partition)
    return partition


def start(lowered: Lowered) -> MotionState:
    state = resting(lowered.structure.size + 1)
    state.x[:], state.v[:] = np.real(lowered.x), np.real(lowered.v)
    return state


@pytest.mark.parametrize(("bars", "rank"), [(2, 8), (3, 11)])
def test_as_many_coordinates_depend_as_constraints_are_independent(bars: int, rank: int) -> None:
    """A third parallel bar makes one constraint of two redundant."""
    lowered = assembled(four_bar(bars=bars))
    problem = dense(lowered)
    partition = chosen(lowered, problem, start(lowered))
    assert partition.rank[0] == rank == lowered.structure.n - 1
    assert sorted(partition.columns) == list(range(lowered.structure.n))
    assert sorted(partition.rows) == list(range(lowered.structure.size - lowered.structure.n))
    assert partitioning.dependence(problem, partition) < 3.0


@pytest.mark.parametrize("bars", [2, 3])
def test_dependent_entries_satisfy_the_constraints_at_all_levels(bars: int) -> None:
    lowered = assembled(four_bar(bars=bars))
    problem, (call, complex_call, complex_state) = dense(lowered), calls_of(lowered)
    state = start(lowered)
    partition = chosen(lowered, problem, state)
    own = partition.columns[partition.rank[0] :]
    state.x[own] += 0.3
    state.v[own] = -2.0
    state.a[own] = 5.0
    given = [values[own].copy() for values in state[:3]]
    assert partitioning.settle(
        problem, SampleModels(lowered.real.address, lowered.tangents.address, addresses([])), 0.0, 0.0,
        ACCELERATION, state, resting(0, len(state.x)), call.address, complex_call.address, complex_state,
        partition,
    )  # fmt: skip
    zero = np.zeros(1)
    assert np.max(evaluate.violations(lowered, state.x[None], state.v[None], state.a[None], zero, zero)) < 1e-13
    for kept, values in zip(given, state[:3], strict=True):
        assert np.array_equal(kept, values[own])


def test_derivatives_of_the_dependent_entries() -> None:
    """Along the coupler's length and along the independent entries, against central differences."""

    def settled(length: complex, shift: float, perturbed: bool = False) -> tuple[MotionState, MotionState]:
        lowered = assembled(four_bar(length.real))
        problem, (call, complex_call, complex_state) = dense(lowered), calls_of(lowered)
        state = start(lowered)
        partition = chosen(lowered, problem, start(assembled(four_bar(2.0))), int(perturbed))
        own = partition.columns[partition.rank[0] :]
        along = [assembled(four_bar(length), perturbed=True)] if perturbed else []
        dstates = resting(len(along), len(state.x))
        for values, given in zip(state[:3], (1.1 + shift, -2.0 + shift, 5.0 + shift), strict=True):
            values[own] = given
        for values in dstates[:3]:
            values[:, own] = 1.0
        directions = addresses(own.complex_model.need("rates") for own in along)
        assert partitioning.settle(
            problem, SampleModels(lowered.real.address, lowered.tangents.address, directions), 0.0, 0.0,
            ACCELERATION, state, dstates, call.address, complex_call.address, complex_state, partition,
        )  # fmt: skip
        return state, dstates

    _, slopes = settled(2.0 + 1j * STEP, 0.0, perturbed=True)
    gap = 1e-6
    (after, _), (before, _) = settled(2.0 + gap, gap), settled(2.0 - gap, -gap)
    for slope, high, low in zip(slopes[:3], after, before, strict=False):
        assert slope[0] == pytest.approx((high - low) / (2 * gap), abs=2e-8)
