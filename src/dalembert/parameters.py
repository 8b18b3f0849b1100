"""Named parameters with bounds, units and scales: the words that models and methods share."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError, repeated, shown, unknown
from dalembert.parameter import Parameter
from dalembert.priors import CorrelatedNormal, SquarePrior


@dataclass(frozen=True)
class Parameters:
    """An ordered collection of :class:`Parameter`, seen as vectors of shape (parameters,).

    Parameters with equal bounds are split off into ``fixed``. They are in no vector and in no array of bounds, so
    that methods vary, differentiate and count only the others.

    Parameters
    ----------
    items : tuple of Parameter
        After construction only those that are not fixed.
    fixed : tuple of Parameter

    Raises
    ------
    InputError
        For names that repeat, and for anything but a :class:`Parameter`.

    Examples
    --------
    >>> box = Parameters.of({"theta1": (0.6, 1.0), "theta2": Parameter("theta2", 0.4, 0.65, unit="rad")})
    >>> box.names
    ('theta1', 'theta2')
    >>> box.vector({"theta2": 0.5, "theta1": 0.7})
    array([0.7, 0.5])
    >>> box = Parameters.of({"mass": (2.0, 2.0), "stiffness": (1.0, 5.0)})
    >>> box.names, box.arguments([3.0])
    (('stiffness',), {'stiffness': 3.0, 'mass': 2.0})
    """

    items: tuple[Parameter, ...]
    fixed: tuple[Parameter, ...] = ()

    def __post_init__(self) -> None:
        for item in (*self.items, *self.fixed):
            if not isinstance(item, Parameter):
                raise InputError(f"parameters: {shown(item)} was given; expected a Parameter, or a mapping to bounds")
        object.__setattr__(self, "fixed", (*self.fixed, *(item for item in self.items if item.is_fixed)))
        object.__setattr__(self, "items", tuple(item for item in self.items if not item.is_fixed))
        if several := repeated([item.name for item in self.declared]):
            raise InputError(f"parameter names must differ; repeated: {', '.join(several)}")
        for item in self.items:
            self._check_joint(item)

    def _check_joint(self, item: Parameter) -> None:
        """Refuse a prior of several parameters that not all of them have."""
        if not isinstance(item.prior, CorrelatedNormal):
            return
        sharing = {member.name for member in self.items if member.prior == item.prior}
        for name in item.prior.names:
            if name not in sharing:
                raise InputError(
                    f"parameter {item.name!r}: its prior is that of {', '.join(item.prior.names)}, but {name!r} has "
                    "another one or none. Give all of them the same prior"
                )

    @classmethod
    def of(
        cls, parameters: "Parameters | Mapping[str, Parameter | tuple[float, float]] | Sequence[Parameter]"
    ) -> "Parameters":
        """Parameters from a mapping of names to bounds (or to :class:`Parameter`), or from a list.

        Raises
        ------
        InputError
            For anything else, and where the name of a :class:`Parameter` differs from its key.
        """
        if isinstance(parameters, Parameters):
            return parameters
        if isinstance(parameters, Mapping):
            return cls(tuple(_named(name, entry) for name, entry in parameters.items()))
        if isinstance(parameters, str | Parameter) or not isinstance(parameters, Iterable):
            raise InputError(
                f"parameters are {shown(parameters)}; expected a mapping from names to bounds, such as "
                "{'stiffness': (1e3, 1e5)}, or a list of Parameter"
            )
        return cls(tuple(parameters))

    def __iter__(self) -> Iterator[Parameter]:
        return iter(self.items)

    def __len__(self) -> int:
        return len(self.items)

    @cached_property
    def names(self) -> tuple[str, ...]:
        return tuple(item.name for item in self.items)

    def units(self, names: Iterable[str]) -> tuple[str, ...]:
        """Units of parameters by their names.

        >>> Parameters((Parameter("theta", 0.7, 0.9, unit="rad"), Parameter("k", 1.0, 2.0))).units(["k", "theta"])
        ('', 'rad')
        """
        known = {item.name: item.unit for item in self.declared}
        return tuple(known.get(name, "") for name in names)

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
        scales = [item.scale for item in self.items]
        return np.array(
            [size if scale is None else scale for scale, size in zip(scales, largest, strict=True)], dtype=float
        )

    @cached_property
    def square_priors(self) -> np.ndarray:
        """Numbers of the parameters whose prior is a square; a uniform one adds nothing to a fit."""
        return np.array(
            [k for k, item in enumerate(self.items) if isinstance(item.distribution, SquarePrior)], dtype=int
        )

    @cached_property
    def start(self) -> np.ndarray:
        """First guesses, shape (parameters,)."""
        middle = (self.lower + self.upper) / 2
        starts = [item.start for item in self.items]
        return np.array(
            [mid if start is None else start for start, mid in zip(starts, middle, strict=True)], dtype=float
        )

    def shares(self, values: np.ndarray) -> np.ndarray:
        """Return where values (parameters,) lie between their bounds, from 0 to 1; logarithmic as the search is.

        >>> Parameters.of({"mass": (1.0, 5.0), "stiffness": (1e3, 1e5)}).shares(np.array([2.0, 1e4]))
        array([0.25, 0.5 ])
        """
        logarithmic = np.array([item.logarithmic for item in self.items], dtype=bool)
        low, at, high = (
            np.where(logarithmic, np.log(np.where(logarithmic, each, 1.0)), each)
            for each in (self.lower, values, self.upper)
        )
        return (at - low) / (high - low)

    def vector(self, values: Mapping[str, float] | ArrayLike) -> np.ndarray:
        """Vector of shape (parameters,) from a mapping by name, or from a sequence in order.

        A mapping may name fixed parameters too, with their values.
        """
        if isinstance(values, Mapping):
            for name in values:
                self.check_name(name, values[name])
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

    def start_vector(self, values: Mapping[str, float] | ArrayLike) -> np.ndarray:
        """Vector of real numbers within the bounds, as :meth:`vector`, where a search starts.

        Raises
        ------
        InputError
            For a complex number, and one outside its bounds.
        """
        vector = self.real_vector(values)
        for item, value in zip(self, vector, strict=True):
            if not item.lower <= value <= item.upper:
                raise InputError(
                    f"start: {item.name!r} is {value}, outside its bounds ({item.lower}, {item.upper}); "
                    "widen the bounds or move the start"
                )
        return vector

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
        """Mapping from names to the entries of a vector of shape (parameters,), fixed parameters included."""
        return self.arguments(self.vector(vector).tolist())

    def arguments(self, values: Iterable[Any]) -> dict[str, Any]:
        """Arguments of a model's function: one value each in order, and those of fixed parameters."""
        return dict(zip(self.names, values, strict=True)) | {item.name: item.lower for item in self.fixed}

    @property
    def declared(self) -> tuple[Parameter, ...]:
        """All parameters, fixed ones last."""
        return (*self.items, *self.fixed)

    @property
    def identity(self) -> tuple[Any, ...]:
        """What a fingerprint needs of them: names, and the values of fixed ones."""
        return (*self.names, *((item.name, float(item.lower)) for item in self.fixed))

    def check_name(self, name: object, value: object = None, where: str = "") -> None:
        """Raise unless a parameter of this name varies, or is fixed at this value.

        Raises
        ------
        InputError
        """
        for item in self.fixed:
            if item.name == name and value != item.lower:
                raise InputError(
                    f"{f'{where}: ' if where else ''}parameter {name!r} is fixed at {item.lower:g} by equal bounds; "
                    "leave it out, or give bounds that differ"
                )
        if name not in self.names and all(item.name != name for item in self.fixed):
            raise InputError(unknown("parameter", str(name), self.names, where))

    def check_some(self, owner: str) -> None:
        """Raise where no parameter varies.

        Raises
        ------
        InputError
        """
        if not self.items:
            why = (
                "every parameter of the model is fixed by equal bounds" if self.fixed else "the model has no parameter"
            )
            raise InputError(f"{owner}: {why}; expected at least one parameter whose bounds differ")

    def clip(self, vectors: np.ndarray) -> np.ndarray:
        """Vectors of shape (..., parameters) moved onto the bounds where they lie outside."""
        return np.clip(vectors, self.lower, self.upper)


def _named(name: str, entry: "Parameter | tuple[float, float]") -> Parameter:
    if isinstance(entry, Parameter):
        if entry.name == name:
            return entry
        raise InputError(
            f"parameters: the key {name!r} has the Parameter {entry.name!r}; expected the same name twice, or a list "
            "of Parameter"
        )
    try:
        lower, upper = map(float, entry)
    except (TypeError, ValueError) as error:
        raise InputError(f"parameter {name!r}: bounds are {entry!r}; expected two numbers, (lower, upper)") from error
    return Parameter(name, lower, upper)
