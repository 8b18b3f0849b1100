"""The frames of a film of a motion, and its speed in words."""

from dataclasses import dataclass

import numpy as np

from dalembert.tables import shown

FRAMES = 150
FRAMES_A_SECOND = 25
SHORTEST = 2.0


def slowness(ratio: float) -> str:
    """Return the speed of a film in words, from its duration relative to that of the motion.
    >>> slowness(800.0), slowness(0.2), slowness(1.01)
    ('800 times slower than real', '5 times faster than real', 'in real time')
    """
    if abs(ratio - 1) < 0.02:
        return "in real time"
    return f"{shown(max(ratio, 1 / ratio), digits=3)} times {'slower' if ratio > 1 else 'faster'} than real"


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
    def pace(self) -> str:
        """The film's speed, in words."""
        return f"played {slowness(self.seconds / max(float(self.times[-1] - self.times[0]), 1e-12))}"
