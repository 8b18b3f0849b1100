"""The controls of an animated figure, in a page or a notebook."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from dalembert.report.look import LIGHT


@dataclass(frozen=True)
class Film:
    """The frames of an animated figure, and the play button and slider that show them. ``labels``: text at the slider
    for each frame; ``seconds``: duration of one pass through all frames, s; ``name``, ``unit``: of the quantity that
    the labels give, such as phase and °; ``pace``: the speed in words, such as "10 times slower"; ``endless``: whether
    the first frame follows the last one, as in a period.
    """

    labels: Sequence[str]
    seconds: float
    name: str
    unit: str
    pace: str = ""
    endless: bool = False

    def controls(self) -> dict[str, Any]:
        """Layout of the play button and the slider, and in ``meta`` what a page with controls of its own needs."""
        still = {"mode": "immediate", "frame": {"duration": 0, "redraw": True}, "transition": {"duration": 0}}
        duration = 1000 * self.seconds / len(self.labels)
        play = {"frame": {"duration": duration, "redraw": True}, "transition": {"duration": 0}}
        buttons = [
            {"label": "▶ play", "method": "animate", "args": [None, {**play, "fromcurrent": True}]},
            {"label": "❚❚ pause", "method": "animate", "args": [[None], still]},
        ]
        steps = [{"label": text, "method": "animate", "args": [[str(k)], still]} for k, text in enumerate(self.labels)]
        place: dict[str, Any] = {"xanchor": "left", "y": 0, "yanchor": "top"}
        shown = {"prefix": f"{self.name} ", "suffix": f" {self.unit}" + (f", {self.pace}" if self.pace else "")}
        menu = {"type": "buttons", "direction": "left", "showactive": False, "buttons": buttons}
        slider = {
            "steps": steps,
            "currentvalue": {**shown, "font": {"size": 12, "color": LIGHT.ink}},
            "ticklen": 0,
            "minorticklen": 0,
            "font": {"color": "rgba(0, 0, 0, 0)", "size": 1},
        }
        return {
            "updatemenus": [{**place, **menu, "x": 0, "pad": {"t": 22, "r": 10}}],
            "sliders": [{**place, **slider, "x": 0.26, "len": 0.74, "pad": {"t": 4}}],
            "meta": {**vars(self), "labels": list(self.labels)},
        }
