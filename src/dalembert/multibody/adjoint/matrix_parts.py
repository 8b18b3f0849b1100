"""Which components the parts of a step's matrix come from: those along coordinates, velocities and accelerations.

Most components depend on no velocity and have constant masses, so that the last two parts are small.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from dalembert.multibody.integrators.generalized_alpha.adjoint_sweep import (
    InternalMultipliers,
    ResidualDerivatives,
    SweepWorkspace,
    fixed_masses,
    sweep_workspace,
)
from dalembert.multibody.kernels.block_table import Call
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.couplings import Couplings
from dalembert.multibody.model.lowered import Lowered


@dataclass(frozen=True, eq=False)
class Matrices:
    """Parts of the matrix of a step, with what keeps their slots and a call alive."""

    scratch: SweepWorkspace
    couplings: tuple[Couplings, ...]
    call: Call


def matrices_of(lowered: Lowered, work: int, tangent_work: int, state: MotionState) -> Matrices:
    """Return the workspace for a sweep, with the masses that do not change, filled at a state."""
    structure, kept = lowered.structure, []
    numbers = {kind: number for number, kind in enumerate(structure.index)}

    def part(chosen: Callable[[Kind], bool]) -> ResidualDerivatives:
        kinds = {kind: index for kind, index in structure.index.items() if chosen(kind)}
        none = np.zeros(0, np.int64)
        if not kinds:
            return ResidualDerivatives(none, none, none, none, none, np.zeros(0))
        kept.append(Couplings(kinds, structure.size))
        slots, rows, columns = kept[-1].entries
        return ResidualDerivatives(
            np.array([numbers[kind] for kind in kinds]),
            slots,
            rows,
            columns,
            structure.full.places(rows, columns),
            np.zeros(len(rows)),
        )

    rates = set(_of_velocities(lowered))
    varying = {kind for kind, data in lowered.data.items() if kind.varies(data)}
    fixed = part(lambda kind: kind not in varying and kind.constraint is None)
    parts = part(lambda kind: True), part(lambda kind: kind in rates), part(lambda kind: kind in varying)
    call, real = lowered.real.call(), lowered.real.need("residual")
    nodes = [(kind.kernel("balance", float).address, real.block(numbers[kind])) for kind in structure.reduction.nodes]
    table = np.array(nodes, dtype=np.int64).reshape(len(nodes), 2)
    multipliers = InternalMultipliers(real.address, call.address, table, np.zeros(structure.size + 1))
    scratch = sweep_workspace(structure.full.fresh[1], structure.size + 1, work, tangent_work, parts, multipliers)
    fixed_masses(lowered.tangents.address, structure.n, state.x, state.v, state.a, fixed, scratch)
    return Matrices(scratch, tuple(kept), call)


def _of_velocities(lowered: Lowered) -> Iterable[Kind]:
    """Kinds whose residuals may depend on velocities: all but those with columns of dissipation that are zero here."""
    for kind, data in lowered.data.items():
        declared = not isinstance(kind.dissipates, bool)
        if kind.constraint is None and (kind.dissipative(data) or not declared):
            yield kind
