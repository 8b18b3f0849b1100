"""Multiple shooting in a study file."""

from typing import TYPE_CHECKING

from pydantic import Field, model_validator

from dalembert.study.intervals import Number
from dalembert.study.table import StudyTable, checked

if TYPE_CHECKING:
    from dalembert.inverse import MultipleShooting, State


class StateTable(StudyTable):
    """A parameter of the initial state, as it is later in the motion."""

    channel: str = Field(description="channel of the model whose first value the parameter is")
    lower: Number = Field(description="bound that it keeps throughout the motion")
    upper: Number = Field(description="bound that it keeps throughout the motion")
    rate_of: str | None = Field(None, description="measured channel whose rate of change it is, to begin with")

    def state(self) -> "State":
        """The state."""
        from dalembert.inverse import State

        return State(self.channel, self.lower, self.upper, self.rate_of)


class ShootingTable(StudyTable):
    """Segments that must meet, for chaotic motion."""

    segments: int = Field(8, description="to begin with; they are merged two by two")
    states: dict[str, StateTable] = Field(description="all parameters of the initial state")

    @model_validator(mode="after")
    def _check(self) -> "ShootingTable":
        checked(self.settings)
        return self

    def settings(self) -> "MultipleShooting":
        """The settings of the method."""
        from dalembert.inverse import MultipleShooting

        return MultipleShooting({name: table.state() for name, table in self.states.items()}, self.segments)
