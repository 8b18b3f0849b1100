r"""The equations of a nonlinear mode, and Newton's method for them.

What friction and dampers take from the motion is given back by a negative damping in proportion to the mass (extended
periodic motion concept),

.. math:: M \ddot x + (C - 2 \zeta \omega M) \dot x + K x + \lambda = 0,

so that ω and the damping ratio ζ belong to the amplitude as those of a linear mode do. The unknowns are the harmonics
of all coordinates, ω, ξ = 2 ζ ω and the amplitude; the first harmonic of one degree of freedom has the amplitude as its
cosine and no sine, and a plane across the path separates one motion from the next.
"""

import hashlib
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from dalembert.structure.eigenmodes import real_part
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.harmonic_balance import AUTO, MOST_SAMPLES, HarmonicBalance
from dalembert.vibration.balance.newton import line_search
from dalembert.vibration.balance.sensitivity import step_of, unbalanced
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.lowering import Lowered
from dalembert.vibration.modes.free_motion import FreeMotion, Linear, ModePlane
from dalembert.vibration.system.harmonic_force import StaticForce

PHASES = 1024
"""Instants of a period among which the extreme positions are sought."""


@dataclass(frozen=True)
class Trial:
    """A motion that is not yet balanced. ``residual`` (unknowns + 3,): of the balance, the amplitude, the phase and the
    plane, without dimension; ``floor``: its rounding; ``scale``: by which the balance is divided; ``local``: what the
    Jacobian there is made of.
    """

    motion: FreeMotion
    residual: np.ndarray
    floor: float
    scale: float
    local: Any

    @property
    def error(self) -> float:
        """Norm of the residual."""
        return float(np.linalg.norm(self.residual))


@dataclass(frozen=True)
class ModeEquations(ABC):
    """The equations of a nonlinear mode. ``row``: degree of freedom by which the amplitude is measured; ``mode``:
    number of its linear mode.

    Known motions and directions are read from the problem's checkpoint, so that a path repeats bit for bit.
    """

    problem: Equations
    row: int
    mode: int

    @abstractmethod
    def linear(self) -> Linear:
        """The linear mode about the position in which the static forces hold the system."""

    @abstractmethod
    def softer(self, part: float, rest: np.ndarray) -> "ModeEquations | None":
        """Return the equations with a part of the nonlinearity, about a position; None where there are none."""

    @abstractmethod
    def displacements(self, motion: FreeMotion) -> np.ndarray:
        """Harmonics of all degrees of freedom in a motion, (n, coefficients)."""

    @abstractmethod
    def trial(self, motion: FreeMotion, plane: ModePlane, samples: int) -> Trial:
        """Return the residual at a motion."""

    @abstractmethod
    def step(self, at: Trial, plane: ModePlane, right: np.ndarray) -> np.ndarray:
        """Return the Jacobian's inverse times a right-hand side: changes of Y, log ω, ξ and log a in the plane's
        scales. LinAlgError where it is singular.
        """

    @abstractmethod
    def change(self, at: Trial, moved: Lowered) -> np.ndarray:
        """Return the derivative of the balance by a parameter where the motion is held (unknowns,).

        ``moved``: the system along the parameter, moved by a complex step.
        """

    def slopes(self, motion: FreeMotion, moved: Iterable[Lowered]) -> np.ndarray:
        """Derivatives of ω and ξ = 2 ζ ω by parameters at a motion of a constant amplitude, (parameters, 2)."""
        # J dY = -∂R/∂p (implicit function theorem), with the amplitude, the phase and the plane held.
        plane = self.level(motion)
        at = self.trial(motion, plane, motion.samples)
        result = []
        for system in moved:
            right = np.append(-self.change(at, system) / at.scale, np.zeros(3))
            step = self.step(at, plane, right)
            result.append([motion.omega * step[-3], motion.omega * step[-2]])
        return np.array(result).reshape(-1, 2)

    def pushes(self, motion: FreeMotion, moved: Lowered) -> np.ndarray:
        """Derivative of the forces on all degrees of freedom, f' - Z' X, where the motion is held (n, coefficients)."""
        series = self.series()
        frequencies = motion.omega * np.array(series.orders, dtype=float)
        displacements = series.phasors(self.displacements(motion))
        # Z' of the damping C - ξ M: a mass gives back its part of the negative damping.
        changes = unbalanced(moved, motion.omega, frequencies, displacements)
        inertial = step_of(moved.structure.mass) @ displacements.T
        changes -= (1j * frequencies * motion.growth)[:, None] * np.asarray(inertial).T
        pushes = -series.coefficients(changes)
        if series.mean:
            pushes += step_of(with_static_forces(moved).load_coefficients(series, motion.omega))
        return pushes

    def seen_by_functions(self, motion: FreeMotion) -> dict[str, np.ndarray]:
        """Samples of the displacements that functions of the user's see in a motion, by their names."""
        lowered = self.problem.lowered
        samples = lowered.matrix @ self.displacements(motion) @ self.series(motion.samples).synthesis.T
        return {element.name: samples[rows] for rows, element in lowered.functions}

    def with_method(self, method: HarmonicBalance) -> "ModeEquations":
        """Return the equations with other harmonics."""
        return replace(self, problem=self.problem.with_method(method))

    @cached_property
    def mass(self) -> Any:
        """Of all degrees of freedom, (n, n)."""
        return real_part(self.problem.lowered.structure.mass)

    def series(self, samples: int = 1) -> Fourier:
        """The harmonics, with this many samples of a period."""
        return Fourier(self.problem.method.orders, samples)

    def scale(self, motion: FreeMotion) -> float:
        """Size of the oscillating part of a motion."""
        return float(np.linalg.norm(motion.harmonics[:, int(self.problem.method.orders[0] == 0) :]))

    def amplitudes(self, motion: FreeMotion) -> np.ndarray:
        """Amplitudes of the degrees of freedom in a motion, (n,): half of the way between their extreme positions."""
        waves = self.series(PHASES).synthesis
        return np.ptp(waves @ self.displacements(motion).T, axis=0) / 2

    def at_size(self, guess: FreeMotion, size: float, samples: int) -> FreeMotion:
        """The motion at an amplitude, from a guess at any."""
        at = replace(guess, size=size)
        return self.solve(at, self.level(at), samples)

    def level(self, motion: FreeMotion) -> ModePlane:
        """The plane of constant amplitude through a motion: everything else is free."""
        level = np.zeros(motion.harmonics.size + 3)
        level[-1] = 1.0
        return ModePlane(level, motion, self.scale(motion))

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
        return self.problem.lowered.fingerprint(self.problem.method, *self._settings).encode()

    @property
    def _settings(self) -> tuple:
        """What the equations depend on, beside the system and the method."""
        return (self.row,)

    @np.errstate(over="ignore", invalid="ignore")
    def newton(self, guess: FreeMotion, plane: ModePlane, samples: int) -> FreeMotion:
        """Solve as :meth:`solve` does, without a look at the checkpoint."""
        method = self.problem.method
        motion = self._corrected(guess, plane, samples)
        while motion.converged and method.samples == AUTO and motion.samples < MOST_SAMPLES:
            if self.trial(motion, plane, 2 * motion.samples).error <= method.sampling:
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
        # The plane is across the direction before: the last right-hand side is 1, so that the tangent keeps its sense.
        trial = self.trial(motion, plane, motion.samples)
        tangent = self.step(trial, plane, np.append(np.zeros(len(trial.residual) - 1), 1.0))
        return tangent / np.linalg.norm(tangent)

    def wrong(self, motion: FreeMotion, measured: np.ndarray, plane: ModePlane) -> np.ndarray:
        """Residuals of amplitude, phase and plane, (3,). ``measured`` (coefficients,): of the degree of freedom."""
        # The phase and the amplitude: X_1c = a and X_1s = 0 at the row that measures it (Krack 2015 fixes a modal
        # amplitude).
        first = self.series().mean
        return np.append((measured[first : first + 2] - [motion.size, 0.0]) / motion.size, plane.distance(motion))

    def _corrected(self, guess: FreeMotion, plane: ModePlane, samples: int) -> FreeMotion:
        method = self.problem.method
        at, iterations = self.trial(guess, plane, samples), 0
        while not (converged := at.error <= max(method.tolerance, at.floor)) and iterations < method.iterations:
            try:
                step = self.step(at, plane, -at.residual)
            except np.linalg.LinAlgError:
                break
            best = line_search(partial(self._moved, plane, samples, at.motion, step), at.error)
            if best is None:
                break
            at, iterations = best, iterations + 1
        return replace(at.motion, iterations=iterations, error=at.error, converged=converged, samples=samples)

    def _moved(self, plane: ModePlane, samples: int, motion: FreeMotion, step: np.ndarray, part: float) -> Trial:
        return self.trial(plane.moved(motion, part * step), plane, samples)


def with_static_forces(system: Lowered) -> Lowered:
    """The system without its harmonic forces."""
    return replace(system, forces=tuple(force for force in system.forces if isinstance(force, StaticForce)))


def _numbers(motion: FreeMotion) -> np.ndarray:
    """Harmonics, ω, ξ and amplitude of a motion."""
    return np.append(motion.harmonics, [motion.omega, motion.growth, motion.size])
