r"""Nonlinear modes: periodic motions without force, over their amplitude."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields, replace

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.forward import Checkpoint
from dalembert.threads import single_thread
from dalembert.units import unit_of
from dalembert.vibration.balance.equations import chosen_solver, equations, require_one_period
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
from dalembert.vibration.interface.contacts_stuck import ContactsStuck
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.modes.backbone_result import Backbone
from dalembert.vibration.modes.free_motion import FreeMotion, Linear
from dalembert.vibration.modes.mode_equations import ModeEquations, with_static_forces
from dalembert.vibration.modes.mode_paths import (
    first_motion,
    from_linear_mode,
    motion_towards,
    motions_along,
    motions_at,
    same_mode,
)
from dalembert.vibration.modes.receptance_modes import ReceptanceModes
from dalembert.vibration.modes.uncondensed_modes import UncondensedModes
from dalembert.vibration.paths.path_end import end_findings
from dalembert.vibration.storage import versions
from dalembert.vibration.system.requirements import positive_numbers, require_still
from dalembert.vibration.system.system import VibrationSystem

WEAK = 1e-3
"""Damping ratio below which its errors are parts of this ratio, not of the smaller one."""


@takes_checked("amplitudes")
@single_thread()
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
        Of the first harmonic of ``dof``, m, positive. A tuple of two: the path between them by arc length, past folds
        of the amplitude, with points as dense as it needs. An array: from each to the next.
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
        freedom, and a structure without many contacts that is too large for dense matrices.
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
    >>> curve = backbone(system, np.array([1.0, 10.0, 1000.0]))
    >>> (2 * np.pi * curve.frequencies).round(3).tolist(), curve.damping.round(3).tolist()
    ([1.342, 1.028, 1.0], [0.0, 0.053, 0.001])
    """
    require_still(system, "backbone")
    method = method or HarmonicBalance()
    require_one_period(method, "backbone")
    method = replace(method, solver=chosen_solver(lower(system), method, stability=True))
    sizes = positive_numbers(amplitudes, "backbone", "amplitudes", "m")
    posed = PosedBackbone(system, sizes, isinstance(amplitudes, tuple), mode, dof, checkpoint)
    nonlinear_mode, motions = follow(posed, method.first())
    if not method.automatic:
        return _conclude(posed, nonlinear_mode, motions)
    while True:
        harmonics = np.stack([motion.harmonics for motion in motions])
        points = hardest(harmonics, np.array([motion.converged for motion in motions]), 0.0)
        better, error = enough_harmonics(FreeLevel(nonlinear_mode), [motions[point] for point in points])
        if better.highest == nonlinear_mode.problem.method.highest:
            break
        nonlinear_mode, motions = follow(posed, better)
    result = _conclude(posed, nonlinear_mode, motions)
    return replace(result, findings=(*result.findings, *choice_findings(better, error)))


@dataclass(frozen=True)
class FreeLevel:
    """The equations of a nonlinear mode with a number of harmonics, and the truncation error of its motions."""

    equations: ModeEquations

    @property
    def method(self) -> HarmonicBalance:
        return self.equations.problem.method

    def truncation(self, motion: FreeMotion) -> Truncation:
        """Return the truncation error of a motion, of its frequency or of its damping ratio, whichever is largest."""
        frequency, heavy = motion.omega / (2 * np.pi), carries_mass(self.equations.problem, motion.omega)
        method = self.method.refined()
        if method is None or not self.equations.problem.nonlinear:
            return Truncation(frequency, 0.0, heavy)
        finer, better = self.padded(motion, method)
        if not better.converged:
            return Truncation(frequency, np.nan, heavy)
        shape, finer_shape = (level.equations.amplitudes(place) for level, place in ((self, motion), (finer, better)))
        # Three results depend on the harmonics: amplitude of the coordinate that moves most, frequency and damping.
        most = int(np.argmax(finer_shape))
        first, second = (each.growth / (2 * each.omega) for each in (motion, better))
        changes = (
            (finer_shape[most] - shape[most]) / finer_shape[most],
            better.omega / motion.omega - 1,
            (second - first) / max(abs(second), WEAK),
        )
        return Truncation(frequency, SLOW * max(map(abs, map(float, changes))), heavy)

    def padded(self, motion: FreeMotion, method: HarmonicBalance) -> "tuple[FreeLevel, FreeMotion]":
        """Return the equations with the harmonics of another method, and the motion solved with them."""
        finer = self.equations.with_method(method)
        guess = replace(motion, harmonics=in_orders(motion.harmonics, self.method.orders, method.orders))
        moved = finer.at_size(guess, motion.size, max(method.first_samples, motion.samples))
        return FreeLevel(finer), moved if same_mode(finer, guess, moved) else replace(moved, converged=False)


@dataclass(frozen=True)
class PosedBackbone:
    """A mode to follow with any number of harmonics. ``sizes``: the amplitudes (m), or the two ends of a path."""

    system: VibrationSystem
    sizes: np.ndarray
    is_path: bool
    mode: int
    dof: str | None
    checkpoint: Checkpoint | None


def follow(posed: PosedBackbone, method: HarmonicBalance) -> tuple[ModeEquations, list[FreeMotion]]:
    """Follow the mode with a number of harmonics: its equations and motions."""
    driven = equations(posed.system, method, posed.checkpoint, residuals=False)
    lowered = with_static_forces(driven.lowered)
    free = replace(driven, lowered=lowered, _balances={}, _stuck=ContactsStuck(lowered))
    kind = ReceptanceModes if free.by_receptances else UncondensedModes
    linear = kind(free, -1, posed.mode).linear()
    names = free.lowered.structure.dofs
    row = int(np.abs(linear.shape).argmax()) if posed.dof is None else names.index(posed.dof)
    if free.by_receptances:
        lowered = lowered.measuring(row)
        free = replace(free, lowered=lowered, _balances={}, _stuck=ContactsStuck(lowered))
    mode = kind(free, row, posed.mode)
    start = _scaled(mode.linear(), row, names.names[row])
    first = first_motion(mode, start, float(posed.sizes[0]))
    if not posed.is_path:
        return mode, list(motions_at(mode, first, posed.sizes, start.rest))
    begin, end = float(posed.sizes[0]), float(posed.sizes[1])
    known = motion_towards(mode, first, begin, start.rest) if first.converged else first
    if not known.converged:
        known = from_linear_mode(mode, start, begin) or known
    return mode, list(motions_along(mode, known, begin, end))


def _scaled(linear: Linear, row: int, name: str) -> Linear:
    """With unit motion of a degree of freedom."""
    if abs(linear.shape[row]) < 1e-9 * np.abs(linear.shape).max():
        raise InputError(f"backbone: {name!r} does not move in this mode; measure the amplitude elsewhere, dof=...")
    return replace(linear, moved=linear.moved / linear.shape[row], shape=linear.shape / linear.shape[row])


def _conclude(posed: PosedBackbone, mode: ModeEquations, motions: list[FreeMotion]) -> Backbone:
    names = mode.problem.lowered.structure.dofs.names
    energies, works = np.array([_energy_and_work(mode, motion) for motion in motions]).T
    omegas, growths, sizes, iterations, residuals, converged, samples = (
        np.array([getattr(motion, part.name) for motion in motions]) for part in fields(FreeMotion)[1:]
    )
    shapes = np.stack([mode.displacements(motion) for motion in motions])
    dof, ends = names[mode.row], (float(posed.sizes[0]), float(posed.sizes[-1]))
    what = f"amplitude of {dof}", unit_of(dof)
    # ζ = ξ/(2 ω); the force F = 2 ζ ω²/A Σ h² X_hᵀ M X_h does the work that the negative damping does.
    return Backbone(
        mode=posed.mode,
        dof=dof,
        dofs=tuple(names),
        orders=mode.problem.method.orders,
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
        provenance={**versions(), "method": asdict(mode.problem.method)},
        findings=end_findings(sizes, converged, ends, *what) if posed.is_path else (),
    )


def _energy_and_work(mode: ModeEquations, motion: FreeMotion) -> tuple[float, float]:
    """Largest kinetic energy, J, and ω Σ h² X_h^T M X_h, whose product with ξ π is what a period loses."""
    series = mode.series(motion.samples)
    velocity = motion.omega * mode.displacements(motion) @ series.derivative.T
    mass, samples = mode.mass, velocity @ series.synthesis.T
    # T = v^T M v/2 at the samples; its largest value is the energy of a conservative mode at an instant of rest
    # position.
    kinetic = 0.5 * np.einsum("it,it->t", samples, mass @ samples)
    return float(kinetic.max()), float(np.sum(velocity * (mass @ velocity)) / motion.omega)
