"""The tables of a study file, but for those of tasks."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field, PlainValidator, WithJsonSchema

from dalembert.study.data_table import BandsTable, DataTable
from dalembert.study.experiments import ExperimentTable, SensorTable, expanded
from dalembert.study.inputs import InputTable
from dalembert.study.model_table import ModelTable
from dalembert.study.parameters import ParameterTable, check_names, read_constants
from dalembert.study.table import Name, StudyTable


class About(StudyTable):
    """What the study is called."""

    name: Name | None = Field(None, description="name of the run folder; the file's if not given")
    title: str = Field("", description="heading of the report")
    description: str = Field("", description="what the study is for, and what must come out")


class StudyFile(StudyTable):
    """A study: a model, and one task."""

    study: About = Field(default_factory=lambda: About.model_validate({}))
    constants: Annotated[
        dict[str, Any],
        PlainValidator(read_constants),
        BeforeValidator(check_names),
        WithJsonSchema({"type": "object", "additionalProperties": {"type": ["number", "string"]}}),
    ] = Field({}, description="named numbers: '400 mm', or expressions of parameters and of constants before them")
    parameters: Annotated[dict[str, ParameterTable], BeforeValidator(check_names)] = {}
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

    @property
    def tasks(self) -> Mapping[str, StudyTable]:
        """The tables of tasks that the file has, by name; exactly one once it is checked."""
        raise NotImplementedError

    @property
    def vibrates(self) -> bool:
        """Whether the model is a structure over frequency, and not a mechanism in time."""
        raise NotImplementedError
