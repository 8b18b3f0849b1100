"""Which instants of a motion to show, and how fast."""

from dataclasses import dataclass

import numpy as np

from dalembert.report.charts.motion.film import Film, slowness

FRAMES = 150
FRAMES_A_SECOND = 25
SHORTEST = 2.0


@dataclass(frozen=True)
class Playback:
    """Frames of a motion for a film.

    Parameters
    ----------
    times : array, shape (frames,)
        Instants shown, in s.
    frames : array of int, shape (frames,)
        Their numbers in the motion.
    seconds : float
        How long the film takes.
    """

    times: np.ndarray
    frames: np.ndarray
    seconds: float

    @classmethod
    def of(cls, times: np.ndarray) -> "Playback":
        """Film of a motion at the given times, as near to 25 frames a second in real time as 150 frames allow.

        Examples
        --------
        >>> film = Playback.of(np.linspace(0, 10, 20_001))
        >>> len(film.frames), film.seconds, film.pace
        (150, 6.0, 'played 1.67 times faster than real')
        """
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
