r"""The equations of a nonlinear mode, and Newton's method for them.

What friction and dampers take from the motion is given back by a negative damping in proportion to the mass (extended
periodic motion concept),

.. math:: M \ddot x + (C - 2 \zeta \omega M) \dot x + K x + \lambda = 0,

so that ω and the damping ratio ζ belong to the amplitude as those of a linear mode do. The unknowns are the harmonics
of all coordinates, ω, ξ = 2 ζ ω and the amplitude; the first harmonic of one degree of freedom has the amplitude as its
cosine and no sine, and a plane across the path separates one motion from the next.
"""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import cast

import numpy as np
from scipy.linalg import eig

from dalembert.errors import InputError, SolveError
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.harmonic_balance import AUTO, MOST_SAMPLES
from dalembert.vibration.balance.newton import ROUNDING, line_search
from dalembert.vibration.balance.uncondensed import Local, Uncondensed
from dalembert.vibration.fourier import Fourier

PHASES = 1024
"""Instants of a period among which the extreme positions are sought."""


@dataclass(frozen=True)
class Linear:
    """A linear mode about a position at rest, in coordinates y (n,) and degrees of freedom (n,)."""

    omega: float
    growth: float
    rest: np.ndarray
    moved: np.ndarray
    shape: np.ndarray


@dataclass(frozen=True)
class FreeMotion:
    """A motion without force: harmonics (n, coefficients), ω, ξ = 2 ζ ω and amplitude, and how it was found."""

    harmonics: np.ndarray
    omega: float
    growth: float
    size: float
    iterations: int = 0
    error: float = 0.0
    converged: bool = False
    samples: int = 0


@dataclass(frozen=True)
class ModePlane:
    """A plane across the path of motions, in (Y/scale, log ω, ξ/ω, log a), through a motion."""

    direction: np.ndarray
    at: FreeMotion
    scale: float

    def from_here(self, motion: FreeMotion) -> np.ndarray:
        """The way from the plane's own motion to another."""
        # ω and the amplitude by their ratios, ξ in parts of ω: all components are without dimension.
        change = (motion.harmonics - self.at.harmonics).ravel() / self.scale
        scalars = [
            np.log(motion.omega / self.at.omega),
            (motion.growth - self.at.growth) / self.at.omega,
            np.log(motion.size / self.at.size),
        ]
        return np.append(change, scalars)

    def distance(self, motion: FreeMotion) -> float:
        """Of a motion from the plane."""
        return float(self.direction @ self.from_here(motion))

    def moved(self, motion: FreeMotion, step: np.ndarray) -> FreeMotion:
        """A motion some step on."""
        return replace(
            motion,
            # ω and a are positive and vary by decades: steps are in their logarithms, clipped to a factor e.
            harmonics=motion.harmonics + self.scale * step[:-3].reshape(motion.harmonics.shape),
            omega=float(motion.omega * np.exp(np.clip(step[-3], -1.0, 1.0))),
            growth=float(motion.growth + self.at.omega * step[-2]),
            size=float(motion.size * np.exp(np.clip(step[-1], -1.0, 1.0))),
        )


@dataclass(frozen=True)
class _Trial:
    motion: FreeMotion
    local: Local
    residual: np.ndarray
    error: float
    floor: float


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
class ModeEquations:
    """The equations of a nonlinear mode, whose amplitude is measured at a row of the structure.

    Known motions and directions are read from the problem's checkpoint, so that a path repeats bit for bit.
    """

    problem: Equations
    row: int
    softened: Softened | None = None

    def system(self, samples: int) -> Uncondensed:
        """The elements with this many samples."""
        series = Fourier(self.problem.method.orders, samples)
        return Uncondensed(self.problem.lowered, self.problem.condensation, series, self.problem.method.events)

    @cached_property
    def basis(self) -> np.ndarray:
        """Degrees of freedom from the coordinates, (n, n)."""
        condensation = self.problem.condensation
        back = condensation.back if isinstance(condensation.back, np.ndarray) else condensation.back.toarray()
        return np.hstack([condensation.retained, back])

    @cached_property
    def static(self) -> np.ndarray:
        """Static forces on the coordinates, (n, coefficients)."""
        return Fourier(self.problem.method.orders, 1).coefficients(self.problem.condensation.constant_loads)

    def linear(self, mode: int) -> Linear:
        """A linear mode about the position in which the static forces hold the system."""
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

    def softer(self, part: float, rest: np.ndarray) -> "ModeEquations | None":
        """Return the equations with a part of the nonlinearity, about a position (n, coefficients).

        None with rigid contacts, whose forces are no function of the displacements.
        """
        system = self.system(self.problem.method.first_samples)
        count = system.retained
        linear = self._linear_part(system, rest, 0.0, 0.0)[:count]
        local = system.elements(linear, rest[:count], 0.0)
        if local.weight is not None:
            return None
        softened = Softened(part, rest[:count], local.evaluation.residual - linear, local.stiffness)
        return replace(self, softened=softened)

    def scale(self, motion: FreeMotion) -> float:
        """Size of the oscillating part of a motion."""
        return float(np.linalg.norm(motion.harmonics[:, int(self.problem.method.orders[0] == 0) :]))

    def amplitudes(self, motion: FreeMotion) -> np.ndarray:
        """Amplitudes of the degrees of freedom in a motion, (n,): half of the way between their extreme positions."""
        waves = Fourier(self.problem.method.orders, PHASES).synthesis
        return np.ptp(waves @ (self.basis @ motion.harmonics).T, axis=0) / 2

    def at_size(self, guess: FreeMotion, size: float, samples: int) -> FreeMotion:
        """The motion at an amplitude, from a guess at any."""
        # A plane of constant log a: the amplitude stays, everything else is free.
        level = np.zeros(guess.harmonics.size + 3)
        level[-1] = 1.0
        at = replace(guess, size=size)
        return self.solve(at, ModePlane(level, at, self.scale(guess)), samples)

    def solve(self, guess: FreeMotion, plane: ModePlane, samples: int) -> FreeMotion:
        """Newton's method on a plane across the path, with as many samples as it needs, and at least those given."""

        def compute() -> tuple[np.ndarray, np.ndarray]:
            motion = self.newton(guess, plane, samples)
            how = [motion.iterations, motion.error, motion.converged, motion.samples]
            return _numbers(motion), np.array(how, dtype=float)

        place, how = self._once(compute, _numbers(guess), plane.direction, _numbers(plane.at), [plane.scale, samples])
        iterations, error, converged, count = how.tolist()
        omega, growth, size = place[-3:].tolist()
        harmonics = place[:-3].reshape(guess.harmonics.shape)
        return FreeMotion(harmonics, omega, growth, size, int(iterations), error, bool(converged), int(count))

    def _once(
        self, compute: Callable[[], Sequence[np.ndarray]], *dependencies: np.ndarray | list
    ) -> Sequence[np.ndarray]:
        """Return what depends on arrays, from the checkpoint where it is known."""
        if self.problem.checkpoint is None:
            return compute()
        key = (
            b"nonlinear mode"
            + self._system
            + b"".join(np.asarray(array, dtype=float).tobytes() for array in dependencies)
        )
        return self.problem.checkpoint.once(hashlib.sha256(key).digest(), compute)

    @cached_property
    def _system(self) -> bytes:
        part = () if self.softened is None else (self.softened.part,)
        return self.problem.lowered.fingerprint(self.problem.method, self.row, *part).encode()

    @np.errstate(over="ignore", invalid="ignore")
    def newton(self, guess: FreeMotion, plane: ModePlane, samples: int) -> FreeMotion:
        """Solve as :meth:`solve` does, without a look at the checkpoint."""
        method = self.problem.method
        motion = self._corrected(guess, plane, samples)
        while motion.converged and method.samples == AUTO and motion.samples < MOST_SAMPLES:
            if self._at(self.system(2 * motion.samples), motion, plane).error <= method.sampling:
                break
            # More samples where twice as many change the balance by `sampling`, as for forced motions.
            better = self._corrected(motion, plane, 2 * motion.samples)
            motion = replace(better, iterations=motion.iterations + better.iterations)
        return motion

    def direction(self, motion: FreeMotion, before: np.ndarray) -> np.ndarray:
        """Unit tangent of the path at a motion, to the same side as a direction before."""
        return self._once(lambda: (self.tangent(motion, before),), _numbers(motion), before, [motion.samples])[0]

    def tangent(self, motion: FreeMotion, before: np.ndarray) -> np.ndarray:
        """As :meth:`direction`, without a look at the checkpoint."""
        plane = ModePlane(before, motion, self.scale(motion))
        system = self.system(motion.samples)
        matrix = self._jacobian(system, self._at(system, motion, plane), plane)
        # The plane is across the direction before: the last right-hand side is 1, so that the tangent keeps its sense.
        tangent = np.linalg.solve(matrix, np.append(np.zeros(len(matrix) - 1), 1.0))
        return tangent / np.linalg.norm(tangent)

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

    def _at(self, system: Uncondensed, motion: FreeMotion, plane: ModePlane) -> _Trial:
        count, harmonics, size = system.retained, motion.harmonics, motion.size
        linear = self._linear_part(system, harmonics, motion.omega, motion.growth)
        local = system.elements(linear[:count], harmonics[:count], motion.omega)
        if self.softened is not None:
            local = self.softened.of(local, linear[:count], harmonics[:count])
        residual = np.vstack([local.evaluation.residual, linear[count:]])
        scale = self._scale(system, motion, local)
        first = system.series.mean
        # The phase and the amplitude: X_1c = a and X_1s = 0 at the row that measures it (Krack 2015 fixes a modal
        # amplitude).
        wrong = (self.basis[self.row] @ harmonics)[first : first + 2] - [size, 0.0]
        # Each equation in its own size: forces by the forces in balance, the amplitude by itself, the plane in scaled
        # unknowns.
        everything = np.concatenate([residual.ravel() / scale, wrong / size, [plane.distance(motion)]])
        # Stiff coordinates cancel large terms: a residual of their rounding counts as converged.
        floor = ROUNDING * np.abs(system.matrices[0]).max() * np.linalg.norm(harmonics) / scale
        error = float(np.linalg.norm(everything))
        return _Trial(motion, local, everything, error, float(floor))

    def _scale(self, system: Uncondensed, motion: FreeMotion, local: Local) -> float:
        """Size of the forces that are in balance."""
        stiffness, mass, _ = system.matrices
        elastic = np.linalg.norm(stiffness @ motion.harmonics) + np.linalg.norm(local.evaluation.forces)
        return float(elastic + np.linalg.norm(mass @ motion.harmonics) * motion.omega**2)

    def _corrected(self, guess: FreeMotion, plane: ModePlane, samples: int) -> FreeMotion:
        system, method = self.system(samples), self.problem.method
        at, iterations = self._at(system, guess, plane), 0
        while not (converged := at.error <= max(method.tolerance, at.floor)) and iterations < method.iterations:
            try:
                step = np.linalg.solve(self._jacobian(system, at, plane), -at.residual)
            except np.linalg.LinAlgError:
                break
            best = line_search(partial(self._moved, system, plane, at.motion, step), at.error)
            if best is None:
                break
            at, iterations = best, iterations + 1
        return replace(at.motion, iterations=iterations, error=at.error, converged=converged, samples=samples)

    def _moved(
        self, system: Uncondensed, plane: ModePlane, motion: FreeMotion, step: np.ndarray, part: float
    ) -> _Trial:
        return self._at(system, plane.moved(motion, part * step), plane)

    def _jacobian(self, system: Uncondensed, at: _Trial, plane: ModePlane) -> np.ndarray:
        """Of the residual by Y, log ω, ξ and log a in the scales of the plane."""
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
        if at.local.weight is not None:
            # Rigid contacts see the linear part: W on its rows, by Y and by both numbers alike; then B, and what rated
            # laws add by ω.
            matrix[rows, : count + 2] = at.local.weight @ matrix[rows, : count + 2]
        matrix[rows, rows] += at.local.stiffness
        matrix[rows, -3] += motion.omega * at.local.slope.ravel()
        # The same scales as those of the residual, the size of the forces not differentiated.
        matrix[:count] /= self._scale(system, motion, at.local)
        first = system.series.mean
        matrix[count : count + 2, :count] = np.kron(self.basis[self.row], np.eye(len(turn))[first : first + 2])
        matrix[count : count + 2] /= motion.size
        matrix[count, -1] = -1.0
        matrix[:, :count] *= plane.scale
        matrix[-1] = plane.direction
        return matrix


def _numbers(motion: FreeMotion) -> np.ndarray:
    """Harmonics, ω, ξ and amplitude of a motion."""
    return np.append(motion.harmonics, [motion.omega, motion.growth, motion.size])


def _block(matrix: np.ndarray, system: Uncondensed, place: int) -> np.ndarray:
    """How one coefficient of all retained coordinates acts on itself, (q, q)."""
    return matrix.reshape(2 * (system.retained, system.series.count))[:, place, :, place]


def _weighted(system: Uncondensed, local: Local, matrix: np.ndarray, place: int) -> np.ndarray:
    """W times a matrix (n, n) for one coefficient."""
    if local.weight is None:
        return matrix.copy()
    first = _block(local.weight, system, place) @ matrix[: system.retained]
    return np.concatenate([first, matrix[system.retained :]])
