"""Functions of time for loads and prescribed motions."""

__all__ = ["Constant", "Custom", "Harmonic", "Polynomial", "Signal", "Step", "Table"]

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import CubicSpline

from dalembert.arguments import Checked
from dalembert.errors import InputError, unknown
from dalembert.multibody.components.fields import Number
from dalembert.multibody.kernels import signals as kinds

if TYPE_CHECKING:
    from dalembert.multibody.lowering import Lowering


@dataclass(frozen=True)
class Signal(Checked):
    """Base of all functions of time."""

    IN_WORDS = "a function of time such as Harmonic(amplitude, angular_frequency)"

    @abstractmethod
    def lower(self, lowering: "Lowering") -> tuple[int, Sequence[Number], Sequence[float]]:
        """Kind, numbers and knots, as the kernels keep them."""

    @property
    def jumps(self) -> tuple[float, ...]:
        """Times at which the value jumps; integration starts anew there."""
        return ()

    @property
    def kinks(self) -> tuple[float, ...]:
        """Times at which the rate of a smooth function jumps; no prescribed motion may reach beyond."""
        return ()


@dataclass(frozen=True)
class Constant(Signal):
    """The same value at all times."""

    value: Number

    def lower(self, lowering: "Lowering") -> tuple[int, Sequence[Number], Sequence[float]]:
        return kinds.CONSTANT, [self.value], []


@dataclass(frozen=True)
class Step(Signal):
    """``value`` from ``start`` until ``end`` (s), zero before and after."""

    value: Number
    start: float = field(default=0.0, metadata={"unit": "s"})
    end: float = field(default=np.inf, metadata={"unit": "s"})

    def __post_init__(self) -> None:
        if not self.start < self.end:
            raise InputError(f"Step: start is {self.start} s and end is {self.end} s; expected start before end")

    def lower(self, lowering: "Lowering") -> tuple[int, Sequence[Number], Sequence[float]]:
        return kinds.STEP, [self.value], [float(self.start), float(self.end)]

    @property
    def jumps(self) -> tuple[float, ...]:
        return float(self.start), float(self.end)


@dataclass(frozen=True)
class Harmonic(Signal):
    """``amplitude * sin(angular_frequency * t + phase) + offset``, rad/s and rad."""

    amplitude: Number
    angular_frequency: Number = field(metadata={"unit": "rad/s"})
    phase: Number = field(default=0.0, metadata={"unit": "rad"})
    offset: Number = 0.0

    def lower(self, lowering: "Lowering") -> tuple[int, Sequence[Number], Sequence[float]]:
        return kinds.HARMONIC, [self.amplitude, self.angular_frequency, self.phase, self.offset], []


@dataclass(frozen=True)
class Polynomial(Signal):
    """``coefficients[0] + coefficients[1] * t + ...``, t in s."""

    coefficients: Sequence[Number]

    def lower(self, lowering: "Lowering") -> tuple[int, Sequence[Number], Sequence[float]]:
        return kinds.POLYNOMIAL, list(self.coefficients), []


@dataclass(frozen=True)
class Table(Signal):
    """Values at times, joined by lines or by a cubic spline, held beyond the ends.

    Parameters
    ----------
    times : sequence of float, shape (points,)
        s, increasing.
    values : sequence of float, shape (points,)
    kind : {"cubic", "linear"}
        A prescribed motion needs a cubic one: its velocity must not jump.
    """

    times: Sequence[float]
    values: Sequence[Number]
    kind: str = "cubic"

    def __post_init__(self) -> None:
        if self.kind not in ("cubic", "linear"):
            raise InputError(unknown("kind", self.kind, ("cubic", "linear"), "Table"))
        if len(self.times) != len(self.values) or len(self.times) < 2:
            raise InputError(
                f"Table: {len(self.times)} times and {len(self.values)} values were given; "
                "expected as many, at least two"
            )
        if not np.all(np.diff(self.times) > 0):
            raise InputError("Table: times must increase; sort them and remove repeated ones")

    @property
    def kinks(self) -> tuple[float, ...]:
        """The ends at which the spline comes or goes with a slope."""
        times, values = np.asarray(self.times, dtype=float), np.real(self.values)
        ends = times[[0, -1]]
        slopes = np.abs(self._spline(times, values)(ends, 1)) * (ends[1] - ends[0])
        return tuple(float(end) for end, slope in zip(ends, slopes, strict=True) if slope > 1e-6 * np.ptp(values))

    @staticmethod
    def _spline(times: np.ndarray, values: np.ndarray) -> CubicSpline:
        return CubicSpline(times, values, bc_type="natural")

    def lower(self, lowering: "Lowering") -> tuple[int, Sequence[Number], Sequence[float]]:
        times, values = np.asarray(self.times, dtype=float), np.asarray(self.values)
        if self.kind == "cubic":
            pieces = self._spline(times, values).c[::-1].T
        else:
            pieces = np.zeros((len(times) - 1, 4), dtype=values.dtype if values.dtype == complex else float)
            pieces[:, 0], pieces[:, 1] = values[:-1], np.diff(values) / np.diff(times)
        return kinds.PIECEWISE, pieces.ravel().tolist(), times.tolist()


@dataclass(frozen=True)
class Custom(Signal):
    """A function of the user's, ``function(t) -> value``, plain or compiled by Numba.

    Parameters
    ----------
    function : callable
        Called with the time in s once a step. A plain Python function is slower than one under ``numba.njit``.
    rate, second : callable, optional
        Its derivatives by time; taken by central differences where not given. Only prescribed motions need them, at the
        start of a motion and in diagnostics.
    """

    function: Callable[[float], Any]
    rate: Callable[[float], Any] | None = None
    second: Callable[[float], Any] | None = None

    def lower(self, lowering: "Lowering") -> tuple[int, Sequence[Number], Sequence[float]]:
        return kinds.CUSTOM, [], []


#: What a load or a motion takes: a number, or a function of time.
Course = Number | Signal


def as_signal(value: Course) -> Signal:
    """Numbers become constants."""
    return value if isinstance(value, Signal) else Constant(value)
