"""Predictive densities of posterior draws, by ArviZ."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.errors import InputError

RELIABLE = 0.7
"""Shape of the Pareto distribution up to which importance sampling is reliable (Vehtari et al. 2024)."""


@dataclass(frozen=True, eq=False)
class Predictive:
    """Log predictive density of each value (values,), its sum by WAIC, unreliable values, and what was observed."""

    densities: np.ndarray
    waic: float
    unreliable: int
    observed: np.ndarray


def is_inference_data(one: object) -> bool:
    """Return whether something is ArviZ's InferenceData, or a tree of datasets like it."""
    return hasattr(one, "posterior") or hasattr(one, "log_likelihood")


def of_draws(name: str, draws: Any) -> Predictive:
    """Return the predictive densities of draws.

    Raises
    ------
    InputError
        Without ArviZ, or for draws without log-likelihoods.
    """
    if not hasattr(draws, "log_likelihood"):
        raise InputError(f"compare_models: the draws of {name!r} have no group log_likelihood; sample again with it")
    try:
        import arviz
    except ImportError:
        raise InputError(
            "comparing draws needs ArviZ, which is not installed; run: pip install 'dalembert[posterior]'"
        ) from None
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what they say is a finding
        loo, waic = arviz.loo(draws, pointwise=True), arviz.waic(draws)
    observed = [np.ravel(one) for one in getattr(draws, "observed_data", {}).values()]
    return Predictive(
        densities=np.ravel(loo.loo_i),
        waic=float(waic.elpd_waic),
        unreliable=int(np.count_nonzero(np.ravel(loo.pareto_k) > RELIABLE)),
        observed=np.concatenate([*observed, np.zeros(0)]),
    )
