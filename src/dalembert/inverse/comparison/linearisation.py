"""The linearisation of a fit, from which values that are left out are predicted."""

from dataclasses import replace

from dalembert.errors import InputError
from dalembert.inverse.comparison.conditional import WithNoise
from dalembert.inverse.comparison.predictive import Linearised
from dalembert.inverse.fit.fit import Fit


def linearised(name: str, fit: Fit, *, normal: bool = False) -> Linearised | WithNoise:
    """Return the linearisation of a fit; with ``normal`` densities also where the noise follows from the residuals."""
    if fit.nodes is not None and fit.nodes.segments > 1:
        raise InputError(
            f"{name!r} is a fit of {fit.nodes.segments} segments, which predict nothing; fit fewer samples, so that "
            "they merge into one run"
        )
    if "loss" in fit.provenance:
        raise InputError(
            f"{name!r} was fitted with a robust loss, which is not a likelihood; fit it with loss='linear', without "
            "the outliers"
        )
    if fit.jacobian is None:
        raise InputError(
            f"{name!r} has no Jacobian, since its model gives no derivatives; use a model with derivatives"
        )
    return replace(Linearised.of(fit), normal=normal) if fit.noise is None else WithNoise(fit, fit.weights)
