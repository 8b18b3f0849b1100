r"""Continuation of the peak of a response over a parameter, without whole curves.

At a peak the amplitude a(U, ω) neither rises nor falls along the path of solutions,
:math:`\nabla a \cdot (\mathrm{d}U, \mathrm{d}\omega) = 0`, with the tangent of the path from the exact Jacobian. That
place is bracketed by steps of arc length, so that a peak beside a fold is found too, and narrowed by Brent's method.
From one value of the parameter to the next the solution is corrected on a plane across the path.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.forward import Checkpoint
from dalembert.forward.builders import check_function
from dalembert.threads import single_thread
from dalembert.vibration.balance.arc_length import direction_at
from dalembert.vibration.balance.equations import Equations, chosen_solver, equations, require_one_period
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import CrossingPlane, Solution
from dalembert.vibration.balance.truncation import ForcedLevel, Truncation, choice_findings, enough_harmonics, hardest
from dalembert.vibration.interface.contacts_stuck import KnownStructures
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.paths.amplitudes import Amplitude, highest_order
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import measured_again, restarted
from dalembert.vibration.responses.followed_curve import ARC_LENGTH
from dalembert.vibration.responses.frequency_response import frequency_response
from dalembert.vibration.responses.peak_search import WIDTH, Peak, PeakSearch, upwards
from dalembert.vibration.responses.phase_search import PhaseSearch
from dalembert.vibration.responses.resonance_track import ResonanceTrack
from dalembert.vibration.storage import versions
from dalembert.vibration.system.requirements import require_forces, values_of
from dalembert.vibration.system.system import VibrationSystem


@takes_checked("values")
@single_thread()
def track_resonance(
    builder: Callable[..., VibrationSystem],
    parameter: str,
    values: Sequence[float] | np.ndarray,
    start: tuple[float, float] | FrequencyCurve,
    method: HarmonicBalance | None = None,
    *,
    dof: str,
    kind: str = "peak",
    phase: float | None = None,
    unit: str = "",
    checkpoint: Checkpoint | None = None,
) -> ResonanceTrack:
    """Follow the peak of a response, or its phase resonance, over a parameter such as a preload or a force.

    Parameters
    ----------
    builder : callable
        ``builder(**{parameter: value}) -> VibrationSystem``.
    parameter : str
    values : sequence of float
        In the order in which the peak is followed.
    start : pair of float, or FrequencyCurve
        Hz, around the peak at the first value, where one curve is followed to find it; or a curve at that value.
    method : HarmonicBalance, optional
        With ``harmonics="auto"``, one number for all values, with which the truncation errors of the largest peak and
        of the three with the largest last harmonics are small.
    dof : str
        Degree of freedom, or a node with only one.
    kind : str
        ``"peak"``, ``"rms"``, or ``"harmonic 1"`` and so on.
    phase : float, optional
        rad: the point is followed at which the first harmonic of ``dof`` has this phase relative to the force, in place
        of the peak. With -π/2 it is the phase resonance, as a phase-locked loop finds it. The force is that on ``dof``,
        else the largest one.
    unit : str
        Of the parameter.
    checkpoint : Checkpoint, optional
        File in which solutions are stored as they are found. A run that was interrupted and is started again with the
        same file reads them, and its results are equal to the bits.

    Returns
    -------
    ResonanceTrack
        Where the peak is not found from the previous value, nor by halved steps of the parameter, the value is marked
        as not converged. Each peak continues the previous one; another peak may have become larger.

    Raises
    ------
    InputError
        For values that are not numbers, an unknown degree of freedom or kind, and a start that does not fit.

    Examples
    --------
    A medium preload damps most: a smaller one dissipates less, and with a larger one the contact sticks.

    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import ElasticSlider, FrictionContact, HarmonicForce, VibrationSystem
    >>> def oscillator(preload):
    ...     system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    ...     system.add(HarmonicForce("m", 1.0))
    ...     law = ElasticSlider(tangential_stiffness=0.8)
    ...     system.add(FrictionContact("damper", "m", friction=0.5, preload=preload, law=law))
    ...     return system
    >>> method = HarmonicBalance(3, samples=128)
    >>> track = track_resonance(oscillator, "preload", [2.0, 4.0, 8.0], (0.1, 0.3), method, dof="m", unit="N")
    >>> track.amplitudes.round(2).tolist(), track.best()
    ([3.63, 3.68, 5.79], 2.0)
    """
    numbers = values_of(values, "track_resonance", parameter)
    method = (method or HarmonicBalance()).keeping(highest_order(kind))
    require_one_period(method, "track_resonance")
    check_function("track_resonance", builder, [parameter])
    first = builder(**{parameter: float(numbers[0])})
    lowered = lower(first)
    method = replace(method, solver=chosen_solver(lowered, method))
    name = (names := lowered.structure.dofs).names[row := names.index(dof)]
    Amplitude(kind, method.first().orders)  # an unknown kind is refused before a curve is followed
    if phase is not None and not np.isfinite(phase):
        raise InputError(f"track_resonance: phase is {phase}; expected a number in rad")
    highest = 2 * np.pi * float(np.nanmax(start.frequencies if isinstance(start, FrequencyCurve) else start))
    posed = _PosedTrack(builder, parameter, unit, numbers, method, name, row, kind, phase, checkpoint, highest)
    curve, level, spent = _first_curve(posed, first, start)
    level, peaks, findings = _follow(posed, curve, level)
    places = [peak.solution.omega / (2 * np.pi) for peak, _ in peaks if peak is not None]
    if places:
        require_forces(first.forces, np.array(places), "track_resonance")
    solves = np.array([count for _, count in peaks])
    solves[0] += spent
    return ResonanceTrack(
        parameter=posed.parameter,
        unit=posed.unit,
        dof=posed.dof,
        kind=posed.kind,
        values=posed.values,
        frequencies=np.array([peak.solution.omega / (2 * np.pi) if peak else np.nan for peak, _ in peaks]),
        amplitudes=np.array([peak.amplitude if peak else np.nan for peak, _ in peaks]),
        solves=solves,
        converged=np.array([peak is not None for peak, _ in peaks]),
        provenance={**versions(), "method": asdict(level), **({} if phase is None else {"phase": float(phase)})},
        findings=findings,
    )


@dataclass(frozen=True)
class _PosedTrack:
    """A peak to follow with any number of harmonics."""

    builder: Callable[..., VibrationSystem]
    parameter: str
    unit: str
    values: np.ndarray
    method: HarmonicBalance
    dof: str
    row: int
    kind: str
    phase: float | None
    checkpoint: Checkpoint | None

    highest: float
    known: KnownStructures = field(default_factory=KnownStructures)

    def equations(self, value: float, level: HarmonicBalance) -> Equations:
        system = self.builder(**{self.parameter: value})
        return equations(system, level, self.checkpoint, known=self.known, highest=self.highest, measured=self.row)


def _first_curve(
    posed: _PosedTrack, system: VibrationSystem, start: tuple[float, float] | FrequencyCurve
) -> tuple[FrequencyCurve, HarmonicBalance, int]:
    """Return a curve around the first peak, the method of the first track, and the number of solutions."""
    method = posed.method
    if isinstance(start, FrequencyCurve):
        return start, method.keeping(system.highest_harmonic).at_least(start.orders[-1]).first(), 1
    options = {"observe": [posed.dof], "check": False, "checkpoint": posed.checkpoint}
    curve = frequency_response(system, start, method, continuation=ARC_LENGTH, **options)
    return curve, replace(method, harmonics=curve.orders[-1]), 1 + len(curve)


def _follow(
    posed: _PosedTrack, curve: FrequencyCurve, level: HarmonicBalance
) -> "tuple[HarmonicBalance, list[tuple[Peak | None, int]], tuple[Finding, ...]]":
    """Follow the peak, with more and more harmonics where their number is chosen.

    Returns the method, each peak with its number of solutions, and the finding on harmonics.
    """
    while True:
        problem = partial(posed.equations, level=level)
        first, value = problem(float(posed.values[0])), float(posed.values[0])
        sizes = Amplitude(posed.kind, curve.orders).of(curve.harmonics(posed.dof))
        if not np.any(np.isfinite(sizes)):
            raise InputError("track_resonance: no point of the first curve was found; begin with another window")
        system, options = posed.builder(**{posed.parameter: value}), {"known": posed.known, "highest": posed.highest}
        plain = equations(system, level, posed.checkpoint, **options)
        top = measured_again(first, plain, restarted(plain, curve, int(np.nanargmax(sizes)), "track_resonance"))
        size = Amplitude(posed.kind, level.orders)
        seeker = PeakSearch(size) if posed.phase is None else PhaseSearch(posed.row, size, posed.phase)
        peaks = list(_followed(problem, seeker, posed.values, Peak(value, first, top)))
        if not posed.method.automatic:
            return level, peaks, ()
        better, error = _enough_harmonics(level, [peak for peak, _ in peaks if peak is not None])
        if better.highest == level.highest:
            return level, peaks, choice_findings(level, error)
        level = better


def _enough_harmonics(level: HarmonicBalance, peaks: list[Peak]) -> tuple[HarmonicBalance, Truncation | None]:
    """Return the method whose truncation errors at the hardest of the peaks are small, and the largest of them."""
    unknowns = np.stack([peak.solution.unknowns for peak in peaks]) if peaks else np.zeros((0, 1, 1))
    method, largest = level, None
    for place in hardest(unknowns, np.ones(len(peaks), dtype=bool), 0.0):
        better, error = enough_harmonics(ForcedLevel(peaks[place].problem, 0.0), [peaks[place].solution])
        method = better if better.highest > method.highest else method
        if error is not None and (largest is None or error.rank > largest.rank):
            largest = error
    return method, largest


def _followed(
    problem: Callable[[float], Equations], seeker: PeakSearch | PhaseSearch, values: np.ndarray, begin: Peak
) -> Iterator[tuple[Peak | None, int]]:
    """Yield the peak at each value, None if not converged, and the number of solutions."""
    known, before = begin, None
    for value in values:
        way, count, reached = [float(value)], 0, None
        while way:
            at_value = problem(way[-1])
            corrected, spent = _carried(at_value, known, before, way[-1])
            peak, climbed = (None, 0) if corrected is None else seeker.search(at_value, corrected, known.bend)
            count += spent + climbed
            if peak is not None:
                reached = replace(peak, value=way.pop())
                before, known = known, reached
            elif len(way) > at_value.method.halvings or way[-1] == known.value:
                reached = None
                break
            else:
                way.append((known.value + way[-1]) / 2)
        yield (reached if reached is not None and reached.value == value else None), count


def _carried(problem: Equations, known: Peak, before: Peak | None, value: float) -> tuple[Solution | None, int]:
    """Return a solution at another value near a known peak, on a plane across the path, and the number of trials."""
    last, tries = known.solution, [0.0]
    if before is not None and known.value != before.value:
        # A secant through the last two peaks first, then the last peak itself.
        tries.insert(0, (value - known.value) / (known.value - before.value))
    width = WIDTH * last.omega
    direction = direction_at(last, upwards(last), width)
    for number, part in enumerate(tries):
        guess, omega = last.unknowns, last.omega
        if part and before is not None and guess.shape == before.solution.unknowns.shape:
            guess = guess + part * (guess - before.solution.unknowns)
            omega = omega + part * (omega - before.solution.omega)
        # Across the path, not at a frequency: beside a fold the peak's frequency may have no solution at the next
        # value.
        plane = CrossingPlane(direction, guess, omega, float(np.linalg.norm(last.unknowns)) or 1.0, width)
        solution = problem.solve(guess, omega, last.samples, plane)
        if solution.converged and solution.omega > 0:
            return solution, number + 1
    return None, len(tries)
