"""The result of sampling a posterior."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.experiments.experiment import ExperimentPart
from dalembert.inverse.fit.fit import check_level
from dalembert.inverse.fit.stored_data import StoredData, StoredParts
from dalembert.inverse.posterior.convergence import Convergence, ended
from dalembert.inverse.posterior.packages import package
from dalembert.results import EndedResult
from dalembert.stored_fields import Labels, Over, Source, Store, StoredParameters
from dalembert.tables import Table, cell, cells, counted, few_values, interval, with_deviation

if TYPE_CHECKING:
    from arviz import InferenceData

SEPARATE = "separate-modes"  # code of the finding on modes that no chain connects
_OF_DRAWS = ("chain", "draw")


class _Statistics:
    """Statistics of the sampler as variables over ``chain`` and ``draw``."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Mapping[str, np.ndarray]) -> None:
        settings[name] = sorted(value)
        for statistic, array in value.items():
            array = array.astype(np.int8) if array.dtype == bool else array
            to.variables[f"statistic_{statistic}"] = (_OF_DRAWS, array)

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> dict[str, np.ndarray]:
        arrays = {statistic: source.arrays[f"statistic_{statistic}"] for statistic in settings[name]}
        return {
            statistic: array.astype(bool) if array.dtype == np.int8 else array for statistic, array in arrays.items()
        }


@dataclass(frozen=True, eq=False)
class Posterior(EndedResult):
    """Draws of the posterior distribution of parameters, as :func:`sample` returns them.

    Parameters
    ----------
    parameters : Parameters
        Those of the model, then those of the noise.
    draws : array, shape (chains, draws, parameters)
    log_density : array, shape (chains, draws)
        Of the posterior, in the coordinates of the sampler, up to a constant.
    statistics : mapping of str to array, shape (chains, draws)
        Of the sampler, by the names of ArviZ, such as ``diverging``.
    r_hat, bulk, tail, errors : array, shape (parameters,)
        Rank-normalised R-hat, effective sample sizes for centre and tails, Monte Carlo standard error of the mean.
    mode : array, shape (parameters,)
        Largest posterior density of the coordinates without bounds.
    linear_deviations : array, shape (parameters,)
        Standard deviations from the response and the priors, linearised at the mode.
    log_likelihood : array, shape (kept draws, values)
        Log density of each compared value after all others, at the draws numbered by ``kept``: what leave-one-out
        needs. With independent noise it is that of the value alone.
    kept : array of int, shape (kept draws,)
        Numbers of draws, counted over all chains in turn: all, or evenly spaced ones where the values are very many.
    experiments, channels : tuple of str, length values
        Where the compared values stand; experiments are empty for a single one.
    rows : array of int, shape (values,)
        Of the compared values in the data.
    blocks : array of int, shape (values,)
        Number of the block of neighbouring samples that each compared value is in.
    block_log_likelihood : array, shape (kept draws, blocks)
        Log density of each block, with all its channels, after all other values.
    experiment_log_likelihood : array, shape (kept draws, experiments)
        Log density of all compared values of each experiment.
    correlated : bool
        Whether a noise model is correlated from sample to sample.
    replicas : array, shape (replicas, samples, channels)
        Posterior predictive: responses with simulated noise; NaN where no value was compared.
    replicated : array of int, shape (replicas,)
        Numbers of their draws.
    data : Measurements
    parts : tuple of ExperimentPart
        Where each of several experiments stands in the data.
    sampler : str
    warmup, simulations : int
        ``simulations`` are those of the sampling; a response with its sensitivities counts as 1 + parameters.
    provenance : mapping
    findings : tuple of Finding
    """

    FORMAT: ClassVar[str] = "dalembert posterior 1"
    TITLE: ClassVar[str] = "Posterior"
    VERDICTS: ClassVar[tuple[str, str]] = ("sampled", "not converged")

    parameters: StoredParameters
    draws: Annotated[np.ndarray, Over("chain", "draw", "parameter")]
    log_density: Annotated[np.ndarray, Over("chain", "draw")]
    statistics: Annotated[Mapping[str, np.ndarray], _Statistics()]
    r_hat: Annotated[np.ndarray, Over("parameter")]
    bulk: Annotated[np.ndarray, Over("parameter")]
    tail: Annotated[np.ndarray, Over("parameter")]
    errors: Annotated[np.ndarray, Over("parameter")]
    mode: Annotated[np.ndarray, Over("parameter")]
    linear_deviations: Annotated[np.ndarray, Over("parameter")]
    log_likelihood: Annotated[np.ndarray, Over("kept", "value")]
    kept: Annotated[np.ndarray, Over("kept", name="kept_draw")]
    experiments: Annotated[tuple[str, ...], Labels("value", name="value_experiment")]
    channels: Annotated[tuple[str, ...], Labels("value", name="value_channel")]
    rows: Annotated[np.ndarray, Over("value", name="value_row")]
    blocks: Annotated[np.ndarray, Over("value", name="value_block")]
    block_log_likelihood: Annotated[np.ndarray, Over("kept", "block")]
    experiment_log_likelihood: Annotated[np.ndarray, Over("kept", "experiment")]
    correlated: bool
    replicas: Annotated[np.ndarray, Over("replica", "sample", "channel")]
    replicated: Annotated[np.ndarray, Over("replica", name="replicated_draw")]
    data: StoredData
    sampler: str
    warmup: int
    simulations: int
    provenance: Mapping[str, Any]
    parts: Annotated[Sequence[ExperimentPart], StoredParts()] = ()
    findings: tuple[Finding, ...] = field(default=())

    @property
    def convergence(self) -> Convergence:
        """Diagnostics of the chains."""
        return Convergence(self.r_hat, self.bulk, self.tail, self.errors)

    @property
    def outcome(self) -> tuple[Finding, ...]:
        """Whether the chains have converged, and whether there are enough draws."""
        return tuple(ended(self.parameters.names, self.convergence, *self.draws.shape[:2]))

    @property
    def success(self) -> bool:
        """Whether no finding on the chains is an error."""
        of_chains = (*self.outcome, *(finding for finding in self.findings if finding.code == SEPARATE))
        return all(finding.severity != "error" for finding in of_chains)

    @property
    def flat(self) -> np.ndarray:
        """All draws, chain after chain, shape (chains × draws, parameters)."""
        return self.draws.reshape(-1, len(self.parameters))

    @property
    def mean(self) -> np.ndarray:
        """Posterior means (parameters,)."""
        return self.flat.mean(axis=0)

    @property
    def deviations(self) -> np.ndarray:
        """Posterior standard deviations (parameters,)."""
        return self.flat.std(axis=0, ddof=1)

    @property
    def estimates(self) -> dict[str, float]:
        """Posterior means by name."""
        return self.parameters.mapping(self.mean)

    def __getitem__(self, name: str) -> np.ndarray:
        """Draws of a parameter, shape (chains, draws)."""
        return self.draws[:, :, self.parameters.names.index(name)]

    def intervals(self, level: float = 0.95) -> dict[str, tuple[float, float]]:
        """Interval of each parameter between the quantiles (1 ∓ level)/2 of its draws, by name.

        Raises
        ------
        InputError
            For a level that is not between 0 and 1.
        """
        check_level(level, "intervals")
        lower, upper = np.quantile(self.flat, [(1 - level) / 2, (1 + level) / 2], axis=0)
        return dict(zip(self.parameters.names, zip(lower.tolist(), upper.tolist(), strict=True), strict=True))

    def band(self, level: float = 0.95) -> tuple[np.ndarray, np.ndarray]:
        """Quantiles of the posterior predictive, shape (samples, channels) each; NaN where no value was compared."""
        check_level(level, "band")
        lower, upper = np.full((2, *self.replicas.shape[1:]), np.nan)
        compared = np.all(np.isfinite(self.replicas), axis=0)
        ends = np.quantile(self.replicas[:, compared], [(1 - level) / 2, (1 + level) / 2], axis=0)
        lower[compared], upper[compared] = ends
        return lower, upper

    @property
    def columns(self) -> list[str]:
        """Channel of each compared value in the data, ``"EXPERIMENT.channel"`` with several experiments."""
        return [f"{e}.{c}" if e else c for e, c in zip(self.experiments, self.channels, strict=True)]

    @property
    def inference_data(self) -> "InferenceData":
        """Everything as ArviZ has it: posterior, sampler statistics, log-likelihood, predictive and observed data.

        Log-likelihoods and predictions are by channel, ``"EXPERIMENT.channel"`` with several experiments. If they are
        of some draws only, these are one chain. Needs the extra ``posterior``.
        """
        arviz, (chains, draws, _) = package("arviz", "inference_data"), self.draws.shape
        of_channel = {name: np.flatnonzero(np.array(self.columns) == name) for name in dict.fromkeys(self.columns)}
        complete = len(self.kept) == chains * draws
        likelihoods = self.log_likelihood.reshape(chains, draws, -1) if complete else self.log_likelihood[None]
        columns = {name: self.data.channels.index(name) for name in of_channel}
        rows = {name: self.rows[values] for name, values in of_channel.items()}
        along = self.data.coordinate.values
        return arviz.from_dict(
            posterior={name: self[name] for name in self.parameters.names},
            sample_stats={**self.statistics, "lp": self.log_density},
            log_likelihood={name: likelihoods[:, :, values] for name, values in of_channel.items()},
            posterior_predictive={name: self.replicas[None, :, rows[name], columns[name]] for name in of_channel},
            observed_data={name: self.data.values[rows[name], columns[name]] for name in of_channel},
            coords={f"{name}.sample": along[rows[name]] for name in of_channel},
            dims={name: [f"{name}.sample"] for name in of_channel},
        )

    def key_values(self) -> dict[str, str]:
        return few_values(self.parameters, map(with_deviation, self.mean.tolist(), self.deviations.tolist()))

    def facts(self) -> dict[str, str]:
        chains, draws, _ = self.draws.shape
        return {
            "draws": f"{counted(chains)} chains × {counted(draws)}",
            "sampler": self.sampler,
            "simulations": counted(self.simulations),
        }

    def tables(self, profiles: Any = None) -> tuple[Table, ...]:
        """Return means, intervals and convergence of the parameters, beside intervals of profiles if given."""
        names, linear = self.parameters.names, 1.959964 * self.linear_deviations
        columns: dict[str, Iterable[object]] = {
            "parameter": names,
            "mean": map(cell, self.mean, self.deviations),
            "standard deviation": cells(self.deviations, 2),
            "95 % of the posterior": [interval(*ends) for ends in self.intervals().values()],
            "95 % linearised": map(interval, self.mode - linear, self.mode + linear),
        }
        if profiles is not None:
            ends = profiles.intervals
            texts = [interval(*ends[name]) if name in ends else "" for name in names]
            columns[f"{100 * profiles.level:g} % of the profile"] = texts
        columns |= {
            "unit": [item.unit for item in self.parameters],
            "R-hat": cells(self.r_hat, 4),
            "effective draws, centre": cells(self.bulk, 3),
            "effective draws, tails": cells(self.tail, 3),
            "error of the mean": cells(self.errors, 2),
        }
        return (Table.of("posterior", "Posterior of the parameters", columns),)
