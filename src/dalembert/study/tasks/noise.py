"""Noise models of measured channels in a study file."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from dalembert.errors import InputError, unknown
from dalembert.study.tables.posing import channel_units_of
from dalembert.study.text.numbers import Number, Seconds, wrong_units
from dalembert.study.text.table import StudyTable, checked

if TYPE_CHECKING:
    from dalembert.inverse import Likelihood, NoiseModel

Model = Literal["known", "constant", "proportional", "mixed", "autoregressive", "ornstein-uhlenbeck"]


class DeviationTable(StudyTable):
    """The standard deviation of correlated noise."""

    model: Literal["known", "constant", "proportional", "mixed"] = Field("constant", description="what it depends on")
    deviation: Number | list[Number] | None = Field(None, description="constant part: its value, or its two bounds")
    relative: float | list[float] | None = Field(None, description="part of the response: its value, or its two bounds")


class ChannelNoiseTable(StudyTable):
    """The noise of a channel, which is estimated with the parameters."""

    model: Model = Field(description="what describes the noise")
    local: bool = Field(False, description="whether each of several experiments has its noise parameters")
    deviation: Number | list[Number] | DeviationTable | None = Field(
        None,
        description="standard deviation: its value, or its two bounds; of correlated noise also a table",
    )
    relative: float | list[float] | None = Field(
        None, description="deviation as a part of the response: its value, or its two bounds"
    )
    order: int | None = Field(None, ge=0, description="of autoregressive noise; chosen by AICc if not given")
    partial: list[float] | None = Field(None, description="fixed partial autocorrelations of autoregressive noise")
    time: Seconds | list[Seconds] | None = Field(
        None, description="correlation time of ornstein-uhlenbeck noise: its value, or its two bounds"
    )

    def _wrong(self) -> list[str]:
        checked(self.settings)
        return []

    def settings(self) -> "NoiseModel":
        """The noise model."""
        from dalembert.inverse.noise.models.noise_catalogue import from_table

        return from_table(self._settings())

    def _settings(self) -> dict[str, Any]:
        plain = self.picked(*(key for key in type(self).model_fields if key in self.model_fields_set))
        if isinstance(self.deviation, DeviationTable):
            settings = self.deviation.picked(*self.deviation.model_fields_set)
            plain["deviation"] = {"model": self.deviation.model, **settings}
        return {name: value for name, value in plain.items() if value is not None}


class NoiseTable(ChannelNoiseTable):
    """The noise of all channels, or of some."""

    model: Model | None = Field(None, description="what describes the noise of all channels that have no table")  # type: ignore[assignment]
    channels: dict[str, ChannelNoiseTable] | None = Field(
        None, description="noise of single channels, by name; the others have that of the data, or a constant one"
    )

    def _wrong(self) -> list[str]:
        if self.model is not None and self.channels is not None:
            return ["model and channels exclude each other; give each channel its table, or one model for all"]
        if self.channels is not None:
            return []
        if self.model is None:
            return ["the key 'model' is missing; expected it, or the table channels"]
        return super()._wrong()

    def noise(self) -> Any:
        """The noise as :func:`~dalembert.identify` and :func:`~dalembert.sample` take it."""
        if self.channels is None:
            return self.settings()
        return {name: table.settings() for name, table in self.channels.items()}


def _table(entry: object) -> object:
    return {"model": entry} if isinstance(entry, str) else entry


Noise = Annotated[NoiseTable | None, BeforeValidator(_table, json_schema_input_type=NoiseTable | Model | None)]
"""The key ``noise``: the name of a noise model, or a table."""


def noise_of(table: Any, model: Any, place: str) -> Any:
    """The noise of a task's table as functions take it; None if there is none.

    Parameters
    ----------
    table : StudyTable
        With the key ``noise``.
    model : ForwardModel or sequence of Experiment
    place : str
        Name of the table.
    """
    if table.noise is None:
        return None
    units = channel_units_of(model)
    tables = table.noise.channels or dict.fromkeys(units, table.noise)
    for sentence in wrong_units(tables, units, f"[{place}.noise]"):
        raise InputError(sentence)
    return table.noise.noise()


def likelihood_of(table: Any, model: Any, data: Any, weights: Any, place: str, *, open_orders: bool) -> "Likelihood":
    """The likelihood that a task's table poses, without a simulation.

    Parameters
    ----------
    table, model, place
        As in :func:`noise_of`.
    data : Measurements or None
    weights : list, mapping or None
        As functions take them.
    open_orders : bool
        Whether an order that is not given will be chosen; it counts as 0.
    """
    from dalembert.inverse import likelihood

    noise = noise_of(table, model, place)
    if open_orders and noise is not None:
        noise = (
            {name: _closed(model_here) for name, model_here in noise.items()}
            if isinstance(noise, Mapping)
            else _closed(noise)
        )
    return likelihood(model, data, noise=noise, weights=weights)


def _closed(noise: "NoiseModel") -> "NoiseModel":
    return replace(noise, order=0) if getattr(noise, "order", 0) is None else noise


def wrong_noise(table: Any, place: str, channels: Collection[str]) -> list[str]:
    """Sentences about the noise of a task's table that cannot be; ``place`` is the name of that table."""
    if table.noise is None:
        return []
    names = table.noise.channels if channels and table.noise.channels else ()
    where = f"[{place}.noise], channels"
    wrong = [unknown("channel", name, channels, where) for name in names if name not in channels]
    if table.weights is not None:
        wrong.append(f"[{place}.noise] cannot be used with weights, which follow from it; leave one of them out")
    if getattr(table, "loss", "linear") != "linear":
        wrong.append(f"[{place}.noise] cannot be used with the loss {table.loss!r}; leave one of them out")
    if getattr(table, "shooting", None) is not None:
        wrong.append(f"[{place}.noise] cannot be used with [{place}.shooting]; leave one of them out")
    return wrong
