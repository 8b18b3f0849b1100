"""Laws of elements as compiled functions: force and next internal state from displacement, velocity and state."""

import inspect
from collections.abc import Callable
from functools import cached_property
from types import FunctionType
from typing import Any, cast

from dalembert.errors import InputError, shown
from dalembert.kernels.digest import digest
from dalembert.kernels.kernel import Kernel, Origin, kernel, origin_of
from dalembert.kernels.words import Complexes

ARGUMENTS = ("u", "v", "z", "numbers", "force")
"""What a law takes, by position."""


@kernel
def any_law(u: Complexes, v: Complexes, z: Complexes, numbers: Complexes, force: Complexes) -> None:
    """What laws have in common: their arguments."""


call_law = any_law.at
"""In kernels: ``call_law(address, u, v, z, numbers, force)`` calls the law at an address."""


class Law:
    """A law of an element, compiled when it is first needed; :func:`law` makes it.
    ``function(u, v, z, numbers, force)`` has displacements and velocities of the columns that the element sees
    (columns,), m and m/s, the internal state (states,) and the element's numbers. It writes the internal forces
    (columns,), N, and moves the state.
    """

    def __init__(self, function: Callable) -> None:
        if not isinstance(function, FunctionType):
            raise InputError(
                f"the function of a law is {shown(function)}; expected a Python function({', '.join(ARGUMENTS)}) that "
                "writes the forces"
            )
        if len(inspect.signature(function).parameters) != len(ARGUMENTS):
            raise InputError(
                f"law {function.__name__!r}: the function takes {len(inspect.signature(function).parameters)} "
                f"arguments; expected {', '.join(ARGUMENTS)}"
            )
        self.function = function

    @property
    def name(self) -> str:
        """Name of the function."""
        return self.function.__name__

    @property
    def packaged(self) -> bool:
        """Whether the law belongs to the package."""
        return self._module.startswith("dalembert.")

    @property
    def _module(self) -> str:
        """The function's module; that of a script for code that has none."""
        return self.function.__module__ or "__main__"

    @cached_property
    def _kernel(self) -> "_LawKernel":
        return _LawKernel(self)

    def kernel(self, role: str, dtype: type) -> Kernel:
        """The compiled function, by its origin: a law has only one."""
        return self._kernel

    def all_kernels(self) -> list[Kernel]:
        """The compiled function."""
        return [self._kernel]

    @property
    def address(self) -> int:
        """Address of the compiled function."""
        return self._kernel.address

    @property
    def digest(self) -> str:
        """Digest of the source."""
        return self._kernel.digest

    def __call__(self, *arrays: Any) -> None:
        """Call the Python function, for a debugger."""
        self.function(*arrays)


class _LawKernel(Kernel):
    """The kernel of a law; its arguments have the types of :func:`any_law`, whatever their names are."""

    def __init__(self, law: Law) -> None:
        source = cast(FunctionType, law.function)
        name = (
            source.__name__ if law.packaged else f"{source.__name__}_{digest(source)}"
        )  # others may share their names
        renamed = FunctionType(source.__code__, source.__globals__, name, source.__defaults__, source.__closure__)
        renamed.__module__, renamed.__doc__ = law._module, source.__doc__
        renamed.__annotations__ = {**dict.fromkeys(inspect.signature(source).parameters, Complexes), "return": None}
        self._law = law
        super().__init__(renamed)

    @cached_property
    def origin(self) -> Origin | None:
        """Module and name of the law, by which another process imports it."""
        return origin_of(self._law._module, self._law, "law", "complex")


def law(function: Callable) -> Law:
    """Declare a function as the law of an element.

    Comparisons must be of real parts (``u[0].real``): the imaginary part is a direction of differentiation. Where the
    state changes with the displacement, keep the displacement before in the state.

    Parameters
    ----------
    function : callable
        ``function(u, v, z, numbers, force)`` as in :class:`Law`. It uses what Numba compiles.

    Raises
    ------
    InputError
        For anything else than a Python function of five arguments.

    Examples
    --------
    >>> @law
    ... def quadratic_damping(u, v, z, numbers, force):
    ...     force[0] = numbers[0] * v[0] * (v[0] if v[0].real > 0 else -v[0])
    >>> quadratic_damping.name
    'quadratic_damping'
    """
    return Law(function)
