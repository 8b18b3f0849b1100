"""The likelihood of a model's parameters and of the noise of the data."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data import Measurements
from dalembert.forward import Executor, ForwardModel, takes_executor
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.experiments.experiments import placed
from dalembert.inverse.experiments.joined import joined
from dalembert.inverse.noise.correlation.series import Series
from dalembert.inverse.noise.likelihood.channel_noise import ChannelNoise
from dalembert.inverse.noise.likelihood.expansion import Expansion, expanded
from dalembert.inverse.noise.likelihood.placing import Noise, noises_of, picked_models
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem, pose
from dalembert.parameters import Parameters


class Places(NamedTuple):
    """Where values stand: names of experiment (empty for a single one) and channel, and row, shape (values,) each.

    Rows are those of the data; with several experiments those of the joint data, see :class:`Fit`.
    """

    experiment: np.ndarray
    channel: np.ndarray
    row: np.ndarray


@dataclass(frozen=True, eq=False)
class Likelihood:
    """Log-likelihood log p(data | parameters) of normally distributed noise, and its derivatives.

    Parameters
    ----------
    problem : MisfitProblem
        Model or joint experiments, and data; values of weight 0 do not count.
    noise : NoiseModel or mapping of str to NoiseModel
        As it was given.
    parameters : Parameters
        Those of the model, then those of the noise, ``"noise.CHANNEL.NAME"``. Positive ones are searched by their
        logarithm. Priors are no part of the likelihood.
    channels : tuple of ChannelNoise
        The noise of each channel of each experiment.

    Notes
    -----
    log p = −½ Σ w_i² − Σ log s_i − n/2 log 2π, where w_i = (m_i − y_i)/s_i, with the mean m_i and the standard
    deviation s_i of value i after those before it in its channel. Independent noise has m_i = ŷ_i, the response.
    """

    problem: MisfitProblem
    noise: Noise
    parameters: Parameters
    channels: tuple[ChannelNoise, ...]

    @cached_property
    def noise_parameters(self) -> Parameters:
        """Parameters of the noise alone."""
        mine = set(self.problem.model.parameters.names)
        known = {full for channel in self.channels for full in channel.names.values()}
        fixed = tuple(item for item in self.parameters.fixed if item.name in known)
        return Parameters(tuple(item for item in self.parameters if item.name not in mine), fixed)

    @cached_property
    def places(self) -> Places:
        """Where each value of :meth:`pointwise` and :meth:`whitened` stands."""
        width = len(self.problem.data.channels)
        rows = [channel.series.rows // width for channel in self.channels]
        experiments = [
            np.full(len(channel_rows), channel.series.experiment)
            for channel_rows, channel in zip(rows, self.channels, strict=True)
        ]
        names = [
            np.full(len(channel_rows), channel.series.channel)
            for channel_rows, channel in zip(rows, self.channels, strict=True)
        ]
        return Places(np.concatenate(experiments), np.concatenate(names), np.concatenate(rows))

    def evaluate(self, vectors: ArrayLike) -> np.ndarray:
        """Return the log-likelihood (batch,) at vectors (batch, parameters); −inf where a simulation failed."""
        values = np.sum(self.pointwise(vectors), axis=1)
        return np.where(np.isnan(values), -np.inf, values)

    def pointwise(self, vectors: ArrayLike) -> np.ndarray:
        """Return the log density of each value after those before it in its channel, shape (batch, values).

        NaN where a simulation failed.
        """
        return self.of_responses(*self._simulated(vectors))

    def of_responses(self, batch: np.ndarray, simulated: np.ndarray) -> np.ndarray:
        """Return :meth:`pointwise` from responses (batch, samples, channels) at vectors (batch, parameters)."""
        residuals, responses = self._compared(simulated)
        known = self._known(batch)
        densities = [
            channel.log_densities(residuals[:, rows], responses[:, rows], channel.values(known))
            for channel, rows in self._placed
        ]
        return np.concatenate(densities, axis=1)

    def left_out(self, vectors: ArrayLike, *groups: ArrayLike) -> tuple[np.ndarray, ...]:
        """Return the log density of each group of values after all others: what leave-one-out needs.

        Parameters
        ----------
        vectors : array, shape (batch, parameters)
        *groups : array of int, shape (values,)
            Number of the group of each value, from 0. Each vector is simulated once for all of these groupings.

        Returns
        -------
        tuple of array, shape (batch, groups)
            For each grouping. NaN where a simulation failed. Groups of single values have the densities of
            :meth:`pointwise` where the noise is independent.
        """
        batch, simulated = self._simulated(vectors)
        residuals, responses = self._compared(simulated)
        known, numbers = self._known(batch), [np.asarray(group) for group in groups]
        sums = [np.zeros((len(batch), int(np.max(group, initial=-1)) + 1)) for group in numbers]
        begin = 0
        for channel, rows in self._placed:
            group_numbers = [np.unique(of_all[begin : begin + len(rows)], return_inverse=True) for of_all in numbers]
            values = residuals[:, rows], responses[:, rows], channel.values(known)
            densities = channel.left_out(*values, [local for _, local in group_numbers])
            for total, (mine, _), part in zip(sums, group_numbers, densities, strict=True):
                total[:, mine] += part
            begin += len(rows)
        return tuple(sums)

    @property
    def _placed(self) -> list[tuple[ChannelNoise, np.ndarray]]:
        """Each channel with the places of its values."""
        return [(channel, channel.series.rows) for channel in self.channels]

    def _compared(self, responses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Residuals (batch, places) and responses (batch, places) of responses (batch, samples, channels)."""
        return self.problem.unweighted_residual(responses).reshape(len(responses), -1), responses.reshape(
            len(responses), -1
        )

    def linearise(self, vector: ArrayLike) -> tuple[float, np.ndarray]:
        """Return the log-likelihood and its exact gradient (parameters,).

        Raises
        ------
        SolveError
            If the simulation fails.
        """
        if self.problem.by_adjoint:
            return self._by_adjoint(self.parameters.real_vector(vector))  # pyright: ignore[reportArgumentType]
        expansion = self.expansion(vector)
        return expansion.value, expansion.gradient

    def _by_adjoint(self, vector: np.ndarray) -> tuple[float, np.ndarray]:
        """The log-likelihood and its gradient, whose price does not grow with the number of the model's parameters."""
        response, pull = self.problem.pulled(vector[: self._split])
        known, total = self.parameters.arguments(vector), 0.0
        gradient, cotangent = np.zeros(len(vector)), np.zeros(response.size)
        residual = self.problem.unweighted_residual(response).ravel()
        for channel in self.channels:
            places = channel.series.rows
            value, by_response, by_noise = channel.cotangent(
                residual[places], response.ravel()[places], channel.values(known)
            )
            total += value
            cotangent[places] += by_response
            for full, slope in by_noise.items():
                if full in self.parameters.names:
                    gradient[self.parameters.names.index(full)] += slope
        gradient[: self._split] += pull(cotangent.reshape(response.shape))
        return total, gradient

    def expansion(self, vector: ArrayLike) -> Expansion:
        """Return the log-likelihood with the whitened residuals and their derivatives.

        Raises
        ------
        SolveError
            If the simulation fails.
        """
        vector = self.parameters.real_vector(vector)  # pyright: ignore[reportArgumentType]
        at = self.problem.linearise(vector[: self._split])
        return expanded(self.problem, self.channels, self.parameters, at, vector)

    def whitened(self, vector: ArrayLike) -> np.ndarray:
        """Return standardised, whitened residuals (values,): independent and normal, N(0, 1), if all is right.

        NaN where the simulation failed.
        """
        batch, responses = self._simulated(vector)
        residual, response = self.problem.unweighted_residual(responses[0]).ravel(), responses[0].ravel()
        known = self.parameters.arguments(batch[0])
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.concatenate(
                [
                    channel.standardised(
                        residual[channel.series.rows], response[channel.series.rows], channel.values(known)
                    )[0]
                    for channel in self.channels
                ]
            )

    def replicas(self, vectors: ArrayLike, seed: int) -> np.ndarray:
        """Return responses with simulated noise (batch, samples, channels); NaN where no value is compared."""
        batch, responses = self._simulated(vectors)
        random = np.random.default_rng(seed)
        replicas = np.full((len(batch), responses[0].size), np.nan)
        for row, vector, response in zip(replicas, batch, responses.reshape(len(batch), -1), strict=True):
            known = self.parameters.arguments(vector)
            for channel in self.channels:
                places = channel.series.rows
                row[places] = response[places] + channel.simulated(response[places], channel.values(known), random)
        return replicas.reshape(responses.shape)

    @property
    def _split(self) -> int:
        """Number of the model's parameters."""
        return len(self.problem.model.parameters)

    def _simulated(self, vectors: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        batch = self.parameters.batch(vectors)
        return batch, self.problem.responses(batch[:, : self._split])

    def _known(self, batch: np.ndarray) -> Mapping[str, np.ndarray]:
        """Values of all parameters by name, shape (batch, 1) each."""
        named = self.parameters.arguments(batch.T[:, :, None])
        return {name: np.broadcast_to(value, (len(batch), 1)) for name, value in named.items()}


@takes_executor
def likelihood(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None = None,
    *,
    noise: Noise | None = None,
    weights: ArrayLike | Mapping[str, ArrayLike] | None = None,
    executor: Executor = None,
) -> Likelihood:
    """Likelihood of a model, or of several experiments, for data with noise.

    Parameters
    ----------
    model : ForwardModel or sequence of Experiment
    data : Measurements, optional
        Left out with experiments, which have their own.
    noise : NoiseModel, its name, mapping of channel to NoiseModel, or EstimatedNoise, optional
        :class:`KnownNoise` if the data have deviations or weights are given, else :class:`ConstantNoise`. A mapping
        names channels, with several experiments also ``"NAME.channel"``.
    weights : array, shape (channels,) or (samples, channels), or mapping of experiments to such arrays, optional
        1/variance of the values, in place of the data's deviations.
    executor : str or distributed.Client, optional
        Where batches are computed.

    Returns
    -------
    Likelihood

    Raises
    ------
    DataError
        For data that do not fit the model.
    InputError
        For an unknown channel, a noise model that the samples do not allow, known noise that is not known.

    Examples
    --------
    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0.0, 1.0, 5)
    >>> line = PythonModel(lambda slope: slope * times, {"slope": (0.0, 3.0)}, ["x"], times)
    >>> found = likelihood(line, Measurements.of(times, {"x": 2 * times}))
    >>> found.parameters.names
    ('slope', 'noise.x.deviation')
    >>> np.allclose(found.evaluate([[2.0, 0.1]]), -5 * np.log(0.1 * np.sqrt(2 * np.pi)))
    True
    """
    joint_model, measured, weights_of_data, _ = joined("likelihood", placed(model, executor), data, weights)
    problem = pose(joint_model, measured, weights_of_data, Journal(len(measured.coordinate.values)), noise_known=True)
    return likelihood_of(problem, noise, weighted=weights is not None)


def likelihood_of(problem: MisfitProblem, noise: Noise | None, *, weighted: bool = False) -> Likelihood:
    """Return the likelihood of a problem; ``weighted`` means that its weights are 1/variance."""
    known = weighted or problem.data.deviations is not None
    picked, noise_by_name = picked_models(problem, noise, known=known)
    return placed_likelihood(problem, picked, noise_by_name, known=known)


def placed_likelihood(
    problem: MisfitProblem, picked: Mapping[Series, NoiseModel], noise: Noise, *, known: bool
) -> Likelihood:
    """Return the likelihood of a problem with a noise model for each of its series."""
    channels, noise_parameters_here = noises_of(problem, picked, known=known)
    model = problem.model.parameters
    parameters = Parameters((*model.items, *noise_parameters_here.items), (*model.fixed, *noise_parameters_here.fixed))
    return Likelihood(problem, noise, parameters, channels)
