"""Multiple shooting in a study file."""

from typing import TYPE_CHECKING, Annotated

from pydantic import BeforeValidator, Field

from dalembert.study.text.numbers import Number
from dalembert.study.text.table import StudyTable, checked

if TYPE_CHECKING:
    from dalembert.inverse import MultipleShooting, ShootingState


class StateTable(StudyTable):
    """A parameter of the initial state, as it is later in the motion."""

    channel: str = Field(description="channel of the model whose first value the parameter is")
    lower: Number = Field(description="bound that it keeps throughout the motion")
    upper: Number = Field(description="bound that it keeps throughout the motion")
    rate_of: str | None = Field(None, description="measured channel whose rate of change it is, to begin with")

    def state(self) -> "ShootingState":
        """The state."""
        from dalembert.inverse import ShootingState

        return ShootingState(self.channel, self.lower, self.upper, self.rate_of)


class ShootingTable(StudyTable):
    """Segments that must meet, for chaotic motion."""

    segments: int | None = Field(
        None,
        description="to begin with; from the growth of errors if not given, 8 where states are named",
    )
    states: dict[str, StateTable] | None = Field(
        None,
        description="all parameters of the initial state, of a model that cannot begin at a later state; those of a "
        "mechanism follow from its joints",
    )

    def _wrong(self) -> list[str]:
        checked(self.settings)
        return []

    def settings(self) -> "MultipleShooting":
        """The settings of the method."""
        from dalembert.inverse import MultipleShooting

        states = None if self.states is None else {name: table.state() for name, table in self.states.items()}
        return MultipleShooting(states, self.segments)


def _table(entry: object) -> object:
    return {} if entry is True else None if entry is False else entry


Shooting = Annotated[ShootingTable | None, BeforeValidator(_table, json_schema_input_type=ShootingTable | bool | None)]
"""The key ``shooting``: true, or a table."""
