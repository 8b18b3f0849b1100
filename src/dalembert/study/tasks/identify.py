"""Identify: parameters from measured data."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, Field

from dalembert.errors import InputError, counted, unknown
from dalembert.optimize import Minimiser, Squares, Swarm
from dalembert.optimize.minimiser import NAMES as MINIMISERS
from dalembert.study.run.duration import TOGETHER, Effort, evaluated
from dalembert.study.run.events import Emit, teller
from dalembert.study.tables.catalogue import methods
from dalembert.study.tables.dataclass_tables import any_of, table_of
from dalembert.study.tables.experiments import measured_channels
from dalembert.study.tables.posing import posed, unknown_names
from dalembert.study.tables.study import Study
from dalembert.study.tasks import assessments
from dalembert.study.tasks.noise import Noise, likelihood_of, noise_of, wrong_noise
from dalembert.study.tasks.requirements import needs_parameters, needs_solver, unmatched, unnamed
from dalembert.study.tasks.shooting import Shooting, ShootingTable
from dalembert.study.tasks.task import Outcome, Task
from dalembert.study.text.numbers import Number, Seconds
from dalembert.study.text.table import StudyTable, alternative, checked

if TYPE_CHECKING:
    from dalembert.inverse import Fit

DEFAULT = "least-squares"
STEPS_IN_SEGMENTS = 80  # of multiple shooting from one start, about: 57 to 105 in studies/chaotic-pendulum

FEWEST = 3
"""Specimens of a population: with two, the likelihood does not bound their spread."""

MOST_MOTIONS = 4
"""Experiments whose motion the report draws: each drawing adds to the size of its page."""


class IdentifyTable(StudyTable):
    """Identify the parameters from the data."""

    method: Any = DEFAULT
    starts: int | None = Field(
        None,
        ge=1,
        description="starts at most; 8 for sums of squares, 1 for others if not given",
    )
    seed: int = Field(0, ge=0, description="of all random numbers")
    polish: bool = Field(False, description="end with least squares from the best point found")
    horizon: Literal["growing", "whole"] = Field(
        "growing", description="'growing' fits ever longer parts of the data, 'whole' all of it from the beginning"
    )
    spread: Literal["latin-hypercube", "sobol"] = Field(
        "latin-hypercube", description="how the points that starts are chosen from are spread over the bounds"
    )
    weights: dict[str, Number] | None = Field(None, description="weight of each channel; from deviations if not given")
    loss: Literal["linear", "huber", "soft-l1", "cauchy"] = Field(
        "linear", description="what is summed of the residuals: squares, or less of those that are large"
    )
    loss_scale: float | None = Field(None, gt=0, description="weighted residual from which one counts as an outlier")
    validation: Annotated[float, Field(gt=0, lt=1)] | list[str] | dict[str, Seconds] | None = Field(
        None,
        description="share of the samples at the end, or names of experiments, that are predicted, not fitted; a table "
        "gives the length of the first part of each experiment that is fitted",
    )
    shooting: Shooting = Field(
        None,
        description="true, or a table: segments that must meet, in place of the growing horizon: for chaotic motion",
    )
    derivative: Literal["auto", "direct", "adjoint"] = Field(
        "auto",
        description="gradients of minimisers: from all sensitivities, from the adjoint, or by the number of parameters",
    )
    population: bool | list[str] = Field(
        False,
        description="mean and spread over the experiments, one for each specimen, of local parameters: their names, or "
        "true for all that the experiments have in common",
    )
    noise: Noise = Field(
        None,
        description="noise model, or a table: noise that is estimated with the parameters; independent if not given",
    )
    profile: bool = Field(False, description="whether to make the profile likelihood of each parameter too")
    prediction: bool = Field(False, description="whether to make bands of the response and of new measurements too")
    level: float = Field(0.95, gt=0, lt=1, description="probability of profiles' intervals and of bands")


def settings(method: Any) -> Any:
    """The method's dataclass: from its table, or with its defaults from its name."""
    if not isinstance(method, str):
        return method.settings()
    known = {name: kind for name, kind in methods().items() if name != "scipy"}
    if method in known:
        return known[method]()
    if method.lower() not in map(str.lower, MINIMISERS):
        raise InputError(unknown("method", method, [*known, *MINIMISERS]))
    return Minimiser(method)


def _cost(table: Any, parameters: int) -> tuple[str, int | None, int | None]:
    """A method's name and about how many simulations it takes; at least and at most, None where it decides later."""
    from dalembert.inverse.starts.multistart import SCREENED

    method, starts, shooting = settings(table.method), table.starts, table.shooting
    name = type(method).__name__
    if shooting is not None:
        least, most = STEPS_IN_SEGMENTS * (1 + parameters), starts or 3
        words = f"{name} in {_segments(shooting)} that must meet"
        return (
            f"{words}: about {least} simulations a start, sensitivities counted, and at most {counted(most, 'start')}",
            least,
            most * least,
        )
    if isinstance(method, Squares):
        least, most = 10 * (1 + parameters), starts or 8
        words = (
            f"{name}: about {least} simulations a start, sensitivities counted, and at most {counted(most, 'start')}"
        )
        return words, least, least if most == 1 else most * (least + SCREENED * parameters)
    if isinstance(method, Swarm):
        count = _simulations(method, starts)
        sizes = f"{starts or 1} x {method.particles} particles x {method.iterations} iterations"
        return f"{name}: {sizes} = {count} simulations", count, count
    return f"{name} {getattr(method, 'name', '')}: as many simulations as it asks for", None, None


def _simulations(swarm: Swarm, starts: int | None) -> int:
    return swarm.particles * swarm.iterations * (starts or 1)


def _segments(shooting: ShootingTable) -> str:
    if shooting.segments is None and shooting.states is None:
        return "segments within which errors grow at most tenfold, and"
    return f"{shooting.settings().count} segments"


def _buildable(method: Any) -> Any:
    checked(settings, method)
    return method


class Identification(Outcome):
    """A fit, and the motion at its values if the model is a mechanism."""

    @property
    def summary(self) -> str:
        return "\n\n".join([self.result.summary(), *assessments.summaries(self.further_results)])

    @property
    def supplements(self) -> list[Any]:
        return [self._motion(), *assessments.reported(self.further_results)]

    def _motion(self) -> Any:
        study, fit = self.study, self.result
        if not study.has_system:
            return None
        if not fit.experiments:
            fitted = fit.values[: len(study.parameters)]  # what follows belongs to sensors
            return study.motion(float(fit.data.coordinate.values[-1]), fitted)
        motions = {}
        for table, item in list(zip(study.file.experiments, fit.experiments, strict=True))[:MOST_MOTIONS]:
            names = [f"{table.name}.{name}" if name in table.local else name for name in study.parameters.names]
            variant = study.variant(table)
            values = np.array([fit.estimates[name] for name in names])
            motions[table.name] = variant.motion(float(item.data.coordinate.values[-1]), values)
        return motions


class Identify(Task):
    """The task ``[identify]``."""

    name = "identify"
    rank = 2
    schema = IdentifyTable
    keeps_responses = True
    needs = (needs_parameters, needs_solver)

    def keys(self) -> dict[str, Any]:
        names_known = ", ".join(f"'{name}'" for name in methods() if name != "scipy")
        tables = any_of([table_of(target, name, varying=False) for name, target in methods().items()])
        method = Annotated[alternative(lambda value: isinstance(value, str), str, tables), AfterValidator(_buildable)]
        names = f"{names_known}, a minimiser of SciPy, or a table with kind and settings"
        return {"method": (method, Field(DEFAULT, description=names))}

    def wrong(self, file: Any) -> list[str]:
        wrong = super().wrong(file)
        if file.data is None and not file.experiments:
            wrong.append("[identify] needs a [data] table")
        channels = measured_channels(file)
        if channels:
            wrong += unmatched(file.identify.weights, channels, "weight", "[identify], weights")
        if file.identify.profile and file.identify.loss != "linear":
            wrong.append(
                f"[identify], profile: the minimum of the loss {file.identify.loss!r} is no likelihood; leave one of "
                "the keys out"
            )
        wrong += wrong_noise(file.identify, self.name, channels)
        return [*wrong, *_wrong_population(file), *_wrong_shooting(file)]

    def plan(self, study: Study) -> str:
        model, data = posed(study)
        if study.table.noise is not None:
            weights = assessments.weights(study.table.weights, model, data)
            likelihood_of(study.table, model, data, weights, self.name, open_orders=True)
        names = assessments.full(model).parameters.names
        return f"identifies {', '.join(names)} from {_measured(model, data)} by {_cost(study.table, len(names))[0]}"

    def effort(self, study: Study) -> Effort:
        model = assessments.full(posed(study)[0])
        _, least, most = _cost(study.table, len(model.parameters))
        method = settings(study.table.method)
        if isinstance(method, Swarm):
            return evaluated(model, model.parameters.start, least, most, TOGETHER, method.particles)
        return evaluated(model, model.parameters.start, least, most)

    def planned(self, study: Study) -> int | None:
        method = settings(study.table.method)
        return _simulations(method, study.table.starts) if isinstance(method, Swarm) else None

    def foresight(self, study: Study) -> int:
        return 2 + len(unknown_names(study))

    def trials(self, study: Study) -> int:
        """Two where segments must meet: whether a motion can begin anew in its midst."""
        return 0 if study.table.shooting is None else 2

    def foreseen(self, study: Study) -> tuple[str, ...]:
        return assessments.foreseen(*posed(study))

    def unknowns(self, study: Study) -> tuple[str, ...]:
        return unknown_names(study)

    def run(self, study: Study, emit: Emit) -> Outcome:
        from dalembert.inverse import identify
        from dalembert.inverse.events import as_record

        table = study.table
        model, data = posed(study)
        fit = identify(
            model,
            data,
            method=settings(table.method),
            weights=assessments.weights(table.weights, model, data),
            horizon=None if table.horizon == "whole" else table.horizon,
            shooting=None if table.shooting is None else table.shooting.settings(),
            noise=noise_of(table, model, self.name),
            on_event=teller(emit, as_record),
            **table.picked("starts", "seed", "polish", "spread", "loss", "loss_scale", "validation", "derivative"),
        )
        return _identified(study, fit, assessments.beyond(table, model, data, fit, teller(emit, as_record)))

    def load(self, study: Study, path: Path) -> Outcome:
        from dalembert.inverse import Fit

        names = [table.name for table in study.file.experiments]
        return _identified(study, Fit.load(path), assessments.load(path, names))


def _identified(study: Study, fit: "Fit", further_results: Mapping[str, Any]) -> Identification:
    known = [deviation if np.isfinite(deviation) else None for deviation in fit.deviations.tolist()]
    deviations = dict(zip(fit.parameters.names, known, strict=True))
    values = fit.parameters.mapping(fit.values)
    return Identification(
        study, fit, {"misfit": fit.misfit, "values": values, "deviations": deviations}, further_results=further_results
    )


def _wrong_population(file: Any) -> list[str]:
    population, where = file.identify.population, "[identify], population"
    if not population:
        return []
    validation = file.identify.validation if isinstance(file.identify.validation, list) else []
    specimens = [table for table in file.experiments if table.name not in validation]
    if len(specimens) < FEWEST:
        return [
            f"{where}: there are {len(specimens)} experiments to fit, and a spread needs at least {FEWEST} specimens; "
            "add [[experiments]], or leave the key out"
        ]
    common = [name for name in specimens[0].local if all(name in table.local for table in specimens)]
    if population is True:
        none = f"{where}: the experiments have no local parameter in common; name those that vary in local of each"
        return [] if common else [none]
    return [
        f"{where}: {name!r} is no local parameter of all experiments; name it in local of each"
        for name in population
        if name not in common
    ]


def _wrong_shooting(file: Any) -> list[str]:
    table = file.identify
    if table.shooting is None:
        return []
    wrong = unnamed(table.shooting.states or {}, file.parameters, "[identify.shooting], states")
    if file.sensors:
        wrong.append("[identify.shooting] cannot be used with [sensors]; leave one of them out")
    if table.validation is not None:
        wrong.append("[identify.shooting] cannot be used with validation; leave one of the keys out")
    if not isinstance(settings(table.method), Squares):
        wrong.append("[identify.shooting] is a way of least squares; leave it or the method out")
    return wrong


def _measured(model: Any, data: Any) -> str:
    if data is not None:
        return f"{len(data.coordinate.values)} samples of {', '.join(data.channels)}"
    each = [f"{item.name}: {_measured(item.model, item.data)}" for item in model]
    return f"{len(model)} experiments ({'; '.join(each)})"
