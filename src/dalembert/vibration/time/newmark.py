"""Settings of integration in time, and the numbers of its scheme."""

from dataclasses import dataclass

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError
from dalembert.settings import expect
from dalembert.vibration.laws.contacts import require_positive
from dalembert.vibration.time.steps import Scheme


@dataclass(frozen=True)
class Newmark(Checked):
    """Integration in time with equal steps: Newmark's average acceleration, or generalized-alpha.

    Parameters
    ----------
    steps_per_period : int
    spectral_radius : float, optional
        At infinity, in [0, 1], of generalized-alpha (Chung and Hulbert 1993, with forces balanced at the end of each
        step as by Arnold and Bruels 2007): 1 damps nothing, 0 damps the highest frequencies in one step. If not given,
        Newmark's average acceleration (beta 1/4, gamma 1/2), which damps nothing.
    periods : int
        After which a motion that is not periodic yet is given up.
    tolerance : float
        Change of the motion over a period, as part of its size, at which it is periodic.
    stand_in : float
        Rigid contacts are integrated as elastic ones. Their stiffness, as a multiple of the law's penalty: of the
        stiffness of the structure behind them where no penalty is given.

    Raises
    ------
    InputError
        For settings that make no sense.

    Examples
    --------
    >>> Newmark(steps_per_period=2)
    Traceback (most recent call last):
    dalembert.errors.InputError: Newmark: 2 steps of a period were asked for; expected at least 8
    """

    steps_per_period: int = 512
    spectral_radius: float | None = None
    periods: int = 2000
    tolerance: float = 1e-9
    stand_in: float = 100.0

    def __post_init__(self) -> None:
        if self.steps_per_period < 8:
            raise InputError(f"Newmark: {self.steps_per_period} steps of a period were asked for; expected at least 8")
        if self.periods < 1:
            raise InputError(f"Newmark: {self.periods} periods were allowed; expected at least 1")
        in_range = "a number in [0, 1], or none"
        expect(self, in_range, lambda given: given is None or 0 <= given <= 1, "spectral_radius")
        expect(self, "a number between 0 and 1", lambda given: 0 < given < 1, "tolerance")
        require_positive("Newmark: stand_in", "", self.stand_in)

    def scheme(self, omega: float) -> Scheme:
        """Numbers of the method at a frequency, rad/s."""
        step = 2 * np.pi / (omega * self.steps_per_period)
        if self.spectral_radius is None:
            return Scheme(step, 0.25, 0.5, 0.0, 0.0)
        radius = float(self.spectral_radius)
        alpha_m, alpha_f = (2 * radius - 1) / (radius + 1), radius / (radius + 1)
        shift = alpha_f - alpha_m
        return Scheme(step, (1 + shift) ** 2 / 4, 0.5 + shift, alpha_m, alpha_f)
