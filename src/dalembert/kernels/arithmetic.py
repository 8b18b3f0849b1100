"""Arithmetics of kernels: views of real, complex and dual numbers and of lanes, and kernels for more than one."""

from collections.abc import Callable
from types import FunctionType
from typing import Annotated, Any, cast, get_args, get_origin, get_type_hints

import numpy as np

from dalembert.kernels.duals import Dual, duals, duals2
from dalembert.kernels.kernel import Kernel
from dalembert.kernels.lanes import Lanes, lanes, lanes2
from dalembert.kernels.views import complexes, complexes2, reals, reals2
from dalembert.kernels.words import ArrayOf

VIEWS: dict[type, tuple[Any, Any]] = {
    float: (reals, reals2),
    complex: (complexes, complexes2),
    Dual: (duals, duals2),
    Lanes: (lanes, lanes2),
}
"""Intrinsics: the vector and the matrix of numbers at an address."""
_OPEN = ""
#: Arrays of the numbers that a kernel is made for.
Numbers = Annotated[np.ndarray, ArrayOf(_OPEN, 1)]
Numbers2 = Annotated[np.ndarray, ArrayOf(_OPEN, 2)]
Numbers3 = Annotated[np.ndarray, ArrayOf(_OPEN, 3)]


def kernels(function: Callable) -> tuple[Kernel, Kernel]:
    """The kernels of a function whose annotations leave open the numbers of arrays: for real and for complex ones."""
    return _kernel_of(function, "real", "f8"), _kernel_of(function, "complex", "c16")


def _kernel_of(function: Callable, numbers: str, dtype: str) -> Kernel:
    given = cast(FunctionType, function)
    # A copy with the same code, since the annotations of one function cannot have two meanings.
    own = FunctionType(
        given.__code__, given.__globals__, f"{given.__name__}_{numbers}", given.__defaults__, given.__closure__
    )
    own.__module__, own.__doc__ = given.__module__, given.__doc__
    hints = get_type_hints(function, include_extras=True)
    own.__annotations__ = {name: _closed(annotation, dtype) for name, annotation in hints.items()}
    return Kernel(own)


def _closed(annotation: Any, dtype: str) -> Any:
    """An annotation with the dtype of arrays that it leaves open."""
    if get_origin(annotation) is Annotated:
        leaf = get_args(annotation)[1]
        if leaf.dtype == _OPEN:
            return Annotated[np.ndarray, ArrayOf(dtype, leaf.axes)]
    return annotation
