"""The methods by name."""

from dalembert.errors import InputError, require_known
from dalembert.kinds import named
from dalembert.uncertainty.chebyshev import Chebyshev
from dalembert.uncertainty.method import Method
from dalembert.uncertainty.optimise import Optimise
from dalembert.uncertainty.samplings import Sampling
from dalembert.uncertainty.taylor import Taylor


def methods_by_name() -> dict[str, type[Method]]:
    """Return all methods: a subclass of `Sampling` is one, also in a module of another package."""
    return named("dalembert.uncertainty", Sampling, Taylor, Optimise, Chebyshev)


def method_of(method: Method | str) -> Method:
    """Return a method itself, or the one of that name with its usual settings."""
    known = methods_by_name()
    if isinstance(method, str):
        require_known("method", method, known)
        return known[method]()
    if not isinstance(method, tuple(known.values())):
        raise InputError(
            f"method: {method!r} was given; expected one of {', '.join(known)}, or settings such as "
            "MonteCarlo(runs=500)"
        )
    return method


def label(method: Method) -> str:
    """Return a method's name, and its settings that are not the usual ones, such as ``scan (points_each=5)``."""
    usual = vars(type(method)())
    changed = [f"{name}={value!r}" for name, value in vars(method).items() if value != usual[name]]
    return f"{method.name} ({', '.join(changed)})" if changed else method.name
