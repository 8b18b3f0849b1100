"""Residuals, matrices, constraint rates and energies of a lowered model, for use from Python."""

import numpy as np
from scipy.sparse import csr_matrix

from dalembert.kernels.kernel import Compiled, kernel
from dalembert.kernels.words import Address, Reals, Reals2
from dalembert.multibody.kernels import assembly
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.histories import energy_history
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.model.lowered import Lowered

_DENSE = 10_000  # entries up to which a dense matrix takes less time than a sparse one


def residual(
    lowered: Lowered,
    model: BlockModel,
    x: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    t: float = 0.0,
    only: Kind | None = None,
) -> np.ndarray:
    """Equations of motion, then constraints, (N,); what one kind adds to them, if given."""
    x, v, a = map(np.ascontiguousarray, (x, v, a))
    r = np.zeros_like(x)
    call = model.call().set(x=x, v=v, a=a, r=r)
    model.evaluate(call, t, t)
    model.each("residual", call, only=only)
    return r[:-1]


def tangent(
    lowered: Lowered,
    x: np.ndarray,
    v: np.ndarray,
    by: tuple[float, float, float],
    rows: tuple[float, float] = (1.0, 1.0),
    t: float = 0.0,
    a: np.ndarray | None = None,
    within: float | None = None,
) -> csr_matrix:
    """Derivative of the residual along ``by[0] dq + by[1] dv + by[2] da`` and the multipliers, sparse (N, N).

    Accelerations are zero if not given. ``within`` says on which side of a jump the time ``t`` lies.
    """
    values, i, j = _tangent_entries(lowered, x, v, by, rows, t, a, within)
    size = lowered.structure.size
    inside = (i < size) & (j < size)
    return csr_matrix((values[inside], (i[inside], j[inside])), shape=(size, size))


def _tangent_entries(
    lowered: Lowered,
    x: np.ndarray,
    v: np.ndarray,
    by: tuple[float, float, float],
    rows: tuple[float, float],
    t: float,
    a: np.ndarray | None = None,
    within: float | None = None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Entries that components add to the tangent, their rows and columns; absent ones have the number N."""
    slots, i, j = lowered.structure.full.separate
    model = lowered.tangents
    x, v = map(np.ascontiguousarray, (x, v))
    values, a = np.zeros(len(i)), np.zeros_like(x) if a is None else np.ascontiguousarray(a)
    call = model.call().set(x=x, v=v, a=a, matrix=values, entries=len(values), motion=rows[0], constraint=rows[1])
    call.set(by_x=by[0], by_v=by[1], by_a=by[2])
    model.evaluate(call, t, t if within is None else within)
    if model.dtype is complex:
        call.signals.imag = 0.0  # a function of the user's may answer with a direction of its own
    model.each("tangent", call, slots)
    return values, i, j


def constraint_jacobian(lowered: Lowered, x: np.ndarray, t: float = 0.0) -> csr_matrix:
    """Derivative of the constraints by the coordinates, sparse (m, n)."""
    n = lowered.structure.n
    return tangent(lowered, x, np.zeros_like(x), (1.0, 0.0, 0.0), (0.0, 1.0), t)[n:, :n]


def changes_of_constraints(lowered: Lowered, x: np.ndarray, modes: np.ndarray) -> np.ndarray:
    """Derivatives of the constraints along changes of the coordinates, J ``modes``, (m, -)."""
    n, m = lowered.structure.n, lowered.structure.size - lowered.structure.n
    if m * n > _DENSE:
        return constraint_jacobian(lowered, x) @ modes
    values, i, j = _tangent_entries(lowered, x, np.zeros_like(x), (1.0, 0.0, 0.0), (0.0, 1.0), 0.0)
    inside = (i >= n) & (i < n + m) & (j < n)
    places = (i[inside] - n) * n + j[inside]
    return np.bincount(places, values[inside], m * n).reshape(m, n) @ modes


def constraint_rates(
    lowered: Lowered, model: BlockModel, x: np.ndarray, v: np.ndarray, a: np.ndarray, t: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """First and second time derivatives of the constraints, (m,) each."""
    x, v, a = map(np.ascontiguousarray, (x, v, a))
    rate, second = np.zeros_like(x), np.zeros_like(x)
    call = model.call().set(x=x, v=v, a=a, rate=rate, second=second)
    model.evaluate(call, t, t)
    model.each("rates", call)
    n = lowered.structure.n
    return rate[n:-1], second[n:-1]


@kernel
def _violations(
    model: Address, work: Address, n: int, x: Reals2, v: Reals2, a: Reals2, times: Reals, within: Reals,
    values: Reals2, out: Reals2,
) -> None:  # fmt: skip
    for s in range(len(times)):
        assembly.set_signals(model, times[s], within[s], work)
        assembly.residual(model, n, x[s], v[s], a[s], work, 1.0, values[0])
        assembly.constraint_rates(model, n, x[s], v[s], a[s], work, values[1], values[2])
        for level in range(3):
            out[s, level] = 0.0
            for i in range(n, x.shape[1] - 1):
                out[s, level] = max(out[s, level], abs(values[level, i]))


def energy_kernels(lowered: Lowered, derivatives: bool) -> list[Compiled]:
    """Kernels of :func:`energies`, and those that differentiate them."""
    types = (float, complex)[: 1 + derivatives]
    kinds = [kind for kind in lowered.data if "energy" in kind.roles]
    return [energy_history, *(kind.kernel("energy", dtype) for dtype in types for kind in kinds)]


def energies(model: BlockModel, x: np.ndarray, v: np.ndarray, times: np.ndarray, within: np.ndarray) -> np.ndarray:
    """Kinetic energy, potential energy, power of what is not conservative, (samples, 3).

    Dual numbers have one more axis in ``x``, ``v`` (samples, N + 1, 9) and in the result.
    """
    totals, call = np.zeros((len(times), 3, *x.shape[2:]), dtype=x.dtype), model.need("energy").call()
    x, v = np.ascontiguousarray(x), np.ascontiguousarray(v)
    energy_history(
        model.address, call.address, x.ctypes.data, v.ctypes.data, x.strides[0], times, within, totals.ctypes.data,
        totals.strides[0],
    )  # fmt: skip
    return totals


def violations(
    lowered: Lowered, x: np.ndarray, v: np.ndarray, a: np.ndarray, times: np.ndarray, within: np.ndarray
) -> np.ndarray:
    """Largest constraint violation at position, velocity and acceleration level, (samples, 3)."""
    out, values, model = np.zeros((len(times), 3)), np.zeros((3, x.shape[1])), lowered.real.need("rates")
    call = model.call()
    _violations(model.address, call.address, lowered.structure.n, x, v, a, times, within, values, out)
    return out
