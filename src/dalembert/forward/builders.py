"""What models made by a builder, a function from parameters to a system, have in common."""

import os

from dalembert.errors import InputError


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def inexact(parameter: str, error: Exception) -> InputError:
    """The error of a builder that cannot run in complex numbers."""
    return InputError(
        f"the model's function cannot run in complex numbers, as exact derivatives by {parameter!r} need ({error}); "
        "use NumPy's functions instead of those of math, dalembert's absolute, norm, hypot and atan2, and no float() "
        "or comparison on parameters; or give derivative='central-differences'"
    )


def restructured() -> InputError:
    """The error of a builder whose systems differ in more than numbers."""
    return InputError(
        "the model's function returned systems of different structure for different parameters; "
        "parameters may change numbers, not the number or the kinds of components"
    )
