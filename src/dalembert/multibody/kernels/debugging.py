"""Kinds of components in plain Python: their functions can be stepped through by a debugger."""

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cached_property
from typing import Any

from dalembert.kernels.kernel import BlockKernel, Compiled
from dalembert.multibody.kernels.declaration import Declaration

PLAIN: ContextVar[dict[Declaration, list[BaseException]]] = ContextVar("plain kinds", default={})  # noqa: B039 - never written
"""Errors of the functions of each kind that runs in plain Python here."""


@contextmanager
def in_python(*components: Any) -> Iterator[None]:
    """Run the functions of components in plain Python in this block, some thousand times slower.

    The integrator stays compiled, and calls them back: breakpoints and ``print`` work in a component's functions.

    Parameters
    ----------
    components : classes of components, or kinds

    Raises
    ------
    Exception
        The first one that a function raised, at the end of the block.

    Examples
    --------
    >>> from dalembert.multibody import RevoluteJoint, RigidBar, System, simulate
    >>> system = System()
    >>> rod = system.add(RigidBar("rod", length=1.0, mass=1.0))
    >>> pin = system.add(RevoluteJoint("pin", system.ground, rod.start))
    >>> with in_python(RevoluteJoint):
    ...     trajectory = simulate(system, end=0.01)
    """
    errors: list[BaseException] = []
    kinds = [getattr(component, "kind", component) for component in components]
    token = PLAIN.set({**PLAIN.get(), **dict.fromkeys(kinds, errors)})
    try:
        yield
    finally:
        PLAIN.reset(token)
        for error in errors[:1]:
            raise error


class PlainKernel(Compiled):
    """The Python function of a kernel behind an address."""

    in_python = True

    def __init__(self, kernel: BlockKernel, errors: list[BaseException]) -> None:
        self.function, self.symbol, self._errors = kernel.function, f"{kernel.symbol}_plain", errors

    @cached_property
    def address(self) -> int:
        return ctypes.cast(self._entry, ctypes.c_void_p).value or 0

    @cached_property
    def _entry(self) -> Any:
        return ctypes.CFUNCTYPE(None, ctypes.c_int64, ctypes.c_int64)(self.__call__)

    def __call__(self, call: int, block: int) -> None:
        try:
            self.function(call, block)
        except BaseException as error:  # it must not cross the compiled code
            self._errors.append(error)
