"""Design: the sensors and durations that determine the parameters best."""

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from dalembert.study.run.duration import Effort, evaluated
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.noise import Noise, noise_of
from dalembert.study.tasks.requirements import needs_parameters, needs_samples, needs_solver, response, unnamed
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.numbers import Frequencies, Number, NumberOfEach, Samples, Times
from dalembert.study.text.table import Read, StudyTable, alternative

Sets = Annotated[
    str | list[list[str]],
    Read(alternative(lambda value: isinstance(value, str), Literal["singles", "pairs", "all"], list[list[str]])),
]


class DesignTable(StudyTable):
    """Rank experiments by how well they determine the parameters, before anything is measured."""

    times: Times | None = Field(None, description="times of a mechanism's samples: a list, or a range")
    frequencies: Frequencies | None = Field(None, description="of a structure's response: a list, or a range")
    channels: list[str] | None = Field(
        None, min_length=1, description="what could be measured on a mechanism or a structure"
    )
    deviations: NumberOfEach | None = Field(
        None, description="standard deviation of the noise: a number, or one for each channel"
    )
    noise: Noise = Field(
        None,
        description="noise model with a value for each parameter, for noise that is correlated or depends on the "
        "response; independent if not given",
    )
    sensors: Sets = Field("singles", description="'singles', 'pairs', 'all', or lists of channels")
    horizons: Samples | None = Field(None, description="ends of the measurement; the last sample if not given")
    criterion: Literal["D", "E"] = Field(
        "D", description="'D': mean semi-axis of the confidence ellipsoid, 'E': the longest"
    )
    at: dict[str, Number] = Field({}, description="values of parameters; first guesses where not given")


class Design(ResultTask):
    """The task ``[design]``."""

    name = "design"
    kind = "dalembert.inverse:Designs"
    rank = 7
    schema = DesignTable
    keeps_responses = True
    needs = (needs_parameters, needs_samples, needs_solver)

    def wrong(self, file: Any) -> list[str]:
        wrong, table = super().wrong(file), file.design
        if table.deviations is None and table.noise is None:
            wrong.append("[design] needs the noise of what could be measured; give deviations or noise")
        return [*wrong, *unnamed(table.at, file.parameters, "[design.at]")]

    def plan(self, study: Study) -> str:
        model = response(study)
        noise_of(study.table, model, self.name)
        names = [channel.name for channel in model.channels]
        return (
            f"ranks experiments that measure {', '.join(names)} by how well they would determine "
            f"{', '.join(study.parameters.names)}, from one simulation with {len(study.parameters)} sensitivities"
        )

    def effort(self, study: Study) -> Effort:
        count = 1 + len(study.parameters)
        return evaluated(response(study), _at(study), count, count)

    def result(self, study: Study, emit: Emit) -> Any:
        from dalembert.inverse import design

        options = study.table.picked("deviations", "sensors", "horizons", "criterion")
        model = response(study)
        return design(model, _at(study), noise=noise_of(study.table, model, self.name), **options)

    def outcome(self, study: Study, designs: Any) -> Outcome:
        """Outcome of designs, with the best one's score and the deviations that it foresees."""
        expected = zip(designs.parameters.names, designs.deviations[0].tolist(), strict=True)
        values = {"score": float(designs.scores[0])} | {f"deviation of {name}": value for name, value in expected}
        return Outcome(study, designs, {"values": values})


def _at(study: Study) -> np.ndarray:
    """Where the sensitivities are taken, (parameters,)."""
    return study.parameters.vector({**study.parameters.mapping(study.parameters.start), **study.table.at})
