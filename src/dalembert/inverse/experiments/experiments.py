"""Several experiments as one model and one set of measurements."""

import hashlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data import Measurements
from dalembert.errors import DalembertError, InputError, require_known
from dalembert.findings import Finding
from dalembert.forward import (
    Channel,
    Coordinate,
    Executor,
    ForwardModel,
    Pull,
    Refinement,
    Responses,
    check_derivatives,
    findings_at,
    on_cluster,
    prefers_adjoint,
    pullback,
    refined,
    starting,
)
from dalembert.inverse.experiments.experiment import Experiment, ExperimentPart
from dalembert.inverse.problem.matching import check_finite, check_samples, columns_of, weights_of
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters


@dataclass(frozen=True, eq=False)
class JointModel:
    """Experiments as one forward model. Its samples are those of all experiments, ordered by the part of their
    experiment's time that has passed; samples at the same part share a row, so that the first rows are the beginning of
    every experiment. Its channels are the measured ones of all, ``"NAME.channel"``; where an experiment has no sample
    in a row, the response is 0.
    """

    models: tuple[ForwardModel, ...]
    parts: tuple[ExperimentPart, ...]
    picked: tuple[np.ndarray, ...]  # measured channels among those of each model
    wiring: tuple[np.ndarray, ...]  # where each model's parameters stand among the joint ones
    parameters: Parameters
    channels: tuple[Channel, ...]
    coordinate: Coordinate
    active: frozenset[str]  # experiments that are simulated; the others' response is 0

    @property
    def scaled(self) -> frozenset[str]:
        """Channels with a gain, whose readings may be in another unit than the channel."""
        return frozenset(f"{part.name}.{name}" for part, model in self._all() for name in getattr(model, "scaled", ()))

    @property
    def fingerprint(self) -> str:
        """Hash of the experiments' names, models and parameters."""
        parts = [(part.name, model.fingerprint, sorted(part.channels)) for part, model in self._all()]
        return hashlib.sha256(repr((parts, self.parameters.identity, sorted(self.active))).encode()).hexdigest()

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch, values (batch, rows, channels); a sample fails where one of its experiments does."""
        vectors = np.atleast_2d(vectors)
        values = np.zeros((len(vectors), *self._shape))
        failures: list[str | None] = [None] * len(vectors)
        for part, model, picked, wiring in self._simulated():
            responses = model.evaluate(vectors[:, wiring])
            values[:, part.rows[:, None], part.columns] = responses.values[:, : len(part.rows)][:, :, picked]
            for row, reason in enumerate(responses.failures):
                if reason is not None and failures[row] is None:
                    failures[row] = f"experiment {part.name!r}: {reason}"
        values[[reason is not None for reason in failures]] = np.nan
        return Responses(values, tuple(failures))

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Derivative of the joint response, shape (rows, channels, parameters)."""
        return self.linearise(vector)[1]

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Joint response (rows, channels) and its jacobian (rows, channels, parameters)."""
        response = np.zeros(self._shape)
        jacobian = np.zeros((*self._shape, len(vector)))
        for part, model, picked, wiring in self._simulated():
            with errors_named(part.name):
                values, slopes = model.linearise(np.asarray(vector)[wiring])
            response[part.block] = values[: len(part.rows), picked]
            jacobian[np.ix_(part.rows, part.columns, wiring)] = slopes[: len(part.rows), picked]
        return response, jacobian

    @property
    def adjoint_from(self) -> int | None:
        """1 if the adjoint of one of the models is cheaper than its Jacobian, else None."""
        return 1 if any(prefers_adjoint(model) for _, model, _, _ in self._simulated()) else None

    def pullback(self, vector: np.ndarray) -> tuple[np.ndarray, Pull]:
        """Joint response (rows, channels), and the gradients of its weighted sums, by the cheaper way of each model."""
        response, pulls = np.zeros(self._shape), []
        for part, model, picked, wiring in self._simulated():
            with errors_named(part.name):
                values, pull_part = pullback(model, np.asarray(vector)[wiring])
            response[part.block] = values[: len(part.rows), picked]
            pulls.append((part, picked, wiring, values.shape, pull_part))

        def pull(cotangent: np.ndarray) -> np.ndarray:
            gradient = np.zeros(len(vector))
            for part, picked, wiring, shape, pull_part in pulls:
                inner = np.zeros(shape)
                inner[: len(part.rows), picked] = np.asarray(cotangent)[part.block]
                gradient[wiring] += pull_part(inner)
            return gradient

        return response, pull

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex steps of the models with differences at a vector (parameters,)."""
        for part, model, _, wiring in self._simulated():
            with errors_named(part.name):
                check_derivatives(model, np.asarray(vector)[wiring])

    def findings(self, vector: np.ndarray) -> tuple[Finding, ...]:
        """Findings on the models of all experiments at a joint vector (parameters,), each once."""
        findings: list[Finding] = []
        for model, wiring in zip(self.models, self.wiring, strict=True):
            findings += [
                finding for finding in findings_at(model, np.asarray(vector)[wiring]) if finding not in findings
            ]
        return tuple(findings)

    def first(self, samples: int) -> "JointModel":
        """The same experiments, each cut to its samples in the first rows."""
        parts = tuple(part.first(samples) for part in self.parts)
        models = tuple(  # a motion needs two samples
            model.first(min(len(model.coordinate.values), max(2, len(part.rows))))
            for part, model in zip(parts, self.models, strict=True)
        )
        along = replace(self.coordinate, values=self.coordinate.values[:samples])
        return replace(self, models=models, parts=parts, coordinate=along)

    def refined(self) -> Refinement | None:
        """Return the same experiments, simulated more exactly as far as their models can be; None where none can."""
        finer = [refined(model) if part.name in self.active else None for part, model in self._all()]
        if not any(finer):
            return None
        factors = np.zeros(len(self.channels))
        for part, finer_model, picked in zip(self.parts, finer, self.picked, strict=True):
            if finer_model is not None:
                factors[part.columns] = np.broadcast_to(finer_model.factor, len(finer_model.model.channels))[picked]
        models = tuple(
            model if finer_model is None else finer_model.model
            for model, finer_model in zip(self.models, finer, strict=True)
        )
        active = frozenset(part.name for part, finer_model in zip(self.parts, finer, strict=True) if finer_model)
        how = " or ".join(dict.fromkeys(finer_model.how for finer_model in finer if finer_model))
        return Refinement(replace(self, models=models, active=active), factors, how)

    def only(self, names: Collection[str]) -> "JointModel":
        """The same, with only these experiments simulated."""
        return replace(self, active=frozenset(names))

    @property
    def _shape(self) -> tuple[int, int]:
        return len(self.coordinate.values), len(self.channels)

    def _all(self) -> Iterator[tuple[ExperimentPart, ForwardModel]]:
        return zip(self.parts, self.models, strict=True)

    def _simulated(self) -> Iterator[tuple[ExperimentPart, ForwardModel, np.ndarray, np.ndarray]]:
        for entry in zip(self.parts, self.models, self.picked, self.wiring, strict=True):
            if entry[0].name in self.active:
                yield entry


def joint(experiments: Sequence[Experiment]) -> tuple[JointModel, Measurements]:
    """Experiments as one model and one set of measurements, after checking that they fit together."""
    _check_names(experiments)
    picked = []
    for item in experiments:
        with errors_named(item.name):
            picked.append(columns_of(item.model, item.data))
            check_finite(item.data)
            check_samples(item.model, item.data)
    parameters = _parameters(experiments)
    rows, along = _rows([item.data.coordinate.values for item in experiments])
    ends = np.cumsum([0, *(len(item.data.channels) for item in experiments)])
    parts = tuple(
        ExperimentPart(item.name, item.data.coordinate, item.data.channels, part_rows, np.arange(begin, end))
        for item, part_rows, begin, end in zip(experiments, rows, ends[:-1], ends[1:], strict=True)
    )
    channels = tuple(
        replace(item.model.channels[column], name=f"{item.name}.{item.model.channels[column].name}")
        for item, columns in zip(experiments, picked, strict=True)
        for column in columns
    )
    wiring = tuple(
        np.array([parameters.names.index(part_rows.name) for part_rows in item.parameters], int) for item in experiments
    )
    models, names = tuple(item.model for item in experiments), frozenset(item.name for item in experiments)
    model = JointModel(models, parts, tuple(picked), wiring, parameters, channels, along, names)
    return model, _measurements(experiments, model)


def placed(model: ForwardModel | Sequence[Experiment], executor: Executor) -> ForwardModel | Sequence[Experiment]:
    """The model, or the model of each experiment, where its batches are computed."""
    if executor is None:
        return model
    if isinstance(model, Sequence):
        return [replace(item, model=on_cluster(item.model, executor)) for item in model]
    return on_cluster(model, executor)


def begun(
    model: ForwardModel | Sequence[Experiment], start: Mapping[str, float] | ArrayLike | None
) -> ForwardModel | Sequence[Experiment]:
    """The model, or the model of each experiment, first built where a search starts."""
    if start is None:
        return model
    if not isinstance(model, Sequence):
        return starting(model, _values(model.parameters, start))
    _check_names(model)
    values = _values(_parameters(model), start)
    return [replace(item, model=starting(item.model, item.values(values))) for item in model]


def _values(parameters: Parameters, start: Mapping[str, float] | ArrayLike) -> dict[str, float]:
    return parameters.mapping(parameters.real_vector(start))


def joint_weights(model: JointModel, given: Mapping[str, ArrayLike] | None) -> np.ndarray | None:
    """Weights (rows, channels) of the joint response from those of each experiment by name; 1 for the others."""
    if given is None:
        return None
    names = [part.name for part in model.parts]
    if not isinstance(given, Mapping):
        raise InputError(
            "weights: with several experiments expected a mapping from the name of an experiment to its weights, "
            f"not a {type(given).__name__}"
        )
    for name in given:
        require_known("experiment", name, names, "weights")
    weights = np.zeros((len(model.coordinate.values), len(model.channels)))
    for part in model.parts:
        with errors_named(part.name):
            weights[part.block] = weights_of(given.get(part.name), (len(part.rows), len(part.columns)))
    return weights


@contextmanager
def errors_named(name: str) -> Iterator[None]:
    """Name the experiment in errors of the block."""
    try:
        yield
    except DalembertError as error:
        raise type(error)(f"experiment {name!r}: {error}") from error


def _check_names(experiments: Sequence[Experiment]) -> None:
    if not experiments:
        raise InputError("no experiments were given; expected at least one Experiment(name, model, data)")
    for item in experiments:
        if not isinstance(item, Experiment):
            raise InputError(f"a {type(item).__name__} was given; expected only Experiment(name, model, data)")
    names = [item.name for item in experiments]
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        raise InputError(f"experiments must have different names; repeated: {', '.join(repeated)}")
    known = [item.data.deviations is not None for item in experiments]
    if any(known) and not all(known):
        missing = names[known.index(False)]
        raise InputError(
            f"experiment {missing!r} has no deviations, but {names[known.index(True)]!r} has; give them for all "
            "experiments or for none, so that their residuals can be compared"
        )


def _parameters(experiments: Sequence[Experiment]) -> Parameters:
    """Parameters of all experiments, each once, in the order in which they occur."""
    by_name: dict[str, tuple[Parameter, str]] = {}
    for item in experiments:
        for parameter in (*item.parameters, *item.fixed):
            known, where = by_name.setdefault(parameter.name, (parameter, item.name))
            if known != parameter:
                raise InputError(
                    f"parameter {parameter.name!r} is shared by the experiments {where!r} and {item.name!r}, but is "
                    f"between {known.lower:.6g} and {known.upper:.6g} in one and between {parameter.lower:.6g} and "
                    f"{parameter.upper:.6g} in the other, or differs in unit, scale or start; give it alike, or name "
                    "it in own"
                )
    return Parameters(tuple(parameter for parameter, _ in by_name.values()))


def _rows(samples: Sequence[np.ndarray]) -> tuple[list[np.ndarray], Coordinate]:
    """Rows of each experiment's samples (samples,), and the part of the time that the rows lie at."""
    parts = [((times - times[0]) / (np.ptp(times) or 1.0)).round(12) for times in samples]
    rows = np.unique(np.concatenate(parts))
    return [np.searchsorted(rows, part) for part in parts], Coordinate("part of each experiment", "", rows)


def _measurements(experiments: Sequence[Experiment], model: JointModel) -> Measurements:
    """All data in the rows and columns of the joint response; NaN where an experiment has no sample."""
    values = np.full((len(model.coordinate.values), len(model.channels)), np.nan)
    sampled = np.zeros(values.shape, dtype=bool)
    for item, part in zip(experiments, model.parts, strict=True):
        values[part.block], sampled[part.block] = item.data.values, item.data.taken
    deviations = [item.data.deviations for item in experiments if item.data.deviations is not None]
    return Measurements(
        model.coordinate,
        tuple(channel.name for channel in model.channels),
        values,
        np.concatenate(deviations) if deviations else None,
        missing="leave-out",
        wraps=tuple(f"{item.name}.{name}" for item in experiments for name in item.data.wraps),
        origin="; ".join(dict.fromkeys(filter(None, (item.data.origin for item in experiments)))),
        sampled=sampled,
        source_units={
            f"{item.name}.{name}": unit for item in experiments for name, unit in item.data.source_units.items()
        },
    )
