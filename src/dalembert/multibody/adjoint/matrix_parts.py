"""Which components the parts of a step's matrix come from: those along coordinates, velocities and accelerations.

Most components depend on no velocity and have constant masses, so that the last two parts are small.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from dalembert.multibody.integrators.generalized_alpha.adjoint_sweep import (
    ResidualDerivatives,
    SweepWorkspace,
    fixed_masses,
    sweep_workspace,
)
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.couplings import Couplings
from dalembert.multibody.model.lowered import Lowered


@dataclass(frozen=True, eq=False)
class Matrices:
    """Parts of the matrix of a step, with what keeps their slots alive."""

    scratch: SweepWorkspace
    couplings: tuple[Couplings, ...]


def matrices_of(lowered: Lowered, model: BlockModel, work: int, state: MotionState) -> Matrices:
    """Return the workspace for a sweep, with the masses that do not change, filled at a state."""
    structure, kept = lowered.structure, []

    def part(chosen: Callable[[Kind], bool]) -> ResidualDerivatives:
        kinds = {kind: index for kind, index in structure.index.items() if chosen(kind)}
        numbers = [number for number, kind in enumerate(structure.index) if kind in kinds]
        none = np.zeros(0, np.int64)
        if not kinds:
            return ResidualDerivatives(none, none, none, none, none, np.zeros(0))
        kept.append(Couplings(kinds, structure.size))
        slots, rows, columns = kept[-1].entries
        return ResidualDerivatives(
            np.array(numbers), slots, rows, columns, structure.full.places(rows, columns), np.zeros(len(rows))
        )

    rates = set(_of_velocities(lowered))
    varying = {kind for kind, data in lowered.data.items() if kind.varies(data)}
    fixed = part(lambda kind: kind not in varying and kind.constraint is None)
    parts = part(lambda kind: True), part(lambda kind: kind in rates), part(lambda kind: kind in varying)
    scratch = sweep_workspace(structure.full.fresh[1], structure.size + 1, work, parts)
    fixed_masses(model.address, structure.n, state.x, state.v, state.a, fixed, scratch)
    return Matrices(scratch, tuple(kept))


def _of_velocities(lowered: Lowered) -> Iterable[Kind]:
    """Kinds whose residuals may depend on velocities."""
    for kind in lowered.data:
        if kind.constraint is None and not kind.quadratic and (kind.tangent is None or _depends(lowered, kind)):
            yield kind


def _depends(lowered: Lowered, kind: Kind) -> bool:
    structure, model = lowered.structure, lowered.tangents
    slots, rows, columns = structure.full.separate
    x, v, a = np.random.default_rng(0).uniform(0.5, 1.5, (3, structure.size + 1))
    x[-1] = v[-1] = a[-1] = 0.0
    values = np.zeros(len(rows))
    call = model.call().set(x=x, v=v, a=a, matrix=values, entries=len(values), motion=1.0, constraint=1.0)
    call.set(by_x=0.0, by_v=1.0, by_a=0.0)
    model.evaluate(call, 0.0, 0.0)
    model.each("tangent", call, slots, only=kind)
    return bool(np.any(values[columns < structure.n] != 0.0))
