"""A film of a motion: its frames, and the controls to play it in a page or a notebook."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dalembert.report.look import LIGHT
from dalembert.tables import shown


@dataclass(frozen=True)
class Film:
    """The frames of an animated figure, and the play button and slider that show them. ``labels``: text at the slider
    for each frame; ``seconds``: duration of one pass through all frames, s; ``name``, ``unit``: of the quantity that
    the labels give, such as time and s; ``pace``: the speed in words, such as "10 times slower"; ``endless``: whether
    the first frame follows the last one, as in a period; ``redraw``: whether plotly draws each frame anew: False is
    faster and suffices if only lines of a plane figure change; with other changes the figure stays as it was; ``asks``:
    what the slider is for, for screen readers, ``name`` if not given; ``frames``: names of the plotly frames, their
    numbers from 0 if not given; ``y``: vertical position of the controls, as a part of the plot's height from its lower
    edge.
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
        before, after = f"{self.name} ", f" {self.unit}"
        shown = {"prefix": before, "suffix": after + (f", {self.pace}" if self.pace else "")}
        menu = {"type": "buttons", "direction": "left", "showactive": False, "buttons": buttons}
        slider = {
            "steps": steps,
            "currentvalue": {**shown, "font": {"size": 12, "color": LIGHT.ink}},
            "ticklen": 0,
            "minorticklen": 0,
            "font": {"color": "rgba(0, 0, 0, 0)", "size": 1},
        }
        kept = {key: getattr(self, key) for key in ("seconds", "pace", "endless", "redraw")}
        words = {"before": before, "after": after.rstrip(), "asks": self.asks or self.name}
        return {
            "updatemenus": [{**place, **menu, "x": 0, "pad": {"t": 22, "r": 10}}],
            "sliders": [{**place, **slider, "x": 0.26, "len": 0.74, "pad": {"t": 4}}],
            "meta": {"labels": list(self.labels), **kept, **words},
        }


def slowness(ratio: float) -> str:
    """Return the speed of a film in words, from its duration relative to that of the motion.
    >>> slowness(800.0), slowness(0.2), slowness(1.01)
    ('800 times slower than real', '5 times faster than real', 'in real time')
    """
    if abs(ratio - 1) < 0.02:
        return "in real time"
    return f"{shown(max(ratio, 1 / ratio), digits=3)} times {'slower' if ratio > 1 else 'faster'} than real"


FRAMES = 150
FRAMES_A_SECOND = 25
SHORTEST = 2.0


@dataclass(frozen=True)
class Playback:
    """Frames of a motion for a film of ``seconds``: the ``times`` (frames,) shown, s, and their numbers in the motion,
    ``frames`` (frames,).
    """

    times: np.ndarray
    frames: np.ndarray
    seconds: float

    @classmethod
    def of(cls, times: np.ndarray) -> "Playback":
        """Return the film of a motion at times, s, as near to 25 frames a second in real time as 150 frames allow."""
        span = float(times[-1] - times[0])
        seconds = min(max(span, SHORTEST), FRAMES / FRAMES_A_SECOND)
        wanted = np.linspace(times[0], times[-1], max(2, round(seconds * FRAMES_A_SECOND)))
        after = np.searchsorted(times, wanted).clip(1, max(len(times) - 1, 1))
        if len(times) == 1:
            return cls(times, np.array([0]), seconds)
        nearer = np.where(wanted - times[after - 1] <= times[after] - wanted, after - 1, after)
        frames = np.unique(nearer)
        return cls(times[frames], frames, seconds)

    @property
    def labels(self) -> list[str]:
        """Time of each frame, as text."""
        decimals = max(0, 2 - int(np.floor(np.log10(max(self.times[-1] - self.times[0], 1e-12)))))
        return [f"{time:.{decimals}f}" for time in self.times]

    @property
    def pace(self) -> str:
        """The film's speed, in words."""
        return f"played {slowness(self.seconds / max(float(self.times[-1] - self.times[0]), 1e-12))}"

    @property
    def film(self) -> Film:
        """The film of these frames."""
        numbers, asks = [str(frame) for frame in self.frames], "Time in seconds"
        return Film(self.labels, self.seconds, "t =", "s", self.pace, asks=asks, frames=numbers, y=-0.16, redraw=False)
