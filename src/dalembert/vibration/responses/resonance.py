r"""Continuation of the peak of a response over a parameter, without whole curves.

At a peak the amplitude a(U, ω) neither rises nor falls along the path of solutions,
:math:`\nabla a \cdot (\mathrm{d}U, \mathrm{d}\omega) = 0`, with the tangent of the path from the exact Jacobian. That
place is bracketed by steps of arc length, so that a peak beside a fold is found too, and narrowed by Brent's method.
From one value of the parameter to the next the solution is corrected on a plane across the path.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.forward import Checkpoint
from dalembert.forward.builders import check_function
from dalembert.threads import single_thread
from dalembert.vibration.balance.arc_length import PathTangent, direction_at, zero_between
from dalembert.vibration.balance.equations import Equations, by_stiffness, equations
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import CrossingPlane, Solution
from dalembert.vibration.balance.truncation import ForcedLevel, Truncation, choice_findings, enough_harmonics, hardest
from dalembert.vibration.fourier import synthesis
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.paths.amplitudes import Amplitude, highest_order
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import response_of, restarted
from dalembert.vibration.responses.frequency_response import ARC_LENGTH, frequency_response
from dalembert.vibration.responses.resonance_track import ResonanceTrack
from dalembert.vibration.storage import versions
from dalembert.vibration.system.requirements import values_of
from dalembert.vibration.system.system import VibrationSystem

WIDTH = 0.1
"""Change of ω, as part of itself, that counts as much along the path as the whole motion."""
FIRST, LONGEST, SHORTEST = 0.02, 0.3, 1e-6
"""Steps along the path, as part of the motion."""
BEYOND = 1.5
"""Step that is to pass the peak, as part of the way to it by the curvature at the peak before."""
MOST_STEPS = 60
NARROW = 1e-6
"""Length along the path to which a peak is found."""


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
    unit: str = "",
    checkpoint: Checkpoint | None = None,
) -> ResonanceTrack:
    """Follow the peak of a response over a parameter of the system, such as a preload or a force.

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
    method = by_stiffness(method or HarmonicBalance(), "track_resonance").keeping(highest_order(kind))
    check_function("track_resonance", builder, [parameter])
    first = builder(**{parameter: float(numbers[0])})
    name = (names := lower(first).structure.dofs).names[row := names.index(dof)]
    Amplitude(kind, method.first().orders)  # an unknown kind is refused before a curve is followed
    posed = _PosedTrack(builder, parameter, unit, numbers, method, name, row, kind, checkpoint)
    curve, level, spent = _first_curve(posed, first, start)
    level, peaks, findings = _follow(posed, curve, level)
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
        provenance={**versions(), "method": asdict(level)},
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
    checkpoint: Checkpoint | None

    def equations(self, value: float, level: HarmonicBalance) -> Equations:
        return equations(self.builder(**{self.parameter: value}), level, self.checkpoint)


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
) -> "tuple[HarmonicBalance, list[tuple[_Peak | None, int]], tuple[Finding, ...]]":
    """Follow the peak, with more and more harmonics where their number is chosen.

    Returns the method, each peak with its number of solutions, and the finding on harmonics.
    """
    while True:
        problem = partial(posed.equations, level=level)
        first, value = problem(float(posed.values[0])), float(posed.values[0])
        sizes = Amplitude(posed.kind, curve.orders).of(curve.harmonics(posed.dof))
        if not np.any(np.isfinite(sizes)):
            raise InputError("track_resonance: no point of the first curve was found; begin with another window")
        top = restarted(first, curve, int(np.nanargmax(sizes)), "track_resonance")
        climber = _Climber(posed.row, Amplitude(posed.kind, level.orders))
        peaks = list(_followed(problem, climber, posed.values, _Peak(value, first, top)))
        if not posed.method.automatic:
            return level, peaks, ()
        better, error = _enough_harmonics(level, [peak for peak, _ in peaks if peak is not None])
        if better.highest == level.highest:
            return level, peaks, choice_findings(level, error)
        level = better


def _enough_harmonics(level: HarmonicBalance, peaks: "list[_Peak]") -> tuple[HarmonicBalance, Truncation | None]:
    """Return the method whose truncation errors at the hardest of the peaks are small, and the largest of them."""
    unknowns = np.stack([peak.solution.unknowns for peak in peaks]) if peaks else np.zeros((0, 1, 1))
    method, largest = level, None
    for place in hardest(unknowns, np.ones(len(peaks), dtype=bool), 0.0):
        better, error = enough_harmonics(ForcedLevel(peaks[place].problem, 0.0), [peaks[place].solution])
        method = better if better.highest > method.highest else method
        if error is not None and (largest is None or error.rank > largest.rank):
            largest = error
    return method, largest


@dataclass(frozen=True)
class _Peak:
    """A peak at a value of the parameter, and the curvature of the logarithm of the amplitude along the path."""

    value: float
    problem: Equations
    solution: Solution
    amplitude: float = float("nan")
    bend: float = float("nan")


def _followed(
    problem: Callable[[float], Equations], climber: "_Climber", values: np.ndarray, begin: _Peak
) -> Iterator[tuple[_Peak | None, int]]:
    """Yield the peak at each value, None if not converged, and the number of solutions."""
    known, before = begin, None
    for value in values:
        way, count, reached = [float(value)], 0, None
        while way:
            at_value = problem(way[-1])
            corrected, spent = _carried(at_value, known, before, way[-1])
            peak, climbed = (None, 0) if corrected is None else climber.climb(at_value, corrected, known.bend)
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


def _carried(problem: Equations, known: _Peak, before: _Peak | None, value: float) -> tuple[Solution | None, int]:
    """Return a solution at another value near a known peak, on a plane across the path, and the number of trials."""
    last, tries = known.solution, [0.0]
    if before is not None and known.value != before.value:
        # A secant through the last two peaks first, then the last peak itself.
        tries.insert(0, (value - known.value) / (known.value - before.value))
    width = WIDTH * last.omega
    direction = direction_at(last, _upwards(last), width)
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


def _upwards(solution: Solution) -> np.ndarray:
    direction = np.zeros(solution.unknowns.size + 1)
    direction[-1] = 1.0
    return direction


@dataclass(frozen=True)
class _Climber:
    """Search of the largest amplitude of a row of the structure along a path."""

    row: int
    size: Amplitude

    def climb(self, problem: Equations, solution: Solution, bend: float) -> tuple[_Peak | None, int]:
        """Return the peak next to a solution, and the number of solutions."""
        width = WIDTH * solution.omega
        direction = direction_at(solution, _upwards(solution), width)
        rise = self._rise(problem, solution, direction, PathTangent(solution, direction, width).size, width)
        if rise < 0:
            rise, direction = -rise, -direction
        length = FIRST if np.isnan(bend) else float(np.clip(BEYOND * abs(rise / bend), SHORTEST, LONGEST))
        for count in range(1, MOST_STEPS + 1):
            path = PathTangent(solution, direction, width)
            ahead, onward = path.step(problem, length)
            if onward is None:
                length /= 4
                if length < SHORTEST:
                    return None, count
                continue
            beyond = self._rise(problem, ahead, onward, path.size, width)
            # The slope of the amplitude changes its sign within this step: Brent's method narrows it.
            if beyond < 0:
                peak, spent = self._narrowed(problem, path, ahead, (rise, beyond), length)
                return peak, count + spent
            solution, direction, rise = ahead, direction_at(ahead, onward, width), beyond
            length = min(LONGEST, 2 * length)
        return None, MOST_STEPS

    def _narrowed(
        self, problem: Equations, path: PathTangent, ahead: Solution, rises: tuple[float, float], length: float
    ) -> tuple[_Peak | None, int]:
        """Return the peak between the ends of a step: a zero of the slope of the amplitude."""

        def rise(part: float) -> tuple[Solution, float]:
            solution, onward = path.step(problem, part)
            value = float("nan") if onward is None else self._rise(problem, solution, onward, path.size, path.width)
            return solution, value

        tried = {0.0: (path.known, rises[0]), length: (ahead, rises[1])}
        solution = zero_between(rise, length, tried, NARROW)
        if solution is None:
            return None, len(tried) - 2
        amplitude = float(self.size.of(response_of(problem, solution)[self.row]))
        return _Peak(np.nan, problem, solution, amplitude, (rises[1] - rises[0]) / length), len(tried) - 2

    def _rise(self, problem: Equations, solution: Solution, direction: np.ndarray, size: float, width: float) -> float:
        """Derivative of the logarithm of the amplitude along the path."""
        # ∇a · (dU, dω)/a with dx_l = -Z_ll⁻¹ Z_lq dU + (∂x_l/∂ω) dω
        series, point = problem.balance(solution.samples).series, solution.condensed
        change = series.phasors(direction[:-1].reshape(solution.unknowns.shape) * size)
        retained = series.phasors(solution.unknowns)
        interior = problem.condensation.interior_slope(point, retained) * (direction[-1] * width)
        interior = interior - (point.follow @ change[:, :, None])[:, :, 0]
        motion = response_of(problem, solution)[self.row]
        moved = series.coefficients(problem.condensation.full(change, interior))[self.row]
        return float(_gradient(self.size, motion) @ moved) / float(self.size.of(motion))


def _gradient(size: Amplitude, motion: np.ndarray) -> np.ndarray:
    """Derivative of an amplitude by the coefficients; of a peak at its own instant, not at the nearest sample."""
    if size.kind != "peak":
        return size.slope(motion)
    angle = size.instant(motion)
    orders = np.array([h for h in size.orders for _ in range(1 if h == 0 else 2)])
    for _ in range(3):
        waves = synthesis(size.orders, np.array([angle]))[0]
        # A peak lies at x'(τ) = 0: three steps of Newton from the nearest sample take its instant to rounding.
        turned = synthesis(size.orders, np.array([angle + 1e-30j]))[0].imag / 1e-30
        angle -= float(turned @ motion) / float(-(orders**2 * waves) @ motion)
    waves = synthesis(size.orders, np.array([angle]))[0]
    return np.sign(waves @ motion) * waves  # of two opposite peaks of one size, the sign of the one at this instant
