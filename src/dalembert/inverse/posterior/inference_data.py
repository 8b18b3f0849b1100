"""A posterior as ArviZ has it."""

from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.inverse.posterior.packages import package

if TYPE_CHECKING:
    from arviz import InferenceData

    from dalembert.inverse.posterior.posterior import Posterior


def inference_data(posterior: "Posterior") -> "InferenceData":
    """Return the groups posterior, sample_stats, log_likelihood, posterior_predictive, observed_data, constant_data.

    Log-likelihoods and predictions are by channel, ``"EXPERIMENT.channel"`` with several experiments. If they are of
    some draws only, these are one chain.
    """
    arviz, (chains, draws, _) = package("arviz", "inference_data"), posterior.draws.shape
    names = posterior.columns
    of_channel = {name: np.flatnonzero([one == name for one in names]) for name in dict.fromkeys(names)}
    every = len(posterior.kept) == chains * draws
    likelihoods = posterior.log_likelihood.reshape(chains, draws, -1) if every else posterior.log_likelihood[None]
    columns = {name: posterior.data.channels.index(name) for name in of_channel}
    rows = {name: posterior.rows[places] for name, places in of_channel.items()}
    along = posterior.data.coordinate.values
    coordinates: dict[str, Any] = {f"{name}.sample": along[rows[name]] for name in of_channel}
    dimensions = {name: [f"{name}.sample"] for name in of_channel}
    return arviz.from_dict(
        posterior={name: posterior[name] for name in posterior.parameters.names},
        sample_stats={**posterior.statistics, "lp": posterior.log_density},
        log_likelihood={name: likelihoods[:, :, places] for name, places in of_channel.items()},
        posterior_predictive={name: posterior.replicas[None, :, rows[name], columns[name]] for name in of_channel},
        observed_data={name: posterior.data.values[rows[name], columns[name]] for name in of_channel},
        coords=coordinates,
        dims=dimensions,
    )
