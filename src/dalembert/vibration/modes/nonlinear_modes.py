r"""Nonlinear modes: periodic motions without force, over their amplitude."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from itertools import islice
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, counted
from dalembert.findings import Finding
from dalembert.forward import Checkpoint
from dalembert.threads import one_thread
from dalembert.units import unit_of
from dalembert.vibration.balance.arc_length import EASY, MOST_POINTS, SHORTEST, STEADY, Progress
from dalembert.vibration.balance.equations import equations
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.truncation import (
    SLOW,
    Truncation,
    carries_mass,
    choice_findings,
    enough_harmonics,
    hardest,
)
from dalembert.vibration.fourier import in_orders
from dalembert.vibration.modes.mode_equations import FreeMotion, Linear, ModeEquations, Plane
from dalembert.vibration.paths.amplitudes import Amplitude, observed_column
from dalembert.vibration.paths.continuation import MOST_AROUND
from dalembert.vibration.paths.path_end import end_findings
from dalembert.vibration.storage import ConvergedResult, Over, versions
from dalembert.vibration.system.requirements import positive_numbers
from dalembert.vibration.system.system import StaticForce, VibrationSystem

SMALLER = (1.0, 0.1, 1e-2, 1e-3, 1e-4)
"""Parts of the first amplitude that are tried in turn."""
CORNER = 1e-2
"""Step behind a corner of the path, as part of the longest."""
RETRACED = 1e-3
"""Relative difference of frequencies below which a path has returned to its start."""
BEHIND = 2.0
"""Ratio by which the path between two amplitudes may turn back behind the first."""
FIRST_PART, LEAST_PART = 0.125, 2.0**-10
"""First and smallest step of the part of the nonlinearity on the way from the linear mode."""
SAME = 0.9
"""Cosine of the angle between two motions, weighted by the mass, below which they belong to different modes.

With 0.7, Newton's iteration passed a fold of a chain to a mode of another frequency (cosine 0.73) on some processors.
"""
WEAK = 1e-3
"""Damping ratio below which its errors are parts of this ratio, not of the smaller one."""
Points = Annotated[np.ndarray, Over(("point",))]


@dataclass(frozen=True, eq=False)
class Backbone(ConvergedResult):
    """Frequency, damping and shape of a nonlinear mode over its amplitude, as :func:`backbone` returns them.

    Parameters
    ----------
    mode : int
        Its number among the linear modes of the system at rest, from 1.
    dof : str
        Degree of freedom by which the amplitude is measured.
    dofs : tuple of str
    orders : tuple of int
        Harmonics; the coefficients are the mean, if it is kept, then a cosine and a sine for each other one.
    amplitudes : array, shape (points,)
        Of the first harmonic of ``dof``, m.
    frequencies : array, shape (points,)
        Hz; NaN, as what follows, where a point was not found.
    damping : array, shape (points,)
        Damping ratios.
    energies : array, shape (points,)
        Largest kinetic energies of the period, J.
    forces : array, shape (points,)
        Amplitudes of the harmonic force on ``dof``, 90° ahead of its displacement, that balances the damping, N.
    shapes : array, shape (points, dofs, coefficients)
        The motions, m.
    iterations : array of int, shape (points,)
    residuals : array, shape (points,)
        Norm of the residual divided by that of the forces.
    converged : array of bool, shape (points,)
    samples : array of int, shape (points,)
        Of a period.
    provenance : mapping
        Versions, method, settings.
    findings : tuple of Finding
        ``"end-not-reached"`` where a path between two amplitudes did not come to the second;
        ``"harmonics-chosen"`` or ``"few-harmonics"`` where the number of harmonics was chosen.
    """

    FORMAT: ClassVar[str] = "dalembert backbone 1"

    mode: int
    dof: str
    dofs: tuple[str, ...]
    orders: tuple[int, ...]
    amplitudes: Annotated[np.ndarray, Over(("point",), lambda own: unit_of(own.dof))]
    frequencies: Annotated[np.ndarray, Over(("point",), "Hz")]
    damping: Points
    energies: Annotated[np.ndarray, Over(("point",), "J")]
    forces: Annotated[np.ndarray, Over(("point",), "N")]
    shapes: Annotated[np.ndarray, Over(("point", "dof", "coefficient"), "m")]
    iterations: Points
    residuals: Points
    converged: Points
    samples: Points
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    def amplitude(self, dof: str, kind: str = "peak") -> np.ndarray:
        """Size of the motion of a degree of freedom, m, (points,): ``"peak"``, ``"rms"`` or ``"harmonic 1"`` and so on.

        Raises
        ------
        InputError
            For another kind, or an unknown degree of freedom.
        """
        return Amplitude(kind, self.orders).of(self.shapes[:, observed_column(self.dofs, dof)])

    @property
    def extent(self) -> str:
        """How many motions were found, in words, and how far a path came that did not reach its end."""
        found = int(self.converged.sum())
        short = next((one.values for one in self.findings if one.code == "end-not-reached"), None)
        if short is None:
            return f"{found} of {len(self)} amplitudes of {self.dof}"
        unit = unit_of(self.dof)
        points = f"{counted(found, 'point')} of a path over the amplitude of {self.dof}"
        return f"{points}, which came to {short['farthest']:.6g} {unit} and not to {short['end']:.6g} {unit}"

    def summary(self) -> str:
        """A few lines: points, and the ranges of frequency, damping and energy."""
        found = self.converged
        lines = [f"mode {self.mode} at {self.extent}"]
        if found.any():
            ranges = [
                f"{name} {values[found].min():.6g} to {values[found].max():.6g}{unit}"
                for name, values, unit in (
                    ("amplitudes", self.amplitudes, f" {unit_of(self.dof)}"),
                    ("frequencies", self.frequencies, " Hz"),
                    ("damping ratios", self.damping, ""),
                    ("energies", self.energies, " J"),
                )
            ]
            lines.append(", ".join(ranges))
        if not found.all():
            lost = ", ".join(f"{value:.6g} {unit_of(self.dof)}" for value in self.amplitudes[~found][:5])
            lines.append(f"not found: {lost}")
        return "\n".join([*lines, *map(str, self.findings)])


@takes_checked("amplitudes")
@one_thread()
def backbone(
    system: VibrationSystem,
    amplitudes: np.ndarray | Sequence[float] | tuple[float, float],
    mode: int = 1,
    method: HarmonicBalance | None = None,
    *,
    dof: str | None = None,
    checkpoint: Checkpoint | None = None,
) -> Backbone:
    r"""Return frequency and damping of a nonlinear mode over its amplitude, by the extended periodic motion concept.

    Parameters
    ----------
    system : VibrationSystem
        Its harmonic forces are left out.
    amplitudes : array, shape (points,), or (first, last)
        Of the first harmonic of ``dof``, m, positive. A tuple of two: the path between them by arc length, past places
        where the amplitude turns back, with points as dense as it needs. An array: from each to the next.
    mode : int
        Number among the linear modes at rest, where contacts under load stick, from 1 for the lowest frequency.
    method : HarmonicBalance, optional
        With ``harmonics="auto"`` the mode is followed with more and more harmonics, until the truncation errors of its
        motions, frequencies and damping ratios are small. Damping ratios below 0.001 count as 0.001.
    dof : str, optional
        Degree of freedom by which the amplitude is measured; the one that moves most in the linear mode if not given.
    checkpoint : Checkpoint, optional
        Where motions are kept as they are found; begun again with the same file the mode is followed to where it was
        in a part of the time, and on from there to the same bits.

    Returns
    -------
    Backbone
        Given amplitudes at which no motion is found, from the one before nor by halves of the step, are marked; so are
        those at which only another mode is, whose motion lies across that before.

    Raises
    ------
    InputError
        For amplitudes that are not positive, or ends that are equal, a mode that is not there, an unknown degree of
        freedom, and a structure that is too large for dense matrices.
    SolveError
        Where the static forces find no balance.

    Notes
    -----
    Source: Krack, "Nonlinear modal analysis of nonconservative systems: extension of the periodic motion concept",
    Computers & Structures 154, 2015. The amplitude is that of one degree of freedom here, not a modal one. Where
    contacts begin to slip the path has corners; one that is not passed ends it, and the last point is marked.

    Examples
    --------
    The spring of a slider stiffens a mode until it slips:

    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import ElasticSlider, FrictionContact, VibrationSystem
    >>> system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.0)]))
    >>> slider = FrictionContact("slider", "m", friction=0.5, preload=2.0, law=ElasticSlider(tangential_stiffness=0.8))
    >>> added = system.add(slider)
    >>> found = backbone(system, np.array([1.0, 10.0, 1000.0]))
    >>> (2 * np.pi * found.frequencies).round(3).tolist(), found.damping.round(3).tolist()
    ([1.342, 1.028, 1.0], [0.0, 0.053, 0.001])
    """
    method = method or HarmonicBalance()
    sizes = positive_numbers(amplitudes, "backbone", "amplitudes", "m")
    asked = _Asked(system, sizes, isinstance(amplitudes, tuple), mode, dof, checkpoint)
    own, found = asked.motions(method.first())
    if not method.automatic:
        return asked.backbone(own, found)
    while True:
        points = hardest(np.stack([one.harmonics for one in found]), np.array([one.converged for one in found]), 0.0)
        better, error = enough_harmonics(FreeLevel(own), [found[point] for point in points])
        if better.highest == own.problem.method.highest:
            break
        own, found = asked.motions(better)
    result = asked.backbone(own, found)
    return replace(result, findings=(*result.findings, *choice_findings(better, error)))


@dataclass(frozen=True)
class FreeLevel:
    """The equations of a nonlinear mode with a number of harmonics, and the truncation error of its motions."""

    own: ModeEquations

    @property
    def method(self) -> HarmonicBalance:
        return self.own.problem.method

    def truncation(self, motion: FreeMotion) -> Truncation:
        """Return the truncation error of a motion, of its frequency or of its damping ratio, whichever is largest."""
        frequency, heavy = motion.omega / (2 * np.pi), carries_mass(self.own.problem, motion.omega)
        method = self.method.refined()
        if method is None or not self.own.problem.nonlinear:
            return Truncation(frequency, 0.0, heavy)
        finer, better = self.padded(motion, method)
        if not better.converged:
            return Truncation(frequency, np.nan, heavy)
        shape, other = (one.own.amplitudes(place) for one, place in ((self, motion), (finer, better)))
        most = int(np.argmax(other))
        first, second = (one.growth / (2 * one.omega) for one in (motion, better))
        changes = (
            (other[most] - shape[most]) / other[most],
            better.omega / motion.omega - 1,
            (second - first) / max(abs(second), WEAK),
        )
        return Truncation(frequency, SLOW * max(map(abs, map(float, changes))), heavy)

    def padded(self, motion: FreeMotion, method: HarmonicBalance) -> "tuple[FreeLevel, FreeMotion]":
        """Return the equations with the harmonics of another method, and the motion solved with them."""
        finer = replace(self.own, problem=replace(self.own.problem, method=method, _balances={}))
        guess = replace(motion, harmonics=in_orders(motion.harmonics, self.method.orders, method.orders))
        found = finer.at_size(guess, motion.size, max(method.first_samples, motion.samples))
        return FreeLevel(finer), found if _accepted(finer, guess, found) else replace(found, converged=False)


@dataclass(frozen=True)
class _Asked:
    """What is asked for besides the method: the system, the amplitudes or the two ends of a path, and so on."""

    system: VibrationSystem
    sizes: np.ndarray
    is_path: bool
    mode: int
    dof: str | None
    checkpoint: Checkpoint | None

    def motions(self, method: HarmonicBalance) -> tuple[ModeEquations, list[FreeMotion]]:
        """The motions with a number of harmonics, and their equations."""
        driven = equations(self.system, method, self.checkpoint, residuals=False)
        static = tuple(force for force in driven.lowered.forces if isinstance(force, StaticForce))
        free = replace(driven, lowered=replace(driven.lowered, forces=static), _balances={})
        linear = ModeEquations(free, -1).linear(self.mode)
        names = free.lowered.structure.dofs
        row = int(np.abs(linear.shape).argmax()) if self.dof is None else names.index(self.dof)
        own, start = ModeEquations(free, row), _scaled(linear, row, names.names[row])
        first = _first(own, start, float(self.sizes[0]))
        if not self.is_path:
            return own, list(_at_sizes(own, first, self.sizes, start.rest))
        ends = float(self.sizes[0]), float(self.sizes[1])
        known = _towards(own, first, ends[0], start.rest) if first.converged else first
        if not known.converged:
            known = _from_linear(own, start, ends[0]) or known
        return own, list(_along(own, known, *ends))

    def backbone(self, own: ModeEquations, found: list[FreeMotion]) -> Backbone:
        """The result that keeps the motions."""
        return _kept(own, self.mode, found, (float(self.sizes[0]), float(self.sizes[1])) if self.is_path else None)


def _scaled(linear: Linear, row: int, name: str) -> Linear:
    """With unit motion of a degree of freedom."""
    if abs(linear.shape[row]) < 1e-9 * np.abs(linear.shape).max():
        raise InputError(f"backbone: {name!r} does not move in this mode; measure the amplitude elsewhere, dof=...")
    return replace(linear, moved=linear.moved / linear.shape[row], shape=linear.shape / linear.shape[row])


def _first(own: ModeEquations, linear: Linear, size: float) -> FreeMotion:
    """Return the motion at the first amplitude, or at a smaller one if the linear mode is too far from it."""
    for part in SMALLER:
        harmonics = linear.rest.copy()
        harmonics[:, int(own.problem.method.orders[0] == 0)] += part * size * linear.moved
        guess = FreeMotion(harmonics, linear.omega, linear.growth, part * size)
        motion = own.at_size(guess, part * size, own.problem.method.first_samples)
        if _accepted(own, guess, motion):
            return motion
    return _from_linear(own, linear, size) or replace(motion, size=size, converged=False)


def _from_linear(own: ModeEquations, linear: Linear, size: float) -> FreeMotion | None:
    """Return the motion at an amplitude by increasing the nonlinearity from none to all.

    The way of a mode whose stiffness changes at rest, as where a stop just touches: smaller motions are no nearer to
    the linear mode.
    """
    harmonics = linear.rest.copy()
    harmonics[:, int(own.problem.method.orders[0] == 0)] += size * linear.moved
    known = FreeMotion(harmonics, linear.omega, linear.growth, size, samples=own.problem.method.first_samples)
    part, step = 0.0, FIRST_PART
    while part < 1.0:
        target = min(part + step, 1.0)
        softer = own.softer(target, linear.rest)
        if softer is None:
            return None
        found = (own if target == 1.0 else softer).at_size(known, size, known.samples)
        if _accepted(own, known, found):
            known, part, step = found, target, 2 * step
        elif (step := step / 2) < LEAST_PART:
            return None
    return known


def _accepted(own: ModeEquations, known: FreeMotion, found: FreeMotion) -> bool:
    """Whether a motion is converged, and belongs to the same mode."""
    if not found.converged:
        return False
    matrix, mean = own.system(found.samples).matrices[1], int(own.problem.method.orders[0] == 0)
    one, other = (motion.harmonics[:, mean : mean + 2] for motion in (known, found))
    inner = [float(np.sum(left * (matrix @ right))) for left, right in ((one, other), (one, one), (other, other))]
    return inner[0] > SAME * np.sqrt(inner[1] * inner[2])


def _at_sizes(own: ModeEquations, first: FreeMotion, sizes: np.ndarray, rest: np.ndarray) -> Iterator[FreeMotion]:
    """Yield motions at given amplitudes, each from the one before."""
    known = first
    for size in sizes:
        motion = _towards(own, known, float(size), rest) if known.converged else replace(first, size=float(size))
        known = motion if motion.converged else known
        yield motion


def _towards(own: ModeEquations, known: FreeMotion, size: float, rest: np.ndarray) -> FreeMotion:
    """Return the motion at an amplitude from that at another. Ratios that do not converge are halved."""
    way = [size]
    worst = None
    while way:
        if way[-1] == known.size:
            way.pop()
            continue
        guess = replace(known, harmonics=rest + (known.harmonics - rest) * (way[-1] / known.size))
        found = own.at_size(guess, way[-1], known.samples)
        if _accepted(own, known, found):
            known = found
            way.pop()
        elif len(way) > own.problem.method.halvings:
            for motion in islice(_along(own, known, known.size, size, BEHIND), MOST_AROUND):
                if motion.converged and motion.size == size:
                    return motion
            return replace(worst or found, size=size, converged=False)
        else:
            worst = worst or found
            way.append(float(np.sqrt(known.size * way[-1])))
    return known


def _along(
    own: ModeEquations, first: FreeMotion, begin: float, end: float, behind: float = 1.0
) -> Iterator[FreeMotion]:
    """Yield motions along the path from the first amplitude to another, by arc length.

    It may turn back behind its beginning, by a ratio.
    """
    low, high = sorted((begin / behind if end > begin else begin * behind, end))
    known, onward = first, np.zeros(first.harmonics.size + 3)
    onward[-1] = np.sign(end - begin)
    yield known
    if not known.converged:
        return
    longest = 10 * own.problem.method.resolution
    step, direction, progress = longest / 4, own.direction(known, onward), Progress(longest)
    for _ in range(MOST_POINTS):
        scale = own.scale(known)
        plane = Plane(direction, known, scale)
        guess = plane.moved(known, step * direction)
        motion = own.solve(guess, replace(plane, at=guess), known.samples)
        after = own.direction(motion, direction) if _accepted(own, known, motion) else None
        bent = after is not None and float(direction @ after) < STEADY
        if after is None or (bent and step > 1e-2 * longest):
            step /= 2
            if step > SHORTEST * longest:
                continue
            turned = _around_a_corner(own, known, direction, CORNER * longest)
            if turned is None:
                yield replace(motion, converged=False)
                return
            (motion, after), step = turned, CORNER * longest
        if not low <= motion.size <= high and motion.size * direction[-1] > known.size * direction[-1]:
            last = own.at_size(motion, low if motion.size < low else high, motion.samples)
            retraced = last.size == begin and abs(last.omega / first.omega - 1) < RETRACED
            yield replace(last, converged=last.converged and not retraced)
            return
        if low <= motion.size <= high:
            yield motion
        if progress.ends(step):
            return
        known, direction = motion, after
        step = min(longest, step * (1.5 if motion.iterations <= EASY else 0.7))


def _around_a_corner(
    own: ModeEquations, known: FreeMotion, direction: np.ndarray, step: float
) -> tuple[FreeMotion, np.ndarray] | None:
    """A motion behind a corner of the path, such as where a contact begins to slip, and the direction there.

    The tangent behind it is that of the equations a little beyond; of its two senses one leads on, the other back.
    """
    scale = own.scale(known)
    beyond = Plane(direction, known, scale).moved(known, step * direction)
    tangent = own.direction(beyond, direction)
    for way in (tangent, -tangent):
        plane = Plane(way, known, scale)
        guess = plane.moved(known, step * way)
        motion = own.solve(guess, replace(plane, at=guess), known.samples)
        if not _accepted(own, known, motion):
            continue
        moved = plane.from_here(motion)
        if float(direction @ moved) > -0.5 * np.linalg.norm(moved):
            return motion, own.direction(motion, moved)
    return None


def _kept(own: ModeEquations, mode: int, found: list[FreeMotion], ends: tuple[float, float] | None = None) -> Backbone:
    names = own.problem.lowered.structure.dofs.names
    energies, works = np.array([_energy_and_work(own, motion) for motion in found]).T
    omegas, growths, sizes, iterations, residuals, converged, samples = (
        np.array([getattr(motion, one.name) for motion in found]) for one in fields(FreeMotion)[1:]
    )
    shapes = np.stack([own.basis @ motion.harmonics for motion in found])
    # ζ = ξ/(2 ω); the force F = 2 ζ ω²/A Σ h² X_hᵀ M X_h does the work that the negative damping does.
    dof = names[own.row]
    what = f"amplitude of {dof}", unit_of(dof)
    return Backbone(
        mode=mode,
        dof=dof,
        dofs=tuple(names),
        orders=own.problem.method.orders,
        amplitudes=sizes,
        frequencies=np.where(converged, omegas / (2 * np.pi), np.nan),
        damping=np.where(converged, growths / (2 * omegas), np.nan),
        energies=np.where(converged, energies, np.nan),
        forces=np.where(converged, growths * works / sizes, np.nan),
        shapes=np.where(converged[:, None, None], shapes, np.nan),
        iterations=iterations,
        residuals=residuals,
        converged=converged,
        samples=samples,
        provenance={**versions(), "method": asdict(own.problem.method)},
        findings=() if ends is None else end_findings(sizes, converged, ends, *what),
    )


def _energy_and_work(own: ModeEquations, motion: FreeMotion) -> tuple[float, float]:
    """Largest kinetic energy, J, and ω Σ h² X_h^T M X_h, whose product with ξ π is what a period loses."""
    system = own.system(motion.samples)
    velocity = motion.omega * motion.harmonics @ system.series.derivative.T
    mass, samples = system.matrices[1], velocity @ system.series.synthesis.T
    kinetic = 0.5 * np.einsum("it,it->t", samples, mass @ samples)
    return float(kinetic.max()), float(np.sum(velocity * (mass @ velocity)) / motion.omega)
