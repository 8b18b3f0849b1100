"""Functions of time for loads and prescribed motions."""

__all__ = ["BSpline", "Constant", "Custom", "Harmonic", "Polynomial", "Signal", "Step", "Table"]

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, Protocol

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError, require_known
from dalembert.multibody.components.fields import Number
from dalembert.multibody.kernels import signal_values as kinds


@dataclass(frozen=True)
class Signal(Checked):
    """Base of all functions of time."""

    IN_WORDS = "a function of time such as Harmonic(amplitude, angular_frequency)"

    @abstractmethod
    def lower(self) -> "tuple[int, Numbers, Numbers]":
        """Kind, numbers and knots, as the kernels keep them."""

    @property
    def jumps(self) -> tuple[float, ...]:
        """Times at which the value jumps; integration starts anew there, unless the signal :attr:`steps`."""
        return ()

    @property
    def steps(self) -> bool:
        """Whether it jumps so often that a method may take the mean at a jump instead of starting anew."""
        return False

    @property
    def kinks(self) -> tuple[float, ...]:
        """Times at which the rate of a smooth function jumps; no prescribed motion may reach beyond."""
        return ()


@dataclass(frozen=True)
class Constant(Signal):
    """The same value at all times."""

    value: Number

    def lower(self) -> "tuple[int, Numbers, Numbers]":
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

    def lower(self) -> "tuple[int, Numbers, Numbers]":
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

    def lower(self) -> "tuple[int, Numbers, Numbers]":
        return kinds.HARMONIC, [self.amplitude, self.angular_frequency, self.phase, self.offset], []


@dataclass(frozen=True)
class Polynomial(Signal):
    """``coefficients[0] + coefficients[1] * t + ...``, t in s."""

    coefficients: Sequence[Number]

    def lower(self) -> "tuple[int, Numbers, Numbers]":
        return kinds.POLYNOMIAL, list(self.coefficients), []


@dataclass(frozen=True)
class Table(Signal):
    """``scale * v(t - delay) + offset``, where v has values at times and is held beyond the first and the last.

    Parameters
    ----------
    times : sequence of float, shape (points,)
        s, increasing.
    values : sequence of float, shape (points,)
    interpolation : {"cubic", "linear", "held"}
        Between the times: a natural cubic spline, lines, or the value of the time before (zero-order hold, as
        amplifiers and digital outputs have it). A prescribed motion needs a cubic one: its velocity must not jump.
        Steps end at each change of a held value. Generalized-alpha takes the mean of both values there, so that the
        error stays of second order; the other methods start anew.
    scale, offset : float
        Factor, and what is added: the gain and the bias of a sensor, or a torque constant for a measured current.
    delay : float
        s, positive where the value acts later than the times say. A held table has no derivative by its delay.
    integrals : {0, 1, 2}
        How many times the values, with scale and offset, are integrated over time from 0 at the first of the times. A
        measured acceleration of a base is a prescribed motion with two. The simulation must then end within the times.

    Raises
    ------
    InputError
        For times that do not increase, and for a held table whose delay depends on a parameter for which exact
        derivatives are computed.

    Examples
    --------
    >>> drive = Table([0.0, 0.1, 0.2], [0.0, 2.0, 1.0], "linear", scale=0.35, delay=7e-3)
    >>> drive.scale
    0.35
    """

    times: Sequence[float] = field(metadata={"unit": "s"})
    values: Sequence[Number]
    interpolation: str = "cubic"
    scale: Number = 1.0
    offset: Number = 0.0
    delay: Number = field(default=0.0, metadata={"unit": "s"})
    integrals: int = 0

    def __post_init__(self) -> None:
        require_known("interpolation", self.interpolation, TABLE_KINDS, "Table")
        if len(self.times) != len(self.values) or len(self.times) < 2:
            raise InputError(
                f"Table: {len(self.times)} times and {len(self.values)} values were given; "
                "expected as many, at least two"
            )
        if not np.all(np.diff(self.times) > 0):
            raise InputError("Table: times must increase; sort them and remove repeated ones")
        if self.integrals not in range(3):
            raise InputError(f"Table: integrals is {self.integrals}; expected 0, 1 or 2")
        if self.steps and np.iscomplexobj(self.delay):
            raise InputError(
                "Table: the response to a held value has no derivative by its delay, since each change of the value "
                "moves in time as a jump; take interpolation = 'linear', or a delay that depends on no parameter"
            )

    @classmethod
    def of(cls, data: "Measured", channel: str, interpolation: str = "linear", **more: Any) -> "Table":
        """A table of a measured channel.

        Parameters
        ----------
        data : Measurements
            Missing samples are left out: the table goes from the sample before a gap to that behind it. Angles that
            wrap are taken without their jumps.
        channel : str
        interpolation : {"linear", "cubic", "held"}
        **more
            ``scale``, ``offset``, ``delay`` and ``integrals`` of the table.

        Raises
        ------
        InputError
            For a channel that there is not, with the nearest names.

        Examples
        --------
        >>> from dalembert.data import Measurements
        >>> data = Measurements.of([0.0, 0.1, 0.2], {"current": [0.0, 2.0, 1.0]})
        >>> Table.of(data, "current", scale=0.35).values.tolist()
        [0.0, 2.0, 1.0]
        """
        require_known("channel", channel, data.channels, "Table.of")
        values = data.continuous[:, data.channels.index(channel)]
        there = np.isfinite(values)
        own: Any = cls
        return own(data.coordinate.values[there], values[there], interpolation, **more)

    @property
    def steps(self) -> bool:
        return self.interpolation == "held" and self.integrals == 0

    @property
    def is_smooth(self) -> bool:
        """Whether the rate does not jump, so that a motion can follow it."""
        return self.interpolation == "cubic" or self.integrals > (self.interpolation == "held")

    @property
    def jumps(self) -> tuple[float, ...]:
        """Times at which a held value changes."""
        if not self.steps:
            return ()
        changes = 1 + np.flatnonzero(np.diff(np.real(self.values)))
        return tuple((np.asarray(self.times, dtype=float)[changes] + np.real(self.delay)).tolist())

    @property
    def kinks(self) -> tuple[float, ...]:
        """The ends at which the spline comes or goes with a slope; the end of a table that is integrated."""
        times, values = np.asarray(self.times, dtype=float), np.real(self.values)
        ends = times[[0, -1]]
        slopes = np.array([0.0, np.inf])
        if self.integrals == 0:
            slopes = np.abs(_natural_spline(times, values)(ends, 1)) * (ends[1] - ends[0])
        steep = slopes > 1e-6 * np.ptp(values)
        return tuple(float(end + np.real(self.delay)) for end in ends[steep])

    def lower(self) -> "tuple[int, Numbers, Numbers]":
        times, values = np.asarray(self.times, dtype=float), np.asarray(self.values)
        values = values if np.iscomplexobj(values) else values.astype(float)
        head = [self.scale, self.offset, self.delay, float(self.integrals)]
        if self.steps:
            return kinds.HELD, np.concatenate([[*head, 1.0], values]), times
        pieces = _pieces(times.tobytes(), values.tobytes(), values.dtype.char, self.interpolation, self.integrals)
        return kinds.PIECEWISE, np.concatenate([[*head, float(pieces.shape[1])], pieces.ravel()]), times


#: Coefficients of t^0 to t^3 (rows) over a piece of length 1, by its four coefficients of the spline (columns).
_UNIFORM = np.array([[1.0, 4.0, 1.0, 0.0], [-3.0, 0.0, 3.0, 0.0], [3.0, -6.0, 3.0, 0.0], [-1.0, 3.0, -3.0, 1.0]]) / 6.0


@dataclass(frozen=True)
class BSpline(Signal):
    """Cubic B-spline with even knots: an unknown history whose coefficients are parameters.

    The value is the sum of ``coefficients[k] B(t / h - k + 3)``, with B the cubic cardinal B-spline, t from ``start``,
    and pieces of the length h = (end - start) / (coefficients - 3). So each coefficient changes four pieces alone,
    which makes derivatives by hundreds of coefficients cheap. A cubic :class:`Table` goes through its values, but each
    of them changes all pieces.

    Parameters
    ----------
    coefficients : sequence of float, shape (coefficients,)
        At least four. Equal ones are a constant of that value.
    start, end : float
        s; before and after the value is held.

    Raises
    ------
    InputError
        For fewer than four coefficients, and for an end that is not after the start.

    Examples
    --------
    >>> BSpline([0.0, 1.0, 2.0, 1.0, 0.0], 0.0, 0.4).pieces
    2
    """

    coefficients: Sequence[Number]
    start: float = field(metadata={"unit": "s"})
    end: float = field(metadata={"unit": "s"})

    def __post_init__(self) -> None:
        if len(self.coefficients) < 4:
            raise InputError(f"BSpline: {len(self.coefficients)} coefficients were given; expected at least four")
        if not self.start < self.end:
            raise InputError(f"BSpline: start is {self.start} s and end is {self.end} s; expected start before end")

    @property
    def pieces(self) -> int:
        """Number of its polynomials."""
        return len(self.coefficients) - 3

    @property
    def kinks(self) -> tuple[float, ...]:
        """The ends at which the spline has a slope."""
        c = np.real(self.coefficients)
        steep = np.abs([c[2] - c[0], c[-1] - c[-3]]) > 1e-6 * np.ptp(c)
        return tuple(time for time, is_steep in zip((self.start, self.end), steep, strict=True) if is_steep)

    def lower(self) -> "tuple[int, Numbers, Numbers]":
        c, count = np.asarray(self.coefficients), self.pieces
        knots = np.linspace(self.start, self.end, count + 1)
        length = (self.end - self.start) / count
        windows = np.stack([c[k : k + count] for k in range(4)], axis=1)
        pieces = windows @ _UNIFORM.T / length ** np.arange(4)
        return kinds.PIECEWISE, np.concatenate([[1.0, 0.0, 0.0, 0.0, 4.0], pieces.ravel()]), knots


#: What a table does between its times.
TABLE_KINDS = ("cubic", "linear", "held")


class Measured(Protocol):
    """What a table takes of measurements."""

    coordinate: Any
    channels: tuple[str, ...]

    @property
    def continuous(self) -> np.ndarray: ...


def _natural_spline(x: np.ndarray, y: np.ndarray) -> Any:
    from scipy.interpolate import CubicSpline  # mechanisms without tables start without it

    return CubicSpline(x, y, bc_type="natural")


@lru_cache(maxsize=32)
def _pieces(times: bytes, values: bytes, char: str, kind: str, integrals: int) -> np.ndarray:
    """Coefficients of a table's polynomials, from each knot on, rising powers first, shape (points - 1, order)."""
    x, y = np.frombuffer(times), np.frombuffer(values, dtype=char)
    if kind == "cubic":
        pieces = _natural_spline(x, y).c[::-1].T
    elif kind == "linear":
        pieces = np.stack([y[:-1], np.diff(y) / np.diff(x)], axis=1)
    else:
        pieces = y[:-1, None]
    for _ in range(integrals):
        raised = pieces / np.arange(1, pieces.shape[1] + 1)
        lasted = np.diff(x)[:, None] ** np.arange(1, raised.shape[1] + 1)
        begins = np.concatenate([[0.0], np.cumsum((raised * lasted).sum(axis=1))[:-1]])
        pieces = np.column_stack([begins, raised])
    pieces = np.ascontiguousarray(pieces)
    pieces.flags.writeable = False
    return pieces


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

    def lower(self) -> "tuple[int, Numbers, Numbers]":
        return kinds.CUSTOM, [], []


#: Numbers of a signal as kernels keep them.
Numbers = Sequence[Number] | np.ndarray
#: What a load or a motion takes: a number, or a function of time.
Course = Number | Signal


def as_signal(value: Course) -> Signal:
    """Numbers become constants."""
    return value if isinstance(value, Signal) else Constant(value)


def refuse_jumps(owner: str, motion: Any) -> None:
    """Refuse a prescribed motion whose velocity jumps."""
    if isinstance(motion, Step) or (isinstance(motion, Table) and not motion.is_smooth):
        raise InputError(
            f"{owner}: the velocity of its {type(motion).__name__} jumps, which no mechanism can follow; expected a "
            "smooth function of time, such as a cubic Table or a Polynomial"
        )
