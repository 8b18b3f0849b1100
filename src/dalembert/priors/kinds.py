"""All kinds of priors, and the prior that a file holds."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, TypeAlias

from dalembert.errors import InputError, require_known
from dalembert.priors.correlated import CorrelatedNormal
from dalembert.priors.normal import HalfNormal, LogNormal, Normal
from dalembert.priors.prior import Prior
from dalembert.priors.uniform import LogUniform, Uniform

AnyPrior: TypeAlias = Prior | CorrelatedNormal
KINDS: tuple[type[AnyPrior], ...] = (Normal, LogNormal, HalfNormal, Uniform, LogUniform, CorrelatedNormal)


def prior_of(table: Mapping[str, Any]) -> AnyPrior:
    """The prior of a mapping with its ``kind`` and its arguments, as files hold it.

    Raises
    ------
    InputError
        For an unknown kind or other arguments.

    Examples
    --------
    >>> prior_of({"kind": "normal", "mean": 1.0, "deviation": 0.1})
    Normal(mean=1.0, deviation=0.1)
    """
    kinds = {getattr(kind, "name", "correlated-normal"): kind for kind in KINDS}
    arguments = dict(table)
    name = str(arguments.pop("kind", None))
    require_known("prior", name, kinds)
    try:
        return kinds[name](**arguments)
    except TypeError:
        wanted = [part.name for part in fields(kinds[name]) if part.init]
        raise InputError(
            f"the prior {name!r} has {', '.join(arguments) or 'nothing'}; expected {', '.join(wanted)}"
        ) from None
