r"""Stability of periodic motions by Hill's method.

A disturbance :math:`e^{\nu t} p(t)`, with p periodic like the motion, obeys the linearised balance where
:math:`\mathrm{d}/\mathrm{d}t` stands for :math:`\omega\,\mathrm{d}/\mathrm{d}\tau + \nu`: a quadratic eigenvalue
problem for the Floquet exponents ν, and :math:`e^{2\pi\nu/\omega}` are the multipliers. Each exponent comes again as
:math:`\nu + i k \omega` with its p turned by k harmonics; those whose p lies about the mean are the ones that the kept
harmonics resolve (sorting by the centre of p, after Guillot, Lazarus, Thomas, Vergez and Cochelin, "A purely frequency
based Floquet-Hill formulation for the efficient stability computation of periodic solutions of ordinary differential
systems", Journal of Computational Physics 416, 2020).

Sliders enter by their Jacobian for periodic disturbances. This is exact where an exponent is zero (folds), but not
elsewhere: their memory is taken as if the disturbance had neither grown nor turned since.
"""

from typing import cast

import numpy as np
from scipy.linalg import eig

from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.balance.uncondensed import Uncondensed
from dalembert.vibration.fourier import Fourier, in_orders

SHIFT = 0.7
"""Where the pencil is inverted, in parts of ω: a place where no exponent lies, as that would double in 0.16 periods."""
INFINITE = 1e-7
"""Inverse of the distance from there, in parts of ω, below which an exponent belongs to a coordinate without mass."""
COPY = 1e-3
"""Difference, in parts of ω, in which an exponent is another's copy."""


def hill(problem: Equations, solution: Solution) -> np.ndarray:
    """Floquet exponents in parts of ω, (exponents,): as many as the system has states, the fastest growing first."""
    orders = problem.method.orders
    # The motion may have odd harmonics only; its disturbances may have any.
    every = Fourier(tuple(range(orders[-1] + 1)), solution.samples)
    balance, point = problem.stiffness_balance(solution.samples), solution.condensed
    linear = balance.linear(point.stiffness, point.force, solution.unknowns)
    speed = problem.lowered.spin(solution.omega)[0]
    system = Uncondensed(problem.lowered, problem.condensation, every, problem.method.events, speed)
    # All harmonics up to the highest: disturbances of a symmetric motion need not be symmetric.
    linear, unknowns = (in_orders(part, orders, every.orders) for part in (linear, solution.unknowns))
    pencil = _pencil(system, linear, unknowns, solution.omega)
    values, vectors = _eigenvalues(pencil)
    centres = _centres(vectors.reshape(-1, every.count, len(values)), system.matrices[1])
    return _distinct(values, centres, 2 * int(np.linalg.matrix_rank(system.matrices[1], hermitian=True)))


def _pencil(system: Uncondensed, linear: np.ndarray, unknowns: np.ndarray, omega: float) -> list[np.ndarray]:
    """A_0, A_1, A_2 of A_0 + μ A_1 + μ² A_2 with μ = ν/ω, (n · coefficients, n · coefficients) each."""
    stiffness, mass, damping = system.matrices
    turn, unit = system.series.derivative, np.eye(system.series.count)
    pencil = [
        # (ω∇ + ν)² M + (ω∇ + ν) C + K + J by powers of μ = ν/ω, with ∇ the derivative of coefficients by τ.
        np.kron(mass, omega**2 * turn @ turn) + np.kron(damping, omega * turn) + np.kron(stiffness, unit),
        np.kron(mass, 2 * omega**2 * turn) + np.kron(damping, omega * unit),
        np.kron(mass, omega**2 * unit),
    ]
    local, rows = system.elements(linear, unknowns, omega), slice(0, unknowns.size)
    if local.weight is not None:
        for matrix in pencil:
            # Rigid contacts: the rows of q are W dL + B dU, with W for each power of μ.
            matrix[rows] = local.weight @ matrix[rows]
    pencil[0][rows, rows] += local.stiffness
    return pencil


def _eigenvalues(pencil: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return finite eigenvalues and their vectors, from those of 1/(μ - shift), which are zero without mass."""
    still, moving, mass = pencil
    size = len(still)
    at_shift = still + SHIFT * moving + SHIFT**2 * mass
    solved = np.linalg.solve(at_shift, np.hstack([moving + 2 * SHIFT * mass, mass]))
    # First companion form of the pencil in 1/(μ - shift): coordinates without mass give zeros in place of infinities,
    # which QZ would have to separate.
    companion = np.block([[-solved[:, :size], -solved[:, size:]], [np.eye(size), np.zeros((size, size))]])
    inverse, vectors = cast(tuple[np.ndarray, np.ndarray], eig(companion))
    finite = np.abs(inverse) > INFINITE
    return SHIFT + 1 / inverse[finite], vectors[:size, finite]


def _centres(vectors: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Mean harmonic of disturbances (n, coefficients, disturbances), weighted by their kinetic energy."""
    weights, total = np.zeros(vectors.shape[2]), np.zeros(vectors.shape[2])
    for order in range((vectors.shape[1] + 1) // 2):
        cosine = vectors[:, max(2 * order - 1, 0)]
        sine = vectors[:, 2 * order] if order else np.zeros_like(cosine)
        cosine = cosine if order else np.sqrt(2) * cosine  # both sides below count it, each half of 4 |p_0|²
        for side in (1, -1):  # p = Σ p_h exp(i h τ) has p_h = (cosine - i sine)/2, and p_-h with the other sign
            part = cosine - side * 1j * sine
            energy = np.einsum("ik,ik->k", part.conj(), mass @ part).real
            weights, total = weights + side * order * energy, total + energy
    return np.abs(weights) / np.where(total > 0, total, 1.0)


def _distinct(values: np.ndarray, centres: np.ndarray, count: int) -> np.ndarray:
    """Return as many exponents as states, those centred about the mean, each once, the fastest growing first."""
    kept: list[complex] = []
    for number in np.argsort(centres, kind="stable"):
        # Copies differ by i k exactly; with a truncated series by little, so that `COPY` is a distance.
        turns = [(values[number] - other) / 1j for other in kept]
        if not any(abs(turn - np.round(turn.real)) < COPY and abs(turn) > 0.5 for turn in turns):
            kept.append(complex(values[number]))
        if len(kept) == count:
            break
    return np.array(sorted(kept, key=lambda value: (-value.real, abs(value.imag), value.imag)))
