"""Named parameters with bounds, units and scales: the words that models and methods share."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError, shown, unknown


@dataclass(frozen=True)
class Parameter:
    """One uncertain number of a model.

    Parameters
    ----------
    name : str
    lower, upper : float
        Bounds, in SI units, ``lower < upper``.
    unit : str
        Unit symbol for labels, for example ``"Pa"``.
    scale : float, optional
        Typical size; the larger absolute bound if not given.
    start : float, optional
        First guess; the middle of the bounds if not given.
    log : bool, optional
        Whether the identification searches its logarithm, so that factors count and not differences. If not given:
        where both bounds are positive and more than a decade apart.
    deviation : float, optional
        What is known before any data: the standard deviation of the true value around ``start``. It enters an
        identification as one more measurement; the data then need deviations too.
    """

    name: str
    lower: float
    upper: float
    unit: str = ""
    scale: float | None = None
    start: float | None = None
    log: bool | None = None
    deviation: float | None = None

    def __post_init__(self) -> None:
        for what in ("lower", "upper"):
            bound = getattr(self, what)
            if np.ndim(bound) or np.asarray(bound).dtype.kind not in "iuf":
                raise InputError(f"parameter {self.name!r}: {what} is {shown(bound)}; expected a number")
        if self.lower == self.upper:
            raise InputError(
                f"parameter {self.name!r}: both bounds are {self.lower}, so that nothing is to be found; leave the "
                "parameter out and write its value into the model's function"
            )
        if not (np.isfinite(self.lower) and np.isfinite(self.upper) and self.lower < self.upper):
            raise InputError(
                f"parameter {self.name!r}: bounds are ({self.lower}, {self.upper}); "
                "expected two finite numbers, the lower one first"
            )
        if self.scale is not None and not self.scale > 0:
            raise InputError(f"parameter {self.name!r}: scale is {self.scale}; expected a positive number")
        if self.start is not None and not self.lower <= self.start <= self.upper:
            raise InputError(
                f"parameter {self.name!r}: start {self.start} lies outside its bounds "
                f"({self.lower}, {self.upper}); widen the bounds or move the start"
            )
        if self.deviation is not None and not (np.isfinite(self.deviation) and self.deviation > 0):
            raise InputError(
                f"parameter {self.name!r}: deviation is {self.deviation}; expected a positive number, the standard "
                "deviation of what is known of it before any data"
            )
        if self.log and not self.lower > 0:
            raise InputError(
                f"parameter {self.name!r}: its logarithm is to be searched, but its lower bound is {self.lower}; "
                "expected a positive one; raise the bound or leave log out"
            )

    @property
    def logarithmic(self) -> bool:
        """Whether its logarithm is searched: as ``log`` says, or for positive bounds more than a decade apart."""
        return self.log if self.log is not None else 0 < 10 * self.lower < self.upper


@dataclass(frozen=True)
class Parameters:
    """An ordered collection of :class:`Parameter`, seen as vectors of shape (parameters,).

    Examples
    --------
    >>> box = Parameters.of({"theta1": (0.6, 1.0), "theta2": Parameter("theta2", 0.4, 0.65, unit="rad")})
    >>> box.names
    ('theta1', 'theta2')
    >>> box.vector({"theta2": 0.5, "theta1": 0.7})
    array([0.7, 0.5])
    """

    items: tuple[Parameter, ...]

    def __post_init__(self) -> None:
        repeated = {name for name in self.names if self.names.count(name) > 1}
        if repeated:
            raise InputError(f"parameter names must differ; repeated: {', '.join(sorted(repeated))}")

    @classmethod
    def of(
        cls,
        given: "Parameters | Mapping[str, Parameter | tuple[float, float]] | list[Parameter] | tuple[Parameter, ...]",
    ) -> "Parameters":
        """Parameters from a mapping of names to bounds (or to :class:`Parameter`), or from a list."""
        if isinstance(given, Parameters):
            return given
        if isinstance(given, Mapping):
            return cls(
                tuple(entry if isinstance(entry, Parameter) else _within(name, entry) for name, entry in given.items())
            )
        return cls(tuple(given))

    def __iter__(self) -> Iterator[Parameter]:
        return iter(self.items)

    def __len__(self) -> int:
        return len(self.items)

    @cached_property
    def names(self) -> tuple[str, ...]:
        return tuple(item.name for item in self.items)

    @cached_property
    def lower(self) -> np.ndarray:
        return np.array([item.lower for item in self.items], dtype=float)

    @cached_property
    def upper(self) -> np.ndarray:
        return np.array([item.upper for item in self.items], dtype=float)

    @cached_property
    def scale(self) -> np.ndarray:
        """Typical sizes, shape (parameters,)."""
        largest = np.maximum(np.abs(self.lower), np.abs(self.upper))
        given = [item.scale for item in self.items]
        return np.array([size if own is None else own for own, size in zip(given, largest, strict=True)], dtype=float)

    @cached_property
    def start(self) -> np.ndarray:
        """First guesses, shape (parameters,)."""
        middle = (self.lower + self.upper) / 2
        given = [item.start for item in self.items]
        return np.array([mid if own is None else own for own, mid in zip(given, middle, strict=True)], dtype=float)

    def vector(self, values: Mapping[str, float] | ArrayLike) -> np.ndarray:
        """Vector of shape (parameters,) from a mapping by name, or from a sequence in order."""
        if isinstance(values, Mapping):
            for name in values:
                if name not in self.names:
                    raise InputError(unknown("parameter", name, self.names))
            missing = [name for name in self.names if name not in values]
            if missing:
                raise InputError(
                    f"no value given for parameter {missing[0]!r}; expected all of {', '.join(self.names)}"
                )
            vector = np.array([values[name] for name in self.names])
        else:
            vector = np.asarray(values)
        if vector.shape != (len(self),):
            raise InputError(
                f"a parameter vector of shape {vector.shape} was given; "
                f"expected ({len(self)},) for {', '.join(self.names)}"
            )
        if vector.dtype.kind not in "iufc":
            for name, value in zip(self.names, vector.tolist(), strict=True):
                if isinstance(value, bool) or not isinstance(value, int | float | complex):
                    raise InputError(f"parameter {name!r} is {shown(value)}; expected a number")
        return vector

    def real_vector(self, values: Mapping[str, float] | ArrayLike) -> np.ndarray:
        """Vector of real numbers, as :meth:`vector`.

        Raises
        ------
        InputError
            For a complex number.
        """
        vector = self.vector(values)
        if np.iscomplexobj(vector):
            raise InputError(f"parameters are {shown(vector.tolist())}; expected real numbers")
        return vector.astype(float)

    def batch(self, vectors: ArrayLike) -> np.ndarray:
        """Vectors of shape (batch, parameters) from as many, or from one of them.

        Raises
        ------
        InputError
            For another number of parameters, or what is no real number.
        """
        try:
            batch = np.atleast_2d(np.array(vectors, dtype=object)).astype(float)
        except (TypeError, ValueError):
            raise InputError(f"parameter vectors are {shown(vectors)}; expected real numbers, {self._rows}") from None
        if batch.ndim != 2 or batch.shape[1] != len(self):
            raise InputError(f"parameter vectors of shape {np.shape(vectors)} were given; expected {self._rows}")
        return batch

    @property
    def _rows(self) -> str:
        return f"an array (batch, {len(self)}) with one column each for {', '.join(self.names) or 'no parameter'}"

    def mapping(self, vector: ArrayLike) -> dict[str, float]:
        """Mapping from names to the entries of a vector of shape (parameters,)."""
        return dict(zip(self.names, self.vector(vector).tolist(), strict=True))

    def clip(self, vectors: np.ndarray) -> np.ndarray:
        """Vectors of shape (..., parameters) moved onto the bounds where they lie outside."""
        return np.clip(vectors, self.lower, self.upper)


def _within(name: str, bounds: tuple[float, float]) -> Parameter:
    try:
        lower, upper = map(float, bounds)
    except (TypeError, ValueError) as error:
        raise InputError(f"parameter {name!r}: bounds are {bounds!r}; expected two numbers, (lower, upper)") from error
    return Parameter(name, lower, upper)
