"""Intervals and boxes: numbers of which only bounds are known. There is no interval arithmetic here."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import Checked, takes_checked
from dalembert.errors import InputError, repeated, require_known, shown


@dataclass(frozen=True)
class Interval(Checked):
    """All numbers from ``lower`` to ``upper``, both included.

    Parameters
    ----------
    lower, upper : float
        Finite, ``lower <= upper``; equal for a number that is known exactly.

    Raises
    ------
    InputError
        For a bound that is not finite, or a lower one above its upper one.

    Examples
    --------
    >>> stiffness = Interval.about(2e7, relative=0.05)
    >>> print(stiffness)
    [1.9e+07, 2.1e+07]
    >>> 2.05e7 in stiffness, Interval(1, 2) in Interval(0, 2)
    (True, True)
    """

    lower: float
    upper: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.lower) and np.isfinite(self.upper) and self.lower <= self.upper):
            raise InputError(f"an interval of ({self.lower}, {self.upper}) was given; expected {_EXPECTED}")

    @classmethod
    @takes_checked()
    def about(cls, middle: float, radius: float | None = None, relative: float | None = None) -> "Interval":
        """Interval from its middle and its radius, or its radius relative to the magnitude of the middle.

        >>> Interval.about(0.75, radius=0.25)
        Interval(lower=0.5, upper=1.0)
        """
        if (radius is None) == (relative is None):
            raise InputError(f"an interval about {middle}: expected either its radius or its relative radius, not both")
        size = abs(middle) * relative if relative is not None else radius
        if size is None or not size >= 0:
            raise InputError(f"an interval about {middle}: its radius is {size}; expected zero or more")
        return cls(middle - size, middle + size)

    @property
    def middle(self) -> float:
        """(lower + upper) / 2."""
        return (self.lower + self.upper) / 2

    @property
    def radius(self) -> float:
        """(upper − lower) / 2."""
        return self.width / 2

    @property
    def width(self) -> float:
        """Upper − lower."""
        return self.upper - self.lower

    def __contains__(self, other: "float | Interval") -> bool:
        inner = other if isinstance(other, Interval) else Interval(other, other)
        return self.lower <= inner.lower and inner.upper <= self.upper

    def __str__(self) -> str:
        return f"[{self.lower:.6g}, {self.upper:.6g}]"


_EXPECTED = "two finite numbers, the lower one first"


@dataclass(frozen=True, eq=False)
class Box:
    """An interval for each of several names: midpoints x_c and radii x_w, the points x = x_c + x_w η, η in [−1, 1]^d.

    Parameters
    ----------
    names : tuple of str, length d
    lower, upper : array, shape (d,)
        Finite, ``lower <= upper``.

    Raises
    ------
    InputError
        For a bound that is not finite, or a lower one above its upper one, with its name; for names that repeat.

    Examples
    --------
    >>> box = Box.of({"theta1": Interval.about(0.8, radius=0.1), "theta2": (0.5, 0.6), "mass": 2.0})
    >>> print(box)
    theta1 [0.7, 0.9], theta2 [0.5, 0.6], mass [2, 2]
    >>> box["theta2"]
    Interval(lower=0.5, upper=0.6)
    >>> box.points([0.0, -1.0, 1.0])
    array([0.8, 0.5, 2. ])
    """

    names: tuple[str, ...]
    lower: np.ndarray
    upper: np.ndarray

    def __post_init__(self) -> None:
        shape = (len(self.names),)
        if self.lower.shape != shape or self.upper.shape != shape:
            raise InputError(
                f"a box of {len(self.names)} names has bounds of shapes {self.lower.shape} and {self.upper.shape}; "
                f"expected {shape} twice"
            )
        if several := repeated(self.names):
            raise InputError(f"a box has one interval for each name; given more than once: {', '.join(several)}")
        for name, lower, upper in zip(self.names, self.lower, self.upper, strict=True):
            if not (np.isfinite(lower) and np.isfinite(upper) and lower <= upper):
                raise InputError(f"interval of {name!r}: ({lower}, {upper}) was given; expected {_EXPECTED}")

    @classmethod
    def of(cls, intervals: "Box | Mapping[str, Interval | tuple[float, float] | float]") -> "Box":
        """Box from a mapping of names to intervals, to pairs (lower, upper), or to numbers that are known exactly."""
        if isinstance(intervals, Box):
            return intervals
        if not isinstance(intervals, Mapping):
            raise InputError(
                f"intervals are {shown(intervals)}; expected a mapping from names to bounds, such as "
                "{'stiffness': (1e3, 1e5)}"
            )
        pairs = [_pair(name, entry) for name, entry in intervals.items()]
        bounds = np.array(pairs, dtype=float).reshape(-1, 2)
        return cls(tuple(intervals), bounds[:, 0], bounds[:, 1])

    @property
    def middle(self) -> np.ndarray:
        """(lower + upper) / 2, shape (d,)."""
        return (self.lower + self.upper) / 2

    @property
    def radius(self) -> np.ndarray:
        """(upper − lower) / 2, shape (d,)."""
        return (self.upper - self.lower) / 2

    def __len__(self) -> int:
        return len(self.names)

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __getitem__(self, name: str) -> Interval:
        require_known("interval", name, self.names)
        place = self.names.index(name)
        return Interval(float(self.lower[place]), float(self.upper[place]))

    def items(self) -> Iterator[tuple[str, Interval]]:
        """Pairs of name and interval, in order."""
        return ((name, self[name]) for name in self.names)

    def points(self, eta: ArrayLike) -> np.ndarray:
        """Points x_c + x_w η, shape (..., d), of coordinates η in [−1, 1], shape (..., d); its ends are exact."""
        return placed(self.lower, self.upper, np.asarray(eta, dtype=float))

    def corners(self) -> np.ndarray:
        """Corners, shape (2^f, d), f the number of intervals with a width: a number known exactly has one side."""
        sides = [(low,) if low == high else (low, high) for low, high in zip(self.lower, self.upper, strict=True)]
        return np.array(list(product(*sides)), dtype=float).reshape(-1, len(self))

    def contains(self, points: ArrayLike) -> np.ndarray:
        """Mask, shape (...), of the points (..., d) that lie inside or on the boundary."""
        return np.all((self.lower <= points) & (np.asarray(points) <= self.upper), axis=-1)

    def __str__(self) -> str:
        return ", ".join(f"{name} {interval}" for name, interval in self.items())


def placed(lower: np.ndarray, upper: np.ndarray, eta: np.ndarray) -> np.ndarray:
    """Points of coordinates η in [−1, 1] between bounds, exact at both; the three shapes are broadcast."""
    radius = (upper - lower) / 2
    return np.where(eta < 0, lower + (1 + eta) * radius, upper - (1 - eta) * radius)


def corners(lower: ArrayLike, upper: ArrayLike, *, flat: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Return both corners of a box as arrays of shape (d,); a ``flat`` box may have directions without width."""
    low, high = np.array(lower, dtype=float, ndmin=1), np.array(upper, dtype=float, ndmin=1)
    before, sign = (np.less_equal, "<=") if flat else (np.less, "<")
    if low.ndim != 1 or low.shape != high.shape or not np.all(np.isfinite(low) & np.isfinite(high) & before(low, high)):
        raise InputError(
            f"bounds are {low.tolist()} and {high.tolist()}; expected two finite vectors of equal length, lower {sign} "
            "upper"
        )
    return low, high


def _pair(name: str, entry: Interval | tuple[float, float] | float) -> tuple[float, float]:
    if isinstance(entry, Interval):
        return entry.lower, entry.upper
    try:
        lower, upper = map(float, (entry, entry) if np.ndim(entry) == 0 else entry)  # type: ignore[arg-type]
    except (TypeError, ValueError) as error:
        raise InputError(
            f"interval of {name!r}: {entry!r} was given; "
            "expected two numbers (lower, upper), an Interval, or one number"
        ) from error
    return lower, upper
