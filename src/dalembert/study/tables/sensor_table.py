"""The tables of sensors of a study file."""

from collections.abc import Iterable
from typing import Annotated

from pydantic import Field

from dalembert.forward import Sensor
from dalembert.forward.sensors import QUANTITIES, owners
from dalembert.study.text.numbers import Number, Seconds, pair
from dalembert.study.text.table import Read, StudyTable

TimeBounds = Annotated[list[float], Read(pair(Seconds))]
Bounds = Annotated[list[float], Read(pair(Number))]


class SensorTable(StudyTable):
    """Bounds of what is not known of a channel's sensor."""

    delay: TimeBounds | None = Field(None, description="positive where the reading comes late")
    lag: TimeBounds | None = Field(None, description="time constant of a first-order low-pass")
    gain: Bounds | None = None
    offset: Bounds | None = Field(None, description="in the channel's unit")
    at_rest: bool = Field(False, description="whether the channel rests at its first value before the motion begins")

    def _wrong(self) -> list[str]:
        stated = {what: bounds for what, bounds in self.picked(*QUANTITIES).items() if bounds is not None}
        wrong = [
            f"{what} is between {lower:g} and {upper:g}; expected the lower bound first"
            for what, (lower, upper) in stated.items()
            if lower > upper
        ]
        if self.lag is not None and self.lag[0] < 0:
            wrong.append(f"lag may be {self.lag[0]:g} s; expected bounds of zero or more")
        if not stated:
            wrong.append("none of delay, lag, gain and offset is given; expected bounds of at least one")
        return wrong

    @property
    def sensor(self) -> Sensor:
        """The sensor."""
        bounds = {what: ends and tuple(ends) for what, ends in self.picked(*QUANTITIES).items()}
        return Sensor(**bounds, at_rest=self.at_rest)


def reads(sensor: str, channels: Iterable[str]) -> bool:
    """Whether a sensor is that of a channel, or of the component of some."""
    return any(owners([sensor], channel) for channel in channels)
