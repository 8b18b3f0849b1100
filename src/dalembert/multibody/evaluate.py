"""Residuals, matrices, constraint rates and energies of a lowered model, for use from Python."""

import numpy as np
from scipy.sparse import csr_matrix

from dalembert.compilation import announce_compilation
from dalembert.multibody.kernels import assembly, signals
from dalembert.multibody.kernels.compiled import compiled
from dalembert.multibody.kernels.model import Model, Slots, workspace
from dalembert.multibody.lowering import Lowered


@compiled
def _prepare(model, t, within):
    work = workspace(model)
    signals.evaluate(
        model.signals.index, model.signals.data, model.signals.knots, model.callbacks, t, within, work.signals
    )
    return work


@compiled
def _residual(model, n, x, v, a, t, within, r):
    assembly.residual(model, n, x, v, a, _prepare(model, t, within), 1.0, r)


@compiled
def _tangent(dual, slots, n, x, v, a, t, within, by, rows, matrix):
    work = _prepare(dual, t, within)
    for s in range(len(work.signals)):  # a function of the user's may answer with a direction of its own
        for k in range(3):
            work.signals[s, k] = work.signals[s, k].real
    assembly.tangent(dual, slots, n, x, v, a, by, rows, work, matrix)


@compiled
def _rates(model, n, x, v, a, t, within, rate, second):
    assembly.constraint_rates(model, n, x, v, a, _prepare(model, t, within), rate, second)


@compiled
def _energies(model, x, v, times, within, totals):
    for s in range(len(times)):
        assembly.energies(model, x[s], v[s], _prepare(model, times[s], within[s]), totals[s])


@compiled
def _violations(model, n, x, v, a, times, within, out):
    width = x.shape[1]
    r, rate, second = np.zeros(width), np.zeros(width), np.zeros(width)
    for s in range(len(times)):
        work = _prepare(model, times[s], within[s])
        assembly.residual(model, n, x[s], v[s], a[s], work, 1.0, r)
        assembly.constraint_rates(model, n, x[s], v[s], a[s], work, rate, second)
        for level in range(3):
            values = r if level == 0 else (rate if level == 1 else second)
            out[s, level] = 0.0 if width - 1 == n else np.abs(values[n : width - 1]).max()


def residual(lowered: Lowered, model: Model, x: np.ndarray, v: np.ndarray, a: np.ndarray, t: float = 0.0) -> np.ndarray:
    """Equations of motion, then constraints, (N,)."""
    announce_compilation(_residual, "its kernels", "one to two minutes")
    r = np.zeros_like(x)
    _residual(model, lowered.structure.n, x, v, a, t, t, r)
    return r[:-1]


def tangent(
    lowered: Lowered,
    x: np.ndarray,
    v: np.ndarray,
    by: tuple[float, float, float],
    rows: tuple[float, float] = (1.0, 1.0),
    t: float = 0.0,
) -> csr_matrix:
    """Derivative of the residual along ``by[0] dq + by[1] dv + by[2] da`` and the multipliers, sparse (N, N)."""
    structure = lowered.structure
    slots, i, j = structure.coordinate_layout
    values = np.zeros(len(i))
    _tangent(lowered.upright, Slots(*slots), structure.n, x, v, np.zeros_like(x), t, t, by, rows, values)
    inside = (i < structure.size) & (j < structure.size)
    return csr_matrix((values[inside], (i[inside], j[inside])), shape=(structure.size, structure.size))


def constraint_jacobian(lowered: Lowered, x: np.ndarray, t: float = 0.0) -> csr_matrix:
    """Derivative of the constraints by the coordinates, sparse (m, n)."""
    n = lowered.structure.n
    return tangent(lowered, x, np.zeros_like(x), (1.0, 0.0, 0.0), (0.0, 1.0), t)[n:, :n]


def constraint_rates(
    lowered: Lowered, model: Model, x: np.ndarray, v: np.ndarray, a: np.ndarray, t: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """First and second time derivatives of the constraints, (m,) each."""
    rate, second = np.zeros_like(x), np.zeros_like(x)
    n = lowered.structure.n
    _rates(model, n, x, v, a, t, t, rate, second)
    return rate[n:-1], second[n:-1]


def energies(model: Model, x: np.ndarray, v: np.ndarray, times: np.ndarray, within: np.ndarray) -> np.ndarray:
    """Kinetic energy, potential energy, power of what is not conservative, (samples, 3)."""
    totals = np.zeros((len(times), 3), dtype=x.dtype)
    _energies(model, x, v, times, within, totals)
    return totals


def violations(
    lowered: Lowered, x: np.ndarray, v: np.ndarray, a: np.ndarray, times: np.ndarray, within: np.ndarray
) -> np.ndarray:
    """Largest constraint violation at position, velocity and acceleration level, (samples, 3)."""
    out = np.zeros((len(times), 3))
    _violations(lowered.real, lowered.structure.n, x, v, a, times, within, out)
    return out
