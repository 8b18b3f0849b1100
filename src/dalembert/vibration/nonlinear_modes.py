r"""Nonlinear modes: periodic motions without force, at one amplitude after the other.

What friction and dampers take from the motion is given back by a negative damping in proportion to the mass (extended
periodic motion concept),

.. math:: M \ddot x + (C - 2 \zeta \omega M) \dot x + K x + \lambda = 0,

so that ω and the damping ratio ζ belong to the amplitude as those of a linear mode do. The unknowns are the harmonics
of all coordinates, ω and ζ; the first harmonic of one degree of freedom has the given cosine and no sine.
"""

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import cast

import numpy as np
import scipy
from scipy.linalg import eig

import dalembert
from dalembert.errors import InputError, SolveError
from dalembert.vibration.backbone import Backbone
from dalembert.vibration.equations import Equations, equations
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.harmonic_balance import AUTOMATIC, MOST_SAMPLES, HarmonicBalance
from dalembert.vibration.newton import DAMPINGS, ROUNDING
from dalembert.vibration.system import StaticForce, VibrationSystem
from dalembert.vibration.threads import one_thread
from dalembert.vibration.uncondensed import Local, Uncondensed

SMALLER = (1.0, 0.1, 1e-2, 1e-3, 1e-4)
"""Parts of the first amplitude from which it is approached where it is not found at once."""


def backbone(
    system: VibrationSystem,
    amplitudes: np.ndarray,
    mode: int = 1,
    method: HarmonicBalance | None = None,
    *,
    dof: str | None = None,
) -> Backbone:
    r"""Frequency and damping of a nonlinear mode over its amplitude, by the extended periodic motion concept.

    Parameters
    ----------
    system : VibrationSystem
        Its harmonic forces are left out.
    amplitudes : array, shape (points,)
        Of the first harmonic of ``dof``, m, positive; the mode is followed from each to the next.
    mode : int
        Number among the linear modes at rest, where contacts under load stick, from 1 for the lowest frequency.
    method : HarmonicBalance, optional
    dof : str, optional
        Degree of freedom by which the amplitude is measured; the one that moves most in the linear mode if not given.

    Returns
    -------
    Backbone
        Amplitudes at which no motion is found, from the one before nor by halves of the step, are marked.

    Raises
    ------
    InputError
        For amplitudes that are not positive, a mode that is not there, an unknown degree of freedom, and a structure
        that is too large for dense matrices.
    SolveError
        Where the static forces find no balance.

    Notes
    -----
    Source: Krack, "Nonlinear modal analysis of nonconservative systems: extension of the periodic motion concept",
    Computers & Structures 154, 2015. The amplitude is that of one degree of freedom here, in place of the modal mass.

    Examples
    --------
    The spring of a slider stiffens a mode until it slips:

    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import Elastic, FrictionContact, VibrationSystem
    >>> system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.0)]))
    >>> slider = FrictionContact("slider", "m", friction=0.5, preload=2.0, law=Elastic(tangential_stiffness=0.8))
    >>> added = system.add(slider)
    >>> found = backbone(system, np.array([1.0, 10.0, 1000.0]))
    >>> (2 * np.pi * found.frequencies).round(3).tolist(), found.damping.round(3).tolist()
    ([1.342, 1.028, 1.0], [0.0, 0.053, 0.001])
    """
    method = method or HarmonicBalance()
    sizes = np.atleast_1d(np.asarray(amplitudes, dtype=float))
    if sizes.ndim != 1 or not len(sizes) or not np.all(np.isfinite(sizes) & (sizes > 0)):
        raise InputError(f"backbone: the amplitudes are {amplitudes}; expected positive numbers in m")
    with one_thread():
        free = _without_harmonic_forces(equations(system, method))
        rest = _Mode(free, -1)
        linear = rest.linear(mode)
        names = free.lowered.structure.dofs
        row = int(np.abs(linear.shape).argmax()) if dof is None else names.index(dof)
        own = replace(rest, row=row)
        found = list(_followed(own, _scaled(linear, row, names.names[row]), sizes))
    return _kept(own, mode, sizes, found)


@dataclass(frozen=True)
class _Linear:
    """A linear mode about a position at rest, in coordinates y (n,) and degrees of freedom (n,)."""

    omega: float
    growth: float
    rest: np.ndarray
    moved: np.ndarray
    shape: np.ndarray


@dataclass(frozen=True)
class _Motion:
    """A periodic motion without force: harmonics (n, coefficients), ω, ξ = 2 ζ ω, and how Newton's method ended."""

    harmonics: np.ndarray
    omega: float
    growth: float
    iterations: int
    error: float
    converged: bool
    samples: int


@dataclass(frozen=True)
class _Trial:
    """A place in Newton's method."""

    harmonics: np.ndarray
    omega: float
    growth: float
    local: Local
    residual: np.ndarray
    error: float
    floor: float


@dataclass(frozen=True)
class _Mode:
    """The equations of a nonlinear mode, whose amplitude is measured at a row of the structure."""

    problem: Equations
    row: int

    def system(self, samples: int) -> Uncondensed:
        """The elements with this many samples."""
        series = Fourier(self.problem.method.orders, samples)
        return Uncondensed(self.problem.lowered, self.problem.condensation, series)

    @cached_property
    def basis(self) -> np.ndarray:
        """Degrees of freedom from the coordinates, (n, n)."""
        own = self.problem.condensation
        back = own.back if isinstance(own.back, np.ndarray) else own.back.toarray()
        return np.hstack([own.retained, back])

    @cached_property
    def static(self) -> np.ndarray:
        """Static forces on the coordinates, (n, coefficients)."""
        own = self.problem.condensation
        loads = np.concatenate([own.outer_loads, own.inner_loads], axis=1)
        return Fourier(self.problem.method.orders, 1).coefficients(loads)

    def linear(self, mode: int) -> _Linear:
        """A linear mode about the position in which the static forces hold the system."""
        first = self.system(self.problem.method.first_samples)
        (stiffness, mass, damping), series = first.matrices, first.series
        rest = self._at_rest(first)
        size, cosine = first.retained, series.mean
        local = first.elements(self._linear_part(first, rest, 0.0, 0.0)[:size], rest[:size])
        stiff = _weighted(first, local, stiffness, cosine)
        stiff[:size, :size] += _block(local.stiffness, first, cosine)
        pairs = eig(stiff, _weighted(first, local, mass, cosine))
        values, shapes = cast(tuple[np.ndarray, np.ndarray], pairs)
        squares, off = np.real(values), np.abs(np.imag(values))
        plausible = np.isfinite(values) & (squares > 0) & (off < 1e-6 * np.abs(squares))
        order = [int(place) for place in np.argsort(squares, kind="stable") if plausible[place]]
        if not 1 <= mode <= len(order):
            raise InputError(
                f"backbone: mode {mode} is asked for; expected 1 to {len(order)}, as many as the system has where its "
                "contacts stick"
            )
        moved = np.real(shapes[:, order[mode - 1]])
        growth = float(moved @ damping @ moved / (moved @ mass @ moved))
        omega = float(np.sqrt(squares[order[mode - 1]]))
        return _Linear(omega, growth, rest, moved, self.basis @ moved)

    def solve(self, guess: _Motion, size: float, samples: int) -> _Motion:
        """Newton's method at an amplitude, with as many samples as it needs, and at least those given."""
        method = self.problem.method
        motion = self._corrected(guess, size, samples)
        while motion.converged and method.samples == AUTOMATIC and motion.samples < MOST_SAMPLES:
            finer = self._at(self.system(2 * motion.samples), motion.harmonics, motion.omega, motion.growth, size)
            if finer.error <= method.sampling:
                break
            better = self._corrected(motion, size, 2 * motion.samples)
            motion = replace(better, iterations=motion.iterations + better.iterations)
        return motion

    def _at_rest(self, system: Uncondensed) -> np.ndarray:
        """Harmonics (n, coefficients) of the position in which the static forces hold the system: a mean alone."""
        rest, method, size = np.zeros_like(self.static), self.problem.method, system.retained
        if not system.series.mean:
            return rest
        for _ in range(method.iterations):
            linear = self._linear_part(system, rest, 0.0, 0.0)
            local = system.elements(linear[:size], rest[:size])
            residual = np.vstack([local.evaluation.residual, linear[size:]])[:, 0]
            matrix = _weighted(system, local, system.matrices[0], 0)
            matrix[:size, :size] += _block(local.stiffness, system, 0)
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
        (stiffness, mass, damping), turn = system.matrices, system.series.derivative
        velocity = omega * harmonics @ turn.T
        inertia = mass @ (omega * velocity @ turn.T)
        return stiffness @ harmonics + (damping - growth * mass) @ velocity + inertia - self.static

    def _at(self, system: Uncondensed, harmonics: np.ndarray, omega: float, growth: float, size: float) -> _Trial:
        count = system.retained
        linear = self._linear_part(system, harmonics, omega, growth)
        local = system.elements(linear[:count], harmonics[:count])
        residual = np.vstack([local.evaluation.residual, linear[count:]])
        stiffness, mass, _ = system.matrices
        scale = float(
            np.linalg.norm(stiffness @ harmonics)
            + np.linalg.norm(local.evaluation.forces)
            + np.linalg.norm(mass @ harmonics) * omega**2
        )
        wrong = (self.basis[self.row] @ harmonics)[system.series.mean : system.series.mean + 2] - [size, 0.0]
        error = float(np.hypot(np.linalg.norm(residual) / scale, np.linalg.norm(wrong) / size))
        everything = np.append(residual.ravel() / scale, wrong / size)
        floor = ROUNDING * np.abs(stiffness).max() * np.linalg.norm(harmonics) / scale
        return _Trial(harmonics, omega, growth, local, everything, error, float(floor))

    def _corrected(self, guess: _Motion, size: float, samples: int) -> _Motion:
        system, method = self.system(samples), self.problem.method
        at, iterations = self._at(system, guess.harmonics, guess.omega, guess.growth, size), 0
        while not (converged := at.error <= max(method.tolerance, at.floor)) and iterations < method.iterations:
            try:
                step = np.linalg.solve(self._jacobian(system, at, size), -at.residual)
            except np.linalg.LinAlgError:
                break
            trials = []
            for part in DAMPINGS:
                moved = at.harmonics + part * size * step[:-2].reshape(at.harmonics.shape)
                turned, grown = at.omega * (1 + part * step[-2]), at.growth + part * at.omega * step[-1]
                trials.append(self._at(system, moved, turned, grown, size))
                if trials[-1].error <= (1 - 0.1 * part) * at.error:
                    break
            finite = [trial for trial in trials if np.isfinite(trial.error) and trial.omega > 0]
            if not finite:
                break
            at, iterations = min(finite, key=lambda trial: trial.error), iterations + 1
        return _Motion(at.harmonics, at.omega, at.growth, iterations, at.error, converged, samples)

    def _jacobian(self, system: Uncondensed, at: _Trial, size: float) -> np.ndarray:
        """Of the residual, in parts of the forces and of the amplitude, by Y/size, log ω and ξ/ω."""
        (stiffness, mass, damping), turn = system.matrices, system.series.derivative
        count, rows = at.harmonics.size, slice(0, system.retained * system.series.count)
        extended = damping - at.growth * mass
        matrix = np.zeros((count + 2, count + 2))
        matrix[:count, :count] = (
            np.kron(stiffness, np.eye(len(turn)))
            + np.kron(extended, at.omega * turn)
            + np.kron(mass, at.omega**2 * turn @ turn)
        )
        velocity = at.harmonics @ turn.T
        matrix[:count, -2] = (extended @ velocity + 2 * at.omega * mass @ velocity @ turn.T).ravel()
        matrix[:count, -1] = -at.omega * (mass @ velocity).ravel()
        if at.local.weight is not None:
            matrix[rows] = at.local.weight @ matrix[rows]
        matrix[rows, rows] += at.local.stiffness
        first = system.series.mean
        unit = np.eye(len(turn))[first : first + 2]
        matrix[count:, :count] = np.kron(self.basis[self.row], unit)
        forces = np.linalg.norm(stiffness @ at.harmonics) + np.linalg.norm(at.local.evaluation.forces)
        matrix[:count] /= forces + np.linalg.norm(mass @ at.harmonics) * at.omega**2
        matrix[count:] /= size
        matrix[:, :count] *= size
        matrix[:, count:] *= at.omega
        return matrix


def _without_harmonic_forces(problem: Equations) -> Equations:
    static = tuple(force for force in problem.lowered.forces if isinstance(force, StaticForce))
    return Equations(replace(problem.lowered, forces=static), problem.method)


def _block(matrix: np.ndarray, system: Uncondensed, place: int) -> np.ndarray:
    """How one coefficient of all retained coordinates acts on itself, (q, q)."""
    q, count = system.retained, system.series.count
    return matrix.reshape(q, count, q, count)[:, place, :, place]


def _weighted(system: Uncondensed, local: Local, matrix: np.ndarray, place: int) -> np.ndarray:
    """W times a matrix (n, n) for one coefficient."""
    result = matrix.copy()
    if local.weight is not None:
        result[: system.retained] = _block(local.weight, system, place) @ matrix[: system.retained]
    return result


def _scaled(linear: _Linear, row: int, name: str) -> _Linear:
    """With unit motion of a degree of freedom."""
    if abs(linear.shape[row]) < 1e-9 * np.abs(linear.shape).max():
        raise InputError(f"backbone: {name!r} does not move in this mode; measure the amplitude elsewhere, dof=...")
    return replace(linear, moved=linear.moved / linear.shape[row], shape=linear.shape / linear.shape[row])


def _followed(own: _Mode, linear: _Linear, sizes: np.ndarray) -> Iterator[_Motion]:
    """Motions at one amplitude after the other."""
    mean, known = int(own.problem.method.orders[0] == 0), None
    for size in sizes:
        if known is None:
            for part in SMALLER:
                harmonics = linear.rest.copy()
                harmonics[:, mean] += part * size * linear.moved
                guess = _Motion(harmonics, linear.omega, linear.growth, 0, 0.0, False, 0)
                motion = own.solve(guess, part * size, own.problem.method.first_samples)
                if motion.converged:
                    motion = motion if part == 1.0 else _towards(own, (motion, part * size), float(size), linear.rest)
                    break
        else:
            motion = _towards(own, known, float(size), linear.rest)
        known = (motion, float(size)) if motion.converged else known
        yield motion


def _towards(own: _Mode, known: tuple[_Motion, float], size: float, rest: np.ndarray) -> _Motion:
    """The motion at an amplitude from that at another, by halves of the way, as ratios, where need be."""
    motion, here = known
    way = [size]
    worst = None
    while way:
        guess = replace(motion, harmonics=rest + (motion.harmonics - rest) * (way[-1] / here))
        found = own.solve(guess, way[-1], motion.samples)
        if found.converged:
            motion, here = found, way.pop()
        elif len(way) > own.problem.method.halvings:
            return worst or found
        else:
            worst = worst or found
            way.append(float(np.sqrt(here * way[-1])))
    return motion


def _kept(own: _Mode, mode: int, sizes: np.ndarray, found: list[_Motion]) -> Backbone:
    names = own.problem.lowered.structure.dofs.names
    converged = np.array([motion.converged for motion in found])
    energies, works = np.array([_energy_and_work(own, motion) for motion in found]).T
    omegas, growths = (np.array([getattr(motion, name) for motion in found]) for name in ("omega", "growth"))
    shapes = np.stack([own.basis @ motion.harmonics for motion in found])
    numbers = {"frequencies": omegas / (2 * np.pi), "damping": growths / (2 * omegas), "energies": energies,
               "forces": growths * works / sizes}  # fmt: skip
    return Backbone(
        mode=mode,
        dof=names[own.row],
        dofs=tuple(names),
        orders=own.problem.method.orders,
        amplitudes=sizes,
        **{name: np.where(converged, values, np.nan) for name, values in numbers.items()},
        shapes=np.where(converged[:, None, None], shapes, np.nan),
        iterations=np.array([motion.iterations for motion in found]),
        residuals=np.array([motion.error for motion in found]),
        converged=converged,
        samples=np.array([motion.samples for motion in found]),
        provenance={
            "version": dalembert.__version__,
            "numpy": np.__version__,
            "scipy": scipy.__version__,
            "method": asdict(own.problem.method),
        },
    )


def _energy_and_work(own: _Mode, motion: _Motion) -> tuple[float, float]:
    """Largest kinetic energy, J, and ω Σ h² X_h^T M X_h, whose product with ξ π is what a period loses."""
    system = own.system(motion.samples)
    velocity = motion.omega * motion.harmonics @ system.series.derivative.T
    mass, samples = system.matrices[1], velocity @ system.series.synthesis.T
    kinetic = 0.5 * np.einsum("it,it->t", samples, mass @ samples)
    return float(kinetic.max()), float(np.sum(velocity * (mass @ velocity)) / motion.omega)
