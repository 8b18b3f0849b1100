"""Predictive densities of posterior draws, by ArviZ."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.inverse.comparison.left_out import WAYS
from dalembert.inverse.posterior.packages import package
from dalembert.inverse.posterior.posterior import Posterior

RELIABLE = 0.7  # shape of the Pareto distribution up to which importance sampling is reliable (Vehtari et al. 2024).
# Code of the finding on residuals that the noise model of a posterior does not explain.
CORRELATED = "correlated-residuals"


@dataclass(frozen=True, eq=False)
class Predictive:
    """Log predictive density of each group, its sum by WAIC, unreliable groups, and what was observed.

    ``groups`` has the number of the group of each observed value.
    """

    densities: np.ndarray
    waic: float
    unreliable: int
    observed: np.ndarray
    groups: np.ndarray


def is_draws(candidate: object) -> bool:
    """Return whether something is a posterior, ArviZ's InferenceData, or a tree of datasets like it."""
    return isinstance(candidate, Posterior) or hasattr(candidate, "posterior") or hasattr(candidate, "log_likelihood")


def default_way(named: Mapping[str, Any]) -> str:
    """Return what is left out if nothing is asked for: blocks where values depend on their neighbours."""
    known = [posterior for posterior in named.values() if isinstance(posterior, Posterior)]
    correlated = any(
        posterior.correlated or any(finding.code == CORRELATED for finding in posterior.findings) for posterior in known
    )
    return "blocks" if correlated and len(known) == len(named) else "values"


def of_draws(name: str, draws: Any, leave_out: str) -> Predictive:
    """Return the predictive densities of groups of values by draws that were made with them."""
    require_known("way", leave_out, WAYS, "leave_out")
    package("arviz", "compare_models")
    if isinstance(draws, Posterior):
        return _of_posterior(draws, leave_out)
    if not hasattr(draws, "log_likelihood"):
        raise InputError(f"compare_models: the draws of {name!r} have no group log_likelihood; sample again with it")
    if leave_out != "values":
        raise InputError(
            f"compare_models: the draws of {name!r} have log-likelihoods of single values only, so leave_out cannot be "
            f"{leave_out!r}; use leave_out='values', or posteriors of sample"
        )
    arrays = [np.asarray(array) for array in draws.log_likelihood.values()]
    logs = np.concatenate([array.reshape(*array.shape[:2], -1) for array in arrays], axis=2)
    observed = [np.ravel(array) for array in getattr(draws, "observed_data", {}).values()]
    known = getattr(draws, "posterior", None)
    return _predictive(known, logs, np.concatenate([*observed, np.zeros(0)]), np.arange(logs.shape[2]))


def _of_posterior(posterior: Posterior, leave_out: str) -> Predictive:
    if leave_out == "experiments" and posterior.experiment_log_likelihood.shape[1] < 2:
        raise InputError("leave_out is 'experiments', but the posterior has one experiment; use 'blocks'")
    if leave_out == "blocks" and posterior.block_log_likelihood.shape[1] < 2:
        raise InputError("leave_out is 'blocks', but the data have one sample; use 'values'")
    logs, groups = {
        "values": (posterior.log_likelihood, np.arange(len(posterior.rows))),
        "blocks": (posterior.block_log_likelihood, posterior.blocks),
        "experiments": (posterior.experiment_log_likelihood, np.unique(posterior.experiments, return_inverse=True)[1]),
    }[leave_out]
    columns = [posterior.data.channels.index(name) for name in posterior.columns]
    observed = posterior.data.values[posterior.rows, columns]
    known = {name: posterior[name] for name in posterior.parameters.names}
    chains, draws = posterior.draws.shape[:2] if len(posterior.kept) == posterior.log_density.size else (1, -1)
    return _predictive(known, logs.reshape(chains, draws, logs.shape[1]), observed, groups)


def _predictive(draws: Any, logs: np.ndarray, observed: np.ndarray, groups: np.ndarray) -> Predictive:
    """Predictive densities from draws, as ArviZ takes them, and their log-likelihoods (chains, draws, groups)."""
    import arviz

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what they say is a finding
        known = arviz.from_dict(log_likelihood={"group": logs})
        loo, waic = arviz.loo(known, pointwise=True, reff=_efficiency(draws, logs.shape[0])), arviz.waic(known)
    return Predictive(
        densities=np.ravel(loo.loo_i),
        waic=float(waic.elpd_waic),
        unreliable=int(np.count_nonzero(np.ravel(loo.pareto_k) > RELIABLE)),
        observed=observed,
        groups=np.ravel(groups),
    )


def _efficiency(draws: Any, chains: int) -> float:
    """Effective number of draws for a mean, relative to their number; 1 for one chain."""
    import arviz

    if chains < 2 or draws is None:
        return 1.0
    known = arviz.convert_to_dataset(draws)
    effective = [np.ravel(array) for array in arviz.ess(known, method="mean").values()]
    return float(np.mean(np.concatenate(effective))) / (known.sizes["chain"] * known.sizes["draw"])
