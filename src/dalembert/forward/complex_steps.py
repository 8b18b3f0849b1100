"""Whether numbers that depend on a parameter carry its complex step: they are compared with differences.

Central differences of a small step find functions that drop the imaginary part. Rounding to few decimals has the
derivative 0 at almost all points, by both. So the derivative is also integrated over wider intervals, by Simpson's
rule, and compared with the increments there. Where they differ in interval after interval, at jumps that bisection
confirms, the numbers follow the parameter in steps.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from dalembert.errors import InputError
from dalembert.parameters import Parameters

STEP = 1e-30  # imaginary step, in scales of the parameter; terms of second order vanish below the rounding of the first
DIFFERENCE = 1e-5  # step of the differences, in scales
_SAFETY = 2.0  # factor of the differences' error, which is six times what Taylor's series expects
_AGREES = 1e-6  # relative
_CANCELLED = 1e-14  # of the largest derivative: what may be the rounding of terms that cancel
_WIDTH = 1e-2  # of the intervals that rounding is sought in, in scales
_INTERVALS = 6  # side by side
_MOST, _ALL_FLAT = 4, 2  # intervals with jumps, of any number, and of one that is constant between
_DIFFERS = 1e-2  # relative, of an increment and the integral of the derivative
_TINY = 1e-9  # shifts at which rounding is measured, in scales
_STEEP = 0.3  # derivative times step, in parts of the largest number, from which differences cannot follow it
_SMOOTH = 1e-4  # of a number's change over the step of the differences, over the millionth part of that step
_DECADES = 6  # of smaller steps, with which differences follow a steep number
_NOISY = 16.0  # times the rounding that a difference must be
_ENTRIES = 2  # that are halved at most
_HALVINGS = 40  # until a steep function changes by less than _JUMP of the difference
_JUMP = 1e-6
DROPPING = "abs, np.abs, .real, np.linalg.norm, np.angle and rounding"
SAFE = "Use absolute, norm, hypot and atan2 of dalembert"
REMEDY = f"{SAFE}, or give derivative='central-differences'"


class Lost(NamedTuple):
    """The entry whose derivative is most wrong: by the complex step, and by differences, per unit of the parameter."""

    entry: int
    by_step: float
    by_differences: float


def lost_step(numbers: Callable[[complex], np.ndarray], scale: float) -> Lost | None:
    """Return the number that loses a complex step most, None if all carry it. ``numbers(shift)``: vector of the numbers
    where the parameter is moved by a real or an imaginary shift; ``scale``: typical size of the parameter.
    """
    here, by_step = _complex_step(numbers, 0.0, scale)
    slope, error = _differences(numbers, here, DIFFERENCE * scale)
    sizes = np.maximum(np.abs(by_step), np.abs(slope))
    excess = np.abs(by_step - slope) - error - _AGREES * sizes - _CANCELLED * _largest(sizes)
    excess[~np.isfinite(excess)] = 0.0
    width = DIFFERENCE * scale  # of the differences, over which a chaotic response is not linear
    size = _largest(np.abs(here))
    steep = np.abs(by_step) * width > (_STEEP * size or np.inf)
    if np.any(steep & (excess > 0)):
        excess[steep & ~_contradicted(numbers, here, by_step, width)] = 0.0
    if np.any(excess > 0):
        excess[excess * DIFFERENCE * scale < _NOISY * _noise(numbers, 0.0, scale)] = 0.0
    if np.max(excess, initial=0.0) <= 0:
        return None
    worst = int(np.argmax(excess / (np.abs(by_step) + np.abs(slope) + np.finfo(float).tiny)))
    return Lost(worst, float(by_step[worst]), float(f"{slope[worst]:.6g}"))


def _contradicted(
    numbers: Callable[[complex], np.ndarray], here: np.ndarray, by_step: np.ndarray, width: float
) -> np.ndarray:
    """Which numbers are smooth, but have at no step the slope of the complex step, (numbers,). A chaotic number changes
    as much over a small step as over a wide one, and a steep one has the slope at some step. A number whose imaginary
    part is rounding, as of ``-1j * log(...)``, is smooth with another slope.
    """
    steps = width * 10.0 ** -np.arange(_DECADES + 1)
    wide, small = (
        np.max([np.abs(np.real(numbers(side * step)) - here) for side in (1.0, -1.0, 0.5, -0.5)], axis=0)
        for step in (steps[0], steps[-1])
    )
    contradicted = (small < _SMOOTH * wide) & np.isfinite(by_step)
    for step in steps[1:] if np.any(contradicted) else ():
        slope, error = _differences(numbers, here, step)
        contradicted &= np.abs(by_step - slope) > error + _STEEP * np.abs(by_step)
    return contradicted


@np.errstate(all="ignore")
def stepped(numbers: Callable[[complex], np.ndarray], scale: float, shifts: tuple[float, float]) -> Lost | None:
    """Return a number that follows a parameter in steps, as after rounding; None if there is none. ``numbers``,
    ``scale``: as of :func:`lost_step`; ``shifts``: least and largest shift of the parameter, up to its bounds.
    """
    span = shifts[1] - shifts[0]
    wide = _Intervals.around(numbers, scale, shifts, span, 1)
    flat = _Intervals.around(numbers, scale, shifts, span, _INTERVALS) if np.any(wide.differ & wide.flat) else None
    if flat and (lost := flat.steps(numbers, _ALL_FLAT)):
        return lost
    width = min(_WIDTH * scale, span / _INTERVALS)
    intervals = _Intervals.around(numbers, scale, shifts, 2 * width, 1)
    while np.any(intervals.differ) and _INTERVALS * width <= span:
        intervals = _Intervals.around(numbers, scale, shifts, _INTERVALS * width, _INTERVALS)
        if lost := intervals.steps(numbers, _MOST):
            return lost
        width *= 4
    return None


class _Intervals(NamedTuple):
    """Intervals of the parameter side by side: ends (intervals + 1,), and what numbers do (intervals, numbers)."""

    ends: np.ndarray
    increments: np.ndarray
    integrals: np.ndarray  # of the derivatives
    slopes: np.ndarray  # at the ends and in the middles, (points, numbers)
    differ: np.ndarray  # whether increment and integral do, beyond the error of the integral

    @classmethod
    def around(
        cls,
        numbers: Callable[[complex], np.ndarray],
        scale: float,
        shifts: tuple[float, float],
        size: float,
        count: int,
    ) -> "_Intervals":
        """Intervals around the parameter, moved inside its bounds."""
        begin = np.clip(-size / 2, shifts[0], max(shifts[1] - size, shifts[0]))
        points = begin + size * np.linspace(0.0, 1.0, 2 * count + 1)
        values, slopes = map(np.array, zip(*(_complex_step(numbers, point, scale) for point in points), strict=True))
        first, middle, last = slopes[:-1:2], slopes[1::2], slopes[2::2]
        step = size / count
        coarse, fine = step * (first + last) / 2, step * (first + 4 * middle + last) / 6
        increments = np.diff(values[::2], axis=0)
        largest = np.max(np.abs(values), axis=0, initial=0.0)
        bound = 3 * np.abs(fine - coarse) + _DIFFERS * np.maximum(np.abs(increments), np.abs(fine))
        terms = _largest(np.abs(slopes)) * scale  # size of terms that may cancel
        rounding = 64 * np.finfo(float).eps * (largest + terms)
        excess = np.abs(increments - fine) - bound - rounding
        return cls(points[::2], increments, fine, slopes, np.isfinite(excess) & (excess > 0))

    @property
    def flat(self) -> np.ndarray:
        """Which numbers have no derivative anywhere, (numbers,)."""
        return np.all(self.slopes == 0, axis=0)

    def steps(self, numbers: Callable[[complex], np.ndarray], least: int) -> Lost | None:
        """The number that jumps in ``least`` intervals or more; in fewer than most, it is constant between jumps."""
        count = np.where(self.flat | (least == _MOST), np.sum(self.differ, axis=0), 0)
        if np.any(count >= least):
            noise = _NOISY * _noise(numbers, self.ends[0], self.ends[-1] - self.ends[0])
            clear = np.abs(self.increments - self.integrals) > noise
            count = np.where(count > 0, np.sum(self.differ & clear, axis=0), 0)
        for entry in np.argsort(-count, kind="stable")[:_ENTRIES]:
            places = np.flatnonzero(self.differ[:, entry])[:least]
            if count[entry] >= least and all(self._jumps(numbers, entry, place) for place in places):
                slope = np.sum(self.increments[:, entry]) / (self.ends[-1] - self.ends[0])
                return Lost(int(entry), float(np.mean(self.slopes[:, entry])), float(f"{slope:.6g}"))
        return None

    def _jumps(self, numbers: Callable[[complex], np.ndarray], entry: int, number: int) -> bool:
        """Whether a number jumps in an interval; a steep one changes by little in a small part of it."""
        begin, end = self.ends[number : number + 2]
        slope = self.integrals[number, entry] / (end - begin)
        after, before = (np.real(numbers(point))[entry] - slope * point for point in (end, begin))
        change = abs(after - before)
        for _ in range(_HALVINGS):
            middle = (begin + end) / 2
            between = np.real(numbers(middle))[entry] - slope * middle
            if abs(after - between) > abs(between - before):
                begin, before = middle, between
            else:
                end, after = middle, between
        return bool(abs(after - before) > _JUMP * change)


def _largest(sizes: np.ndarray) -> float:
    """Largest finite entry."""
    return float(np.max(sizes, initial=0.0, where=np.isfinite(sizes)))


def _complex_step(
    numbers: Callable[[complex], np.ndarray], shift: float, scale: float
) -> tuple[np.ndarray, np.ndarray]:
    """Numbers, and their derivatives by the complex step."""
    stepped: Any = np.asarray(numbers(shift + 1j * STEP * scale), dtype=complex)
    return stepped.real, stepped.imag / (STEP * scale)


def _noise(numbers: Callable[[complex], np.ndarray], shift: float, scale: float) -> np.ndarray:
    """How much numbers vary by rounding alone, (numbers,): at shifts by which they hardly change else.

    A number that nearly cancels varies by more than its size suggests.
    """
    here, slope = _complex_step(numbers, shift, scale)
    moves = scale * _TINY * np.sqrt(np.arange(1.0, 9.0))
    return np.max([np.abs(np.real(numbers(shift + move)) - here - slope * move) for move in moves], axis=0)


def _differences(
    numbers: Callable[[complex], np.ndarray], here: np.ndarray, step: float
) -> tuple[np.ndarray, np.ndarray]:
    """Central differences, and a bound of their error: truncation, kinks and rounding."""
    ahead, behind, near, before = (np.real(numbers(k * step)) for k in (1.0, -1.0, 0.5, -0.5))
    wide, slope = (ahead - behind) / (2 * step), (near - before) / step
    kink = np.abs(ahead - 2 * here + behind) / step
    rounding = 16 * np.finfo(float).eps * np.maximum(np.abs(ahead), np.abs(behind)) / step
    return slope, _SAFETY * np.abs(wide - slope) + kink + rounding


def check_steps(
    parameters: Parameters,
    vector: np.ndarray,
    numbers: Callable[[np.ndarray], np.ndarray],
    place: Callable[[int], str],
    *,
    thorough: bool = True,
) -> None:
    """Raise where numbers that depend on parameters lose the complex step of one of them. Where the numbers cannot be
    computed they are not compared: the model itself will report it.

    ``vector`` (parameters,): where they are compared; moved inside the bounds, so that the differences stay there.
    ``numbers``: vector of the numbers at a real or complex vector of parameters. ``place``: what an entry of the
    numbers is, for the message. ``thorough``: whether parameters are compared one by one, and rounding to few decimals
    is sought too, which needs wider differences. If not, first all parameters are compared at once.
    """
    _refuse_imaginary(numbers(vector), place)
    margin = np.minimum(DIFFERENCE * parameters.scale, (parameters.upper - parameters.lower) / 4)
    inside = np.clip(vector, parameters.lower + margin, parameters.upper - margin)
    sizes = margin / DIFFERENCE
    if not thorough and not attempted(partial(lost_step, _together(numbers, inside, sizes), 1.0)):
        return
    for column, (name, unit) in enumerate(zip(parameters.names, np.eye(len(vector)), strict=True)):
        along = cache(_line(numbers, inside, unit))  # intervals around the same point share it
        lost = attempted(partial(lost_step, along, sizes[column]))
        if lost:
            raise InputError(
                f"the derivative of {place(lost.entry)} by {name!r} is {lost.by_step:.6g} by the complex step, but "
                f"{lost.by_differences:.6g} by differences. A function of the model drops the imaginary part, as "
                f"{DROPPING} do. {REMEDY}"
            )
        shifts = parameters.lower[column] - inside[column], parameters.upper[column] - inside[column]
        lost = attempted(partial(stepped, along, parameters.scale[column], shifts)) if thorough else None
        if lost:
            raise InputError(
                f"{place(lost.entry)} follows {name!r} in steps, as after rounding: its derivative is "
                f"{lost.by_step:.6g} by the complex step, but {lost.by_differences:.6g} by wide differences. "
                "Do not round a parameter, nor numbers that depend on it"
            )


def _refuse_imaginary(numbers: np.ndarray, place: Callable[[int], str]) -> None:
    """Raise where real parameters give a complex number: its imaginary part covers that of the complex step."""
    (wrong,) = np.nonzero(np.imag(numbers))
    if len(wrong):
        raise InputError(
            f"{place(wrong[0])} is {numbers[wrong[0]]:.6g} for real parameters; expected a real number. A function of "
            "the model computes in complex numbers, as -1j * np.log(...) does: use atan2 of dalembert for angles"
        )


def check_together(
    parameters: Parameters,
    vector: np.ndarray,
    numbers: Callable[[np.ndarray], np.ndarray],
    check: Callable[[], None],
) -> None:
    """Compare numbers along one direction of all parameters; where that loses a complex step, ``check`` raises.

    Its price does not grow with the number of parameters. Parameters and numbers as in :func:`check_steps`.
    """
    margin = np.minimum(DIFFERENCE * parameters.scale, (parameters.upper - parameters.lower) / 4)
    inside = np.clip(vector, parameters.lower + margin, parameters.upper - margin)
    direction = margin / DIFFERENCE * np.random.default_rng(0).uniform(0.5, 1.0, len(inside))
    if attempted(partial(lost_step, _line(numbers, inside, direction), 1.0)):
        check()


def _line(
    numbers: Callable[[np.ndarray], np.ndarray], vector: np.ndarray, unit: np.ndarray
) -> Callable[[complex], np.ndarray]:
    """Numbers along a direction (parameters,)."""
    return lambda shift: numbers(vector + shift * unit)


def _together(
    numbers: Callable[[np.ndarray], np.ndarray], vector: np.ndarray, sizes: np.ndarray
) -> Callable[[complex], np.ndarray]:
    """Numbers along all parameters at once; those in complex numbers still get one parameter after the other."""
    moves = np.diag(sizes * np.random.default_rng(0).uniform(0.5, 1.0, len(sizes)))

    def along(shift: complex) -> np.ndarray:
        if not isinstance(shift, complex):
            return numbers(vector + shift * moves.sum(axis=0))
        stepped = [numbers(vector + shift * move) for move in moves]
        return np.real(stepped[0]) + 1j * np.sum(np.imag(stepped), axis=0)

    return along


def attempted(compare: Callable[[], Lost | None]) -> Lost | None:
    """What a comparison finds; None where the user's functions fail, which the model itself will report."""
    try:
        return compare()
    except Exception:
        return None


def check_derivatives(model: Any, vector: np.ndarray) -> None:
    """Compare the complex step of a model with differences at a vector (parameters,), where the model can.

    Nothing is simulated where the model is made by a builder; a Python function is called some times a parameter. A
    model that was compared at this vector is not compared again.

    Raises
    ------
    InputError
        Where a number of the model loses the complex step of a parameter.
    """
    compare = getattr(model, "check_derivatives", None)
    if compare is not None:
        compare(np.asarray(vector, dtype=float))


@dataclass
class Compared:
    """Where a model's complex step was compared with differences; shared with the model's shorter copies."""

    vectors: set[bytes] = field(default_factory=set)
    functions: bool = False  # whether functions of the user's were, along a motion
    together: bool = False  # whether all parameters were moved at once

    def once(self, vector: np.ndarray, compare: Callable[[bool], None]) -> None:
        """Compare at a vector where that was not done; thoroughly the first time only."""
        if vector.tobytes() not in self.vectors:
            compare(not self.vectors)
            self.vectors.add(vector.tobytes())
            self.functions = False
