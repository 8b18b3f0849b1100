"""Nonlinear modes of small structures: all of their coordinates are unknowns, and the Jacobian is a dense matrix."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

import numpy as np
from scipy.linalg import eig

from dalembert.errors import InputError, SolveError
from dalembert.vibration.balance.newton import ROUNDING
from dalembert.vibration.balance.sensitivity import STEP, step_of, with_elements
from dalembert.vibration.balance.uncondensed import Local, Uncondensed
from dalembert.vibration.interface.lowering import Lowered
from dalembert.vibration.modes.free_motion import FreeMotion, Linear, ModePlane
from dalembert.vibration.modes.mode_equations import ModeEquations, Trial


@dataclass(frozen=True)
class Softened:
    """The elements with a part of their nonlinearity: the rest of their force is linear about the position at rest.
    ``part``: from 0 (linear) to 1; ``rest``, ``force`` (q, coefficients): retained coordinates and forces at rest;
    ``stiffness`` (q · coefficients, q · coefficients): at rest.
    """

    part: float
    rest: np.ndarray
    force: np.ndarray
    stiffness: np.ndarray

    def of(self, local: Local, linear: np.ndarray, unknowns: np.ndarray) -> Local:
        """Return the elements at a point, whose linear part and retained coordinates (q, coefficients) are these."""
        # p λ(u) + (1 - p) (λ_0 + k_0 (u - u_0)): from the linear mode at p = 0 to all of the nonlinearity at p = 1 (a
        # homotopy).
        along = self.force + (self.stiffness @ (unknowns - self.rest).ravel()).reshape(unknowns.shape)
        residual = linear + self.part * (local.evaluation.residual - linear) + (1 - self.part) * along
        stiffness = self.part * local.stiffness + (1 - self.part) * self.stiffness
        return local._replace(
            evaluation=replace(local.evaluation, residual=residual), stiffness=stiffness, slope=self.part * local.slope
        )


@dataclass(frozen=True)
class UncondensedModes(ModeEquations):
    """The equations with retained and interior coordinates as unknowns, (n, coefficients)."""

    softened: Softened | None = None

    def system(self, samples: int) -> Uncondensed:
        """The elements with this many samples."""
        problem = self.problem
        return Uncondensed(problem.lowered, problem.condensation, self.series(samples), problem.method.events)

    @cached_property
    def basis(self) -> np.ndarray:
        """Degrees of freedom from the coordinates, (n, n)."""
        condensation = self.problem.condensation
        back = condensation.back if isinstance(condensation.back, np.ndarray) else condensation.back.toarray()
        return np.hstack([condensation.retained, back])

    @cached_property
    def static(self) -> np.ndarray:
        """Static forces on the coordinates, (n, coefficients)."""
        return self.series().coefficients(self.problem.condensation.constant_loads)

    def linear(self) -> Linear:
        """As the equations state it."""
        mode = self.mode
        first = self.system(self.problem.method.first_samples)
        (stiffness, mass, damping), series = first.matrices, first.series
        # Modes are those about the static position, where contacts under load stick: K there contains their stiffness.
        rest = self._at_rest(first)
        size, cosine = first.retained, series.mean
        local = first.elements(self._linear_part(first, rest, 0.0, 0.0)[:size], rest[:size], 0.0)
        stiff = _weighted(first, local, stiffness, cosine)
        # The tangent at rest, of the first cosine's coefficient: all coefficients of a small motion have the same one.
        stiff[:size, :size] += _block(local.stiffness, first, cosine)
        pairs = eig(stiff, _weighted(first, local, mass, cosine))
        values, shapes = cast(tuple[np.ndarray, np.ndarray], pairs)
        squares, off = np.real(values), np.abs(np.imag(values))
        # Undamped eigenvalues ω² of the pencil: infinite ones belong to coordinates without mass, complex ones to the
        # unsymmetric tangent of friction.
        plausible = np.isfinite(values) & (squares > 0) & (off < 1e-6 * np.abs(squares))
        order = [int(place) for place in np.argsort(squares, kind="stable") if plausible[place]]
        if not 1 <= mode <= len(order):
            raise InputError(
                f"backbone: mode {mode} is asked for; expected 1 to {len(order)}, as many as the system has where its "
                "contacts stick"
            )
        moved = np.real(shapes[:, order[mode - 1]])
        # ξ = φ^T C φ/φ^T M φ: for a small motion the negative damping gives back what C takes.
        growth = float(moved @ damping @ moved / (moved @ mass @ moved))
        omega = float(np.sqrt(squares[order[mode - 1]]))
        return Linear(omega, growth, rest, moved, self.basis @ moved)

    def displacements(self, motion: FreeMotion) -> np.ndarray:
        """As the equations state it."""
        return self.basis @ motion.harmonics

    def softer(self, part: float, rest: np.ndarray) -> "ModeEquations | None":
        """As the equations state it; None with rigid contacts, whose forces are no function of the displacements."""
        system = self.system(self.problem.method.first_samples)
        count = system.retained
        linear = self._linear_part(system, rest, 0.0, 0.0)[:count]
        local = system.elements(linear, rest[:count], 0.0)
        if local.weight is not None:
            return None
        softened = Softened(part, rest[:count], local.evaluation.residual - linear, local.stiffness)
        return replace(self, softened=softened)

    @property
    def _settings(self) -> tuple:
        return (self.row, *(() if self.softened is None else (self.softened.part,)))

    def _at_rest(self, system: Uncondensed) -> np.ndarray:
        """Harmonics (n, coefficients) of the position in which the static forces hold the system: a mean alone."""
        rest, method, size = np.zeros_like(self.static), self.problem.method, system.retained
        if not system.series.mean:
            return rest
        for _ in range(method.iterations):
            linear = self._linear_part(system, rest, 0.0, 0.0)
            local = system.elements(linear[:size], rest[:size], 0.0)
            residual = np.vstack([local.evaluation.residual, linear[size:]])[:, 0]
            matrix = _weighted(system, local, system.matrices[0], 0)
            matrix[:size, :size] += _block(local.stiffness, system, 0)
            # Newton's method for the mean alone, with the tangent of closed or stuck contacts.
            scale = np.linalg.norm(self.static) + np.linalg.norm(local.evaluation.forces)
            if np.linalg.norm(residual) <= method.tolerance * (scale or 1.0):
                return rest
            try:
                rest[:, 0] -= np.linalg.solve(matrix, residual)
            except np.linalg.LinAlgError:
                break
        raise SolveError("backbone: the static forces found no balance; give smaller ones, or hold the structure")

    def _linear_part(self, system: Uncondensed, harmonics: np.ndarray, omega: float, growth: float) -> np.ndarray:
        """L(Y), (n, coefficients)."""
        # K Y + (C - ξ M) ω Y Dᵀ + M ω² Y D²ᵀ - F, with D the derivative by τ
        (stiffness, mass, damping), turn = system.matrices, system.series.derivative
        # Time derivatives by ω∇: x' = ω X ∇^T, twice for accelerations, with ∇ the derivative by τ.
        velocity = omega * harmonics @ turn.T
        inertia = mass @ (omega * velocity @ turn.T)
        return stiffness @ harmonics + (damping - growth * mass) @ velocity + inertia - self.static

    def trial(self, motion: FreeMotion, plane: ModePlane, samples: int) -> Trial:
        """As the equations state it."""
        system = self.system(samples)
        count, harmonics = system.retained, motion.harmonics
        linear = self._linear_part(system, harmonics, motion.omega, motion.growth)
        local = system.elements(linear[:count], harmonics[:count], motion.omega)
        if self.softened is not None:
            local = self.softened.of(local, linear[:count], harmonics[:count])
        residual = np.vstack([local.evaluation.residual, linear[count:]])
        scale = self._scale(system, motion, local)
        # Each equation in its own size: forces by the forces in balance, the amplitude by itself, the plane in scaled
        # unknowns.
        everything = np.append(residual.ravel() / scale, self.wrong(motion, self.basis[self.row] @ harmonics, plane))
        # Stiff coordinates cancel large terms: a residual of their rounding counts as converged.
        floor = ROUNDING * np.abs(system.matrices[0]).max() * np.linalg.norm(harmonics) / scale
        return Trial(motion, everything, float(floor), scale, (system, local))

    def change(self, at: Trial, moved: Lowered) -> np.ndarray:
        """As the equations state it."""
        system, motion = at.local[0], at.motion
        count = system.retained
        push = self.basis.T @ self.pushes(motion, moved)
        linear = self._linear_part(system, motion.harmonics, motion.omega, motion.growth)[:count]
        # Elements see the real motion and complex numbers; rigid contacts see the change of the linear part, too.
        elements = replace(system, lowered=with_elements(system.lowered, moved)).balance
        evaluation = elements.residual(linear - 1j * STEP * push[:count], motion.harmonics[:count], motion.omega)
        return np.concatenate([step_of(evaluation.residual).ravel(), -push[count:].ravel()])

    def step(self, at: Trial, plane: ModePlane, right: np.ndarray) -> np.ndarray:
        """As the equations state it."""
        return np.linalg.solve(self._jacobian(at, plane), right)

    def _scale(self, system: Uncondensed, motion: FreeMotion, local: Local) -> float:
        """Size of the forces that are in balance."""
        stiffness, mass, _ = system.matrices
        elastic = np.linalg.norm(stiffness @ motion.harmonics) + np.linalg.norm(local.evaluation.forces)
        return float(elastic + np.linalg.norm(mass @ motion.harmonics) * motion.omega**2)

    def _jacobian(self, at: Trial, plane: ModePlane) -> np.ndarray:
        """Of the residual by Y, log ω, ξ and log a in the scales of the plane."""
        system, local = at.local
        (stiffness, mass, damping), turn = system.matrices, system.series.derivative
        motion = at.motion
        count, rows = motion.harmonics.size, slice(0, system.retained * system.series.count)
        extended = damping - motion.growth * mass
        matrix = np.zeros((count + 3, count + 3))
        matrix[:count, :count] = (
            # ∂L/∂Y = K ⊗ 1 + ω (C - ξ M) ⊗ ∇ + ω² M ⊗ ∇², which rows of Y in their order make a Kronecker product.
            np.kron(stiffness, np.eye(len(turn)))
            + np.kron(extended, motion.omega * turn)
            + np.kron(mass, motion.omega**2 * turn @ turn)
        )
        velocity = motion.harmonics @ turn.T
        # ∂L/∂log ω = ω ∂L/∂ω, and ∂L/∂ξ = -ω M Y ∇^T in the plane's scale of ξ.
        change = extended @ velocity + 2 * motion.omega * mass @ velocity @ turn.T
        matrix[:count, -3] = motion.omega * change.ravel()
        matrix[:count, -2] = -plane.at.omega * motion.omega * (mass @ velocity).ravel()
        if local.weight is not None:
            # Rigid contacts see the linear part: W on its rows, by Y and by both numbers alike; then B, and what rated
            # laws add by ω.
            matrix[rows, : count + 2] = local.weight @ matrix[rows, : count + 2]
        matrix[rows, rows] += local.stiffness
        matrix[rows, -3] += motion.omega * local.slope.ravel()
        # The same scales as those of the residual, the size of the forces not differentiated.
        matrix[:count] /= self._scale(system, motion, local)
        first = system.series.mean
        matrix[count : count + 2, :count] = np.kron(self.basis[self.row], np.eye(len(turn))[first : first + 2])
        matrix[count : count + 2] /= motion.size
        matrix[count, -1] = -1.0
        matrix[:, :count] *= plane.scale
        matrix[-1] = plane.direction
        return matrix


def _block(matrix: np.ndarray, system: Uncondensed, place: int) -> np.ndarray:
    """How one coefficient of all retained coordinates acts on itself, (q, q)."""
    return matrix.reshape(2 * (system.retained, system.series.count))[:, place, :, place]


def _weighted(system: Uncondensed, local: Local, matrix: np.ndarray, place: int) -> np.ndarray:
    """W times a matrix (n, n) for one coefficient."""
    if local.weight is None:
        return matrix.copy()
    first = _block(local.weight, system, place) @ matrix[: system.retained]
    return np.concatenate([first, matrix[system.retained :]])
