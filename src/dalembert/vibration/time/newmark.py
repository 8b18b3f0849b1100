"""Settings of integration in time, and the numbers of its scheme."""

from dataclasses import dataclass

import numpy as np

from dalembert.arguments import Checked, limited
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
    dalembert.errors.InputError: Newmark: steps_per_period is 2; expected a whole number of at least 8
    """

    steps_per_period: int = limited(512, least=8)
    spectral_radius: float | None = limited(None, least=0, most=1)
    periods: int = limited(2000, least=1)
    tolerance: float = limited(1e-9, above=0, below=1)
    stand_in: float = limited(100.0, above=0)

    def scheme(self, omega: float) -> Scheme:
        """Numbers of the method at a frequency, rad/s."""
        step = 2 * np.pi / (omega * self.steps_per_period)
        if self.spectral_radius is None:
            return Scheme(step, 0.25, 0.5, 0.0, 0.0)
        radius = float(self.spectral_radius)
        # Chung and Hulbert (1993), equations 17, 20 and 25: second order, and the least damping of low frequencies for
        # the damping at infinity.
        alpha_m, alpha_f = (2 * radius - 1) / (radius + 1), radius / (radius + 1)
        shift = alpha_f - alpha_m
        return Scheme(step, (1 + shift) ** 2 / 4, 0.5 + shift, alpha_m, alpha_f)
