"""A law of the user's as a compiled Python function, with velocity and internal state."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from dalembert.arguments import limited
from dalembert.errors import InputError, shown
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.law import ARGUMENTS, Law


@dataclass(frozen=True)
class UserLaw(LawElement):
    """A law of the user's between two degrees of freedom, or one and the ground.

    Parameters
    ----------
    name : str
    first : str
        Degree of freedom, such as ``"A.x"``.
    second : str, optional
        The ground if not given; u is the first displacement less the second.
    function : callable
        ``function(u, v, z, numbers, force)``: it writes ``force[0]``, N, from the displacement ``u[0]``, m, the
        velocity ``v[0]``, m/s, the internal state ``z`` and ``numbers``, and moves ``z``. Numba compiles it. Compare
        real parts (``u[0].real``): imaginary parts are directions of differentiation. It is called once a sample, in
        the order of time; a law that depends on the change of u keeps u in its state.
    values : sequence of float
        Numbers of the law; they may depend on parameters.
    internal : int
        Internal numbers, which are 0 at rest.
    events : callable, optional
        ``events(u, v, z, numbers, crossings)`` writes functions whose zeros divide the motion into smooth parts, such
        as ``crossings[0] = v[0]`` where the law changes with the direction of motion. ``z`` is the state
        that ``function`` wrote at the point before, a sample or a zero; ``events`` must not change it. Harmonic balance
        finds the zeros between samples, and so needs fewer samples.
    event_count : int
        Number of these functions.

    Raises
    ------
    InputError
        For a function that does not take five arguments, and, when it is first used, for one that drops the imaginary
        part of its arguments.

    Examples
    --------
    >>> def quadratic(u, v, z, numbers, force):
    ...     force[0] = numbers[0] * v[0] * (v[0] if v[0].real > 0 else -v[0])
    >>> UserLaw("damper", "A.x", function=quadratic, values=[0.3]).numbers
    {'values[0]': 0.3}
    """

    function: Callable[..., None] = None  # type: ignore[assignment] - required, and checked
    values: Sequence[Number] = ()
    internal: int = limited(0, least=0)
    events: Callable[..., None] | None = None  # type: ignore[assignment] - compiled when the element is made
    event_count: int = limited(0, least=0)

    rated = True

    def __post_init__(self) -> None:
        where = f"UserLaw {self.name!r}"
        if (self.events is None) != (self.event_count == 0):
            raise InputError(
                f"{where}: event_count is {self.event_count}; expected the number of functions that events writes"
            )
        values = np.asarray(self.values)
        if values.ndim != 1 or not np.all(np.isfinite(values)):
            raise InputError(f"{where}: values is {shown(self.values)}; expected finite numbers")
        object.__setattr__(self, "values", tuple(self.values))
        if self.function is None:
            takes = ", ".join(ARGUMENTS)
            raise InputError(f"{where}: function is missing; give a Python function({takes})")
        _law_of(self.function)
        if self.events is not None:
            object.__setattr__(self, "events", _law_of(self.events))

    @property
    def law(self) -> Law:  # type: ignore[override] - of the element, not of its class
        """The compiled function."""
        return _law_of(self.function)

    @property
    def states(self) -> int:
        """Internal numbers."""
        return self.internal

    @property
    def numbers(self) -> dict[str, Number]:
        """Numbers of the law by their places."""
        return {f"values[{place}]": value for place, value in enumerate(self.values)}


@cache
def _law_of(function: Callable[..., None]) -> Law:
    return function if isinstance(function, Law) else Law(function)
