"""The unknowns of an identification from bands: middles of all parameters, radii of some."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dalembert.argument_readers import names_of
from dalembert.errors import InputError
from dalembert.inverse.problem.search_coordinates import SearchCoordinates
from dalembert.parameters import Parameters


@dataclass(frozen=True, eq=False)
class Unknowns:
    """Vectors x = (middles of all d parameters, radii of the k intervals), in search coordinates. A box with middle m
    and radius r is cut at the bounds: its ends are max(m − r, lower) and min(m + r, upper). So every middle between the
    bounds goes with every radius up to half of their distance.
    """

    parameters: Parameters
    intervals: tuple[str, ...]  # names of the parameters whose radius is unknown; that of the others is zero
    # Corners, each (d,), of a part of the search box in which the boxes stay.
    region: tuple[np.ndarray, np.ndarray] | None = None

    @cached_property
    def search(self) -> SearchCoordinates:
        return SearchCoordinates(self.parameters)

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners of the region that the boxes stay in, each (d,)."""
        return self.region or (self.search.lower, self.search.upper)

    def around(self, lower: np.ndarray, upper: np.ndarray, radius: float, width: float) -> "Unknowns":
        """The same unknowns, in a box (d,), (d,) grown by parts of its radius and of the search box's width."""
        low, high = self.search.lower, self.search.upper
        margin = radius * (upper - lower) / 2 + width * (high - low)
        return replace(self, region=(np.maximum(lower - margin, low), np.minimum(upper + margin, high)))

    @cached_property
    def chosen(self) -> np.ndarray:
        """Numbers of the parameters that are intervals, shape (k,)."""
        return np.array([k for k, name in enumerate(self.parameters.names) if name in self.intervals], dtype=int)

    @property
    def names(self) -> tuple[str, ...]:
        names = self.parameters.names
        return (*(f"{name} middle" for name in names), *(f"{names[k]} radius" for k in self.chosen))

    @cached_property
    def lower(self) -> np.ndarray:
        """Smallest x, shape (d + k,)."""
        return np.concatenate([self.bounds[0], np.zeros(len(self.chosen))])

    @cached_property
    def upper(self) -> np.ndarray:
        """Largest x, shape (d + k,)."""
        low, high = self.bounds
        return np.concatenate([high, (high - low)[self.chosen] / 2])

    def leaves(self, lower: np.ndarray, upper: np.ndarray) -> bool:
        """Whether a box (d,), (d,) touches a side of the region that is not one of the search box, or there is none."""
        if self.region is None:
            return True
        (low, high), search = self.region, self.search
        return bool(np.any((lower <= low) & (low > search.lower)) or np.any((upper >= high) & (high < search.upper)))

    def ends(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper ends of the boxes, each (..., d), of unknowns (..., d + k)."""
        middle, radius = self._split(x)
        low, high = self.bounds
        return np.maximum(middle - radius, low), np.minimum(middle + radius, high)

    def slopes(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of the two ends, each (d, d + k), at unknowns (d + k,); zero where an end is cut."""
        middle, radius = self._split(x)
        moves = np.eye(len(middle))
        opens = moves[:, self.chosen]
        lower, upper = np.hstack([moves, -opens]), np.hstack([moves, opens])
        low, high = self.bounds
        lower[middle - radius < low] = 0
        upper[middle + radius > high] = 0
        return lower, upper

    def of(self, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        """Unknowns (..., d + k) of boxes, their ends (..., d)."""
        return np.concatenate([(lower + upper) / 2, (upper - lower)[..., self.chosen] / 2], axis=-1)

    def physical(self, x: np.ndarray) -> np.ndarray:
        """Middles and radii (d + k,) in the parameters' units, of the boxes of unknowns (d + k,)."""
        return self.of(*(self.search.vectors(end) for end in self.ends(x)))

    def _split(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        d = len(self.parameters)
        radius = np.zeros((*x.shape[:-1], d))
        radius[..., self.chosen] = x[..., d:]
        return x[..., :d], radius


def unknowns_of(parameters: Parameters, intervals: Iterable[str] | None) -> Unknowns:
    """Unknowns with the named intervals, all if none are named."""
    if intervals is None:
        return Unknowns(parameters, parameters.names)
    if isinstance(intervals, str):
        raise InputError(f"intervals is {intervals!r}; expected names in a list, for example [{intervals!r}]")
    names = names_of(intervals, "identify_bands", "intervals")
    for name in names:
        parameters.check_name(name, where="intervals")
    return Unknowns(parameters, tuple(name for name in parameters.names if name in names))
