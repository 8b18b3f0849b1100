"""A study that was read and checked: its model, data and task, ready to run."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from dalembert.errors import DataError, InputError, ModelError, SolveError, require_known
from dalembert.forward import Checkpoint, Executor, ForwardModel, Recorded, on_cluster
from dalembert.notebook_display import Displayed
from dalembert.parameters import Parameters
from dalembert.study.tables.builder import FunctionBuilder, SystemBuilder
from dalembert.study.tables.data_table import DataTable
from dalembert.study.tables.experiments import ExperimentTable, measured_channels
from dalembert.study.tables.inputs import MeasuredInput
from dalembert.study.tables.parameters import ParameterTable, parameters_of
from dalembert.study.tables.structure_builder import StructureBuilder
from dalembert.study.tables.study_file import StudyFile
from dalembert.study.text.table import StudyTable, naming, placed

if TYPE_CHECKING:
    from dalembert.data import Bands, Measurements
    from dalembert.multibody import Trajectory
    from dalembert.vibration import HarmonicBalance
    from dalembert.vibration.balance.equations import Equations


def _plain(value: Any) -> Any:
    """A table and what is in it as JSON can hold it, without the keys that the file leaves out."""
    if isinstance(value, StudyTable):
        stated = {name: getattr(value, name) for name in type(value).model_fields if name in value.model_fields_set}
        return _plain({name: entry for name, entry in stated.items() if entry is not None})
    if isinstance(value, Mapping):
        return {str(name): _plain(entry) for name, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return value if isinstance(value, (int, float, str)) else str(value)


def _watched(file: StudyFile) -> Iterator[str]:
    for table in file.tasks.values():
        yield from getattr(table, "observe", None) or ()
        yield from (channel.partition(" ")[0] for channel in getattr(table, "channels", None) or ())
    yield from (channel.partition(" ")[0] for channel in measured_channels(file))


def _refuse_outside(files: str, times: np.ndarray) -> None:
    if files and times[0] < 0:
        raise DataError(
            f"{files}: the times reach from {times[0]:g} to {times[-1]:g} s, and the motion begins at 0 s; shift the "
            "times in the file so that 0 s is where the motion begins, or keep those from there on by between in the "
            "study file"
        )
    if files and times[-1] == 0:
        raise DataError(f"{files}: the last of the times is 0 s; expected samples of a motion of some duration")


@dataclass(frozen=True)
class Study(Displayed):
    """A study file, understood.

    Parameters
    ----------
    path : Path
        The file.
    content : bytes
        What it holds.
    file : StudyFile
        Its tables, checked.
    files : mapping of str to Path
        The other files that it names.
    name : str
        Name of its run folder.
    checkpoint : Checkpoint, optional
        Where the answers of its models are kept.
    executor : str or distributed.Client, optional
        Where batches of its models are computed.
    data_table : DataTable, optional
        Of the experiment that the study is: inputs without a file are in its file.
    """

    NOTEBOOK: ClassVar[str] = "dalembert.study.notebook:html_of"

    path: Path
    content: bytes
    file: StudyFile
    files: Mapping[str, Path]
    name: str
    checkpoint: Checkpoint | None = field(default=None, repr=False, compare=False)
    executor: Executor = field(default=None, repr=False, compare=False)
    data_table: DataTable | None = field(default=None, repr=False, compare=False)

    @property
    def title(self) -> str:
        return self.file.study.title or self.name

    @property
    def task(self) -> str:
        """Name of the task, for example identify."""
        return next(iter(self.file.tasks))

    @property
    def table(self) -> Any:
        """The task's table."""
        return self.file.tasks[self.task]

    @cached_property
    def parameters(self) -> Parameters:
        return parameters_of(self.file.parameters, self.file.prior_correlations)

    @property
    def settings(self) -> dict[str, Any]:
        """All that the file says, in SI units, as JSON can hold it."""
        parameters = {item.name: asdict(item) for item in self.parameters.declared}
        for name, entries in parameters.items():
            parameters[name] = {key: entry for key, entry in entries.items() if entry is not None and key != "name"}
        return _plain(self.file) | {"parameters": parameters}

    @property
    def has_system(self) -> bool:
        """Whether the model is a mechanism, not a structure or a forward model of another kind."""
        return self.file.model.forward is None and not self.file.vibrates

    @cached_property
    def builder(self) -> Callable[..., Any]:
        """The model as a function from parameters to a System or a VibrationSystem."""
        model = self.file.model
        if model.function is not None:
            arguments = model.resolved_arguments
            values = {**self.parameters.mapping(self.parameters.start), **arguments}
            function = model.function.fitting(**values)
            return FunctionBuilder(function, arguments, self.file.vibrates, self.inputs, self.file.constants)
        if model.is_structure:
            return StructureBuilder(model, self.file.constants, tuple(_watched(self.file)))
        return SystemBuilder(model, self.file.constants, self.inputs)

    @cached_property
    def inputs(self) -> "dict[str, MeasuredInput]":
        """The measured inputs, by name."""
        if self.data_table is None and self.file.experiments and self.file.inputs:
            return self.variant(self.file.experiments[0]).inputs
        data_table = self.data_table or self.file.data
        measured = {name: table.read(name, data_table) for name, table in self.file.inputs.items()}
        for item in measured.values():
            item.check_interpolation(self.file.model)
        return measured

    def variant(self, table: ExperimentTable) -> "Study":
        """The study as it is in one of its experiments."""
        shared = self.file.inputs
        inputs = {**shared, **{name: override.over(shared[name]) for name, override in table.inputs.items()}}
        varied = self.varied(table.constants, table.arguments, table.parameters(self.file.parameters))
        return replace(varied._with(inputs=inputs), data_table=table)

    @property
    def solver(self) -> Any:
        """The integrator that the file chooses."""
        return self.file.solver.settings()

    @property
    def balance(self) -> "HarmonicBalance":
        """How responses over frequency are balanced."""
        from dalembert.vibration import HarmonicBalance

        settings = self.file.harmonic_balance
        return HarmonicBalance() if settings is None else settings.settings()

    def system(self, vector: np.ndarray | None = None) -> Any:
        """The mechanism or the structure at a parameter vector (parameters,), by default at the first guesses."""
        with naming("model"):
            return self.builder(**self.parameters.mapping(self.parameters.start if vector is None else vector))

    def equations(self) -> "Equations":
        """The structure's equations at the first guesses; what nothing holds is found here."""
        from dalembert.vibration.balance.equations import chosen_solver, equations
        from dalembert.vibration.interface.lowering import lower

        system = self.system()
        balance = self.balance.keeping(system.highest_harmonic).first()
        with naming("model"):
            solver = chosen_solver(lower(system), balance)
            result = equations(system, replace(balance, solver=solver))
        if result.by_receptances:
            with placed(self.file.model.holding, SolveError):
                result.contacts_stuck.reference  # noqa: B018
            return result
        result.lowered.coordinates  # noqa: B018 (contacts that cannot be told apart are told as such)
        with placed(self.file.model.holding, ModelError):
            result.condensation  # noqa: B018
        return result

    def along(self, name: str) -> Callable[..., Any]:
        """The model as a function of one parameter, the others at their first guesses."""
        builder, fixed = self.builder, self.parameters.mapping(self.parameters.start)
        return lambda **given: builder(**{**fixed, name: given[name]})

    def motion(self, end: float, vector: np.ndarray | None = None, times: np.ndarray | None = None) -> "Trajectory":
        """The mechanism's motion until ``end`` (s) at a parameter vector."""
        from dalembert.multibody import simulate

        self.require_inputs(end)
        return simulate(self.system(vector), end, solver=self.solver, times=times, most_steps=np.inf)

    def forward(self, channels: Sequence[str], samples: np.ndarray) -> ForwardModel:
        """The model between parameters and channels, at samples of its coordinate."""
        forward = self._forward(channels, samples)
        if self.file.model.forward is not None:
            with placed(self._named_in):
                names = [channel.name for channel in forward.channels]
                for name in channels:
                    require_known("channel", name, names)
        else:
            self.system()  # what is wrong with the model itself is told as such
            with placed(self._named_in):
                forward.channels  # noqa: B018 (an unknown one is found here)
            forward.fingerprint  # noqa: B018 (and what cannot be assembled here)
        model = on_cluster(forward, self.executor)
        if self.checkpoint is None:
            return model
        varied = _plain({"constants": self.file.constants, "arguments": self.file.model.arguments})
        return Recorded(model, self.checkpoint, json.dumps(varied, sort_keys=True))

    @property
    def _named_in(self) -> str:
        places = [f"[{self.task}], channels"] if getattr(self.table, "channels", None) else []
        places += [f"[{name}], columns" for name in ("data", "bands") if getattr(self.file, name) is not None]
        return " or ".join(places) or "[[experiments]], columns"

    @property
    def _measured_in(self) -> str:
        tables = [self.file.data, self.file.bands, *self.file.experiments]
        return " or ".join(dict.fromkeys(str(table.file) for table in tables if table is not None))

    def _forward(self, channels: Sequence[str], samples: np.ndarray) -> ForwardModel:
        if self.has_system:
            from dalembert.multibody import TimeResponse

            if len(samples) and not getattr(self.table, "times", None):
                _refuse_outside(self._measured_in, samples)
            if len(samples):
                self.require_inputs(float(samples[-1]))
            with placed(f"[{self.task}], at") if getattr(self.table, "at", None) is not None else nullcontext():
                response: Any = TimeResponse(self.builder, self.parameters, channels, samples, solver=self.solver)
            return response
        if self.file.vibrates:
            from dalembert.vibration import FrequencyResponse

            curve: Any = FrequencyResponse(self.builder, self.parameters, channels, samples, self.balance)
            return curve
        reference = self.file.model.forward
        assert reference is not None  # or there is a system
        arguments = self.file.model.resolved_arguments
        model = reference.fitting(self.parameters, **arguments)(self.parameters, **arguments)
        if not isinstance(model, ForwardModel):
            raise InputError(
                f"{reference} returned a {type(model).__name__}; expected a ForwardModel such as PythonModel"
            )
        return model

    def require_inputs(self, end: float) -> None:
        """Refuse inputs that do not last as long as a motion until ``end`` (s)."""
        for measured in self.inputs.values():
            measured.require(end)

    def varied(
        self,
        constants: Mapping[str, float],
        arguments: Mapping[str, Any],
        parameters: Mapping[str, ParameterTable] | None = None,
    ) -> "Study":
        """The same study with other constants, other arguments of the model's function, and other parameters."""
        model = self.file.model.model_copy(update={"arguments": {**self.file.model.arguments, **arguments}})
        parameters = self.file.parameters if parameters is None else parameters
        return self._with(constants={**self.file.constants, **constants}, model=model, parameters=parameters)

    def _with(self, **tables: Any) -> "Study":
        return replace(self, file=self.file.model_copy(update=tables))

    def data(self) -> "Measurements":
        """The measured data."""
        if self.file.data is None:
            raise InputError(f"{self.path}: there is no [data] table")
        return self.file.data.read()

    def bands(self) -> "Bands":
        """The bands."""
        if self.file.bands is None:
            raise InputError(f"{self.path}: there is no [bands] table")
        return self.file.bands.read()

    def with_seed(self, seed: int) -> "Study":
        """The same study with another seed."""
        if "seed" not in type(self.table).model_fields:
            raise InputError(f"a seed was given, but [{self.task}] draws no random numbers; leave it out")
        return self._with(**{self.task: self.table.model_copy(update={"seed": seed})})
