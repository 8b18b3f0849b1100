"""The tables of a study file, and that they fit together."""

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from pydantic import AfterValidator, BeforeValidator, Field, PlainValidator, WithJsonSchema

from dalembert.errors import InputError
from dalembert.study.tables.data_table import BandsTable, DataTable
from dalembert.study.tables.experiments import ExperimentTable, expanded, wrong_experiments
from dalembert.study.tables.inputs import InputTable, wrong_inputs
from dalembert.study.tables.model_table import ModelTable
from dalembert.study.tables.parameters import ParameterTable, check_names, parameters_of, read_constants, with_series
from dalembert.study.tables.priors import CorrelationTable
from dalembert.study.tables.sensor_table import SensorTable
from dalembert.study.text.table import Name, StudyTable, problem


class About(StudyTable):
    """What the study is called."""

    name: Name | None = Field(None, description="name of the run folder; the file's if not given")
    title: str = Field("", description="heading of the report")
    description: str = Field("", description="what the study is for, and what must come out")


class StudyFile(StudyTable):
    """A study: a model, and one task."""

    known_tasks: ClassVar[Mapping[str, Any]] = {}
    """The tasks that there are, by name."""

    study: About = Field(default_factory=lambda: About.model_validate({}))
    constants: Annotated[
        dict[str, Any],
        PlainValidator(read_constants),
        BeforeValidator(check_names),
        WithJsonSchema({"type": "object", "additionalProperties": {"type": ["number", "string"]}}),
    ] = Field({}, description="named numbers: '400 mm', or expressions of parameters and of constants before them")
    parameters: Annotated[dict[str, ParameterTable], BeforeValidator(check_names), AfterValidator(with_series)] = Field(
        {}, description="numbers that a task varies, by name"
    )
    prior_correlations: list[CorrelationTable] = Field([], description="of normal priors of several parameters")
    model: ModelTable
    solver: Any = None
    harmonic_balance: Any = None
    data: DataTable | None = None
    bands: BandsTable | None = None
    experiments: Annotated[list[ExperimentTable], AfterValidator(expanded)] = Field(
        [], description="several experiments in place of [data]"
    )
    inputs: dict[str, InputTable] = Field({}, description="measured inputs that drive the model, by name")
    sensors: dict[str, SensorTable] = Field({}, description="what is not known of the sensors, by channel")

    def _wrong(self) -> list[str]:
        both = sorted(set(self.parameters) & set(self.constants))
        if both:
            raise problem(f"{', '.join(both)} is both a parameter and a constant; give each name once")
        if len(self.tasks) != 1:
            names = " and ".join(f"[{name}]" for name in self.tasks)
            stated = f"{names} are given" if names else "no task is given"
            raise problem(
                f"{stated}; a study has one task, one of {', '.join(f'[{name}]' for name in self.known_tasks)}"
            )
        (name,) = self.tasks
        return [
            *_wrong_correlations(self),
            *wrong_experiments(self),
            *wrong_inputs(self),
            *_wrong_settings(self),
            *self.known_tasks[name].wrong(self),
        ]

    @property
    def vibrates(self) -> bool:
        """Whether the model is a structure over frequency, and not a mechanism in time."""
        over_frequency = self.harmonic_balance is not None or any(
            self.known_tasks[name].of_structures for name in self.tasks
        )
        return self.model.is_structure or (self.model.function is not None and over_frequency)

    @property
    def tasks(self) -> Mapping[str, StudyTable]:
        """The tables of tasks that the file has, by name; exactly one once it is checked."""
        return {name: table for name in self.known_tasks if (table := getattr(self, name, None)) is not None}


def _wrong_correlations(file: StudyFile) -> list[str]:
    wrong = [sentence for table in file.prior_correlations for sentence in table.wrong(file.parameters)]
    if wrong or not file.prior_correlations:
        return wrong
    try:
        parameters_of(file.parameters, file.prior_correlations)
    except InputError as error:
        return [f"[[prior_correlations]]: {error}"]
    return []


def _wrong_settings(file: StudyFile) -> list[str]:
    wrong, vibrates = [], file.vibrates
    if vibrates and file.solver is not None:
        wrong.append("[solver] integrates mechanisms; a structure over frequency takes [harmonic_balance], or neither")
    if file.harmonic_balance is not None and not vibrates:
        wrong.append("[harmonic_balance] is for structures over frequency, and here is another model; leave it out")
    for where, table in (("[data]", file.data), ("[bands]", file.bands)):
        if table is None:
            continue
        if vibrates and table.frequency is None and not table.universal:
            wrong.append(f"{where}: the key 'frequency' is missing; expected the name of the column of frequencies")
        if file.model.forward is None and not vibrates and table.frequency is not None:
            wrong.append(f"{where}, frequency: the samples of a mechanism lie along time; name its column by time")
    return wrong
