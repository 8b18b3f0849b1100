"""The widget: its state, which the browser shares, and the answers to its sliders."""

from functools import cached_property
from pathlib import Path
from typing import Any

import anywidget
import numpy as np
import traitlets

from dalembert.errors import DalembertError
from dalembert.multibody import Trajectory
from dalembert.parameter import Parameter
from dalembert.report.player import LOOK, module, player_files
from dalembert.report.player.film import film_of
from dalembert.report.sections.motion_sections import measured
from dalembert.tables import shown
from dalembert.widget.sliders import Source

MOST = 200
"""Measured points of a channel that are drawn."""


class MechanismSliders(anywidget.AnyWidget):
    """A mechanism in motion with a slider for each parameter."""

    _esm = module((*player_files(), Path(__file__).with_name("sliders.js")))
    look = traitlets.Dict(LOOK).tag(sync=True)
    parameters = traitlets.List().tag(sync=True)
    asked = traitlets.Dict({"number": 0, "values": {}}).tag(sync=True)
    """Number of a request, and the values of its sliders by name."""
    answered = traitlets.Int(-1).tag(sync=True)
    """Number of the request that film and curves belong to."""
    film = traitlets.Dict({}).tag(sync=True)
    curves = traitlets.Dict({}).tag(sync=True)
    message = traitlets.Unicode("").tag(sync=True)

    def __init__(self, source: Source) -> None:
        self._source = source
        starts = zip(source.parameters, source.parameters.start, strict=True)
        super().__init__(parameters=[_slider(item, float(value)) for item, value in starts])
        self._answer()
        self.observe(lambda _: self._answer(), "asked")

    @property
    def values(self) -> dict[str, float]:
        """Current values of the parameters by name, SI."""
        starts = {item["name"]: item["value"] for item in self.parameters}
        request: Any = self.asked
        return starts | {name: float(value) for name, value in request["values"].items() if name in starts}

    def _answer(self) -> None:
        """Simulate at the values that are asked for."""
        request: Any = self.asked
        number = int(request["number"])
        try:
            motion = self._source.at(self.values)
            answer: dict[str, Any] = {"film": self._film(motion), "curves": self._lines(motion), "message": ""}
        except DalembertError as error:
            answer = {"message": str(error)}
        with self.hold_sync():
            for name, value in {**answer, "answered": number}.items():
                setattr(self, name, value)

    def _film(self, motion: Trajectory) -> dict[str, Any]:
        """The motion, with measured positions of points."""
        data, axes = self._source.data, "xyz"[: len(motion.system.AXES)]
        return film_of(motion.drawing(), {} if data is None else measured(data.channels, data.values, axes))

    def _lines(self, motion: Trajectory) -> dict[str, Any]:
        """Channels over time, with measured points: part of the duration, value."""
        if not self._source.channels:
            return {}
        values = motion.channels(self._source.channels)
        series = dict(zip(self._source.channels, values.T.tolist(), strict=True))
        ranges = {name: [shown(end, digits=3) for end in (min(line), max(line))] for name, line in series.items()}
        return {"series": series, "ranges": ranges, "measured": self._measured}

    @cached_property
    def _measured(self) -> dict[str, list[list[float]]]:
        """Measured points of the channels, the first and every few of them."""
        data, by_channel = self._source.data, {}
        for column, name in enumerate(data.channels if data else ()):
            assert data is not None
            points = np.column_stack([data.coordinate.values / self._source.end, data.values[:, column]])
            points = points[np.isfinite(points).all(axis=1) & (points[:, 0] <= 1.0)]
            by_channel[name] = points[:: max(1, len(points) // MOST)].tolist()
        return by_channel


def _slider(item: Parameter, value: float) -> dict[str, Any]:
    """What the browser needs of a parameter."""
    bounds = {"lower": float(item.lower), "upper": float(item.upper)}
    return {"name": item.name, "unit": item.unit, "value": value, **bounds}
