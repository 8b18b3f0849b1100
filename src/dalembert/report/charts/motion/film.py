"""A film of a vibration: its frames, and the controls to play it in a page or a notebook."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from dalembert.report.look import LIGHT


@dataclass(frozen=True)
class Film:
    """What a slider goes through.

    Parameters
    ----------
    labels : sequence of str
        Of the frames.
    seconds : float
        How long it takes once.
    name, unit : str
        Of what the labels are.
    pace : str
        The speed, in words.
    endless : bool
        Whether the end is the beginning again.
    redraw : bool
        Whether more than the lines of a plane figure changes.
    asks : str
        What the slider is for, if not the name.
    frames : sequence of str
        Names of the frames; their numbers if not given.
    y : float
        Height of the controls.
    """

    labels: Sequence[str]
    seconds: float
    name: str
    unit: str
    pace: str = ""
    endless: bool = False
    redraw: bool = True
    asks: str = ""
    frames: Sequence[str] = ()
    y: float = 0

    def controls(self) -> dict[str, Any]:
        """Layout of the play button and the slider, and in ``meta`` what a page with controls of its own needs."""
        still = {"mode": "immediate", "frame": {"duration": 0, "redraw": self.redraw}, "transition": {"duration": 0}}
        duration = 1000 * self.seconds / len(self.labels)
        play = {"frame": {"duration": duration, "redraw": self.redraw}, "transition": {"duration": 0}}
        buttons = [
            {"label": "▶ play", "method": "animate", "args": [None, {**play, "fromcurrent": True}]},
            {"label": "❚❚ pause", "method": "animate", "args": [[None], still]},
        ]
        names = self.frames or [str(number) for number in range(len(self.labels))]
        steps = [
            {"label": label, "method": "animate", "args": [[name], still]}
            for name, label in zip(names, self.labels, strict=True)
        ]
        place: dict[str, Any] = {"xanchor": "left", "y": self.y, "yanchor": "top"}
        return {
            "updatemenus": [
                {
                    **place,
                    "type": "buttons",
                    "direction": "left",
                    "showactive": False,
                    "buttons": buttons,
                    "x": 0,
                    "pad": {"t": 22, "r": 10},
                }
            ],
            "sliders": [
                {
                    **place,
                    "steps": steps,
                    "currentvalue": {
                        "prefix": f"{self.name} ",
                        "suffix": f" {self.unit}" + (f", {self.pace}" if self.pace else ""),
                        "font": {"size": 12, "color": LIGHT.ink},
                    },
                    "ticklen": 0,
                    "minorticklen": 0,
                    "font": {"color": "rgba(0, 0, 0, 0)", "size": 1},
                    "x": 0.26,
                    "len": 0.74,
                    "pad": {"t": 4},
                }
            ],
            "meta": {
                "labels": list(self.labels),
                "seconds": self.seconds,
                "pace": self.pace,
                "before": f"{self.name} ",
                "after": f" {self.unit}".rstrip(),
                "asks": self.asks or self.name,
                "endless": self.endless,
                "redraw": self.redraw,
            },
        }
