"""When a descent of least squares stops: the linear model foresees nothing, or trial points bring nothing."""

from dataclasses import dataclass, field

import numpy as np

from dalembert.optimize.linear_model import LinearModel

WINDOW = 20  # trial points after which progress is judged, at least
PROGRESS = 0.02  # least progress over a window: a fall of the sum of squares by this fraction
# Fraction of the sum of squares. A minimum where the linear model foresees a smaller fall is reached, up to the
# roughness of the residuals.
ROUGH = 1e-4
FAR = 1e-3  # length of a foreseen step, in units of the parameters, that roughness hardly feigns
# Fraction of the sum of squares. Where the linear model foresees a larger fall although the parameters move no more,
# the residuals are rough.
SMOOTH = 1e-8


class Stopped(Exception):
    """The descent stops; the message says why."""

    def __init__(self, message: str, *, success: bool = True, stationary: bool = False, rough: bool = False) -> None:
        super().__init__(message)
        self.success, self.stationary, self.rough = success, stationary, rough


@dataclass
class Stopping:
    """Judge of a descent's progress."""

    # The descent has converged when the linear model foresees a fall of the sum of squares by less than this fraction.
    # This is the square of the relative offset of Bates & Watts, up to a factor of the degrees of freedom. Source:
    # Bates & Watts, A relative offset orthogonality convergence criterion for nonlinear least squares, Technometrics 23
    # (1981).
    gain: float
    window: int  # trial points after which progress is judged
    foreseen: float = np.inf
    length: float = np.inf
    _trials: list[tuple[float, float]] = field(default_factory=list)

    def at(self, residual: np.ndarray, slopes: np.ndarray, down: np.ndarray, up: np.ndarray) -> None:
        """Judge an accepted point by its linear model, the arguments of :class:`LinearModel`."""
        # Columns of norm 1: which directions count as unseen does not depend on the units of the parameters.
        size = np.linalg.norm(slopes, axis=0)
        size[size == 0] = 1.0
        # Its triangular factor has the same steps and falls, and is decomposed sooner.
        factor = np.asarray(np.linalg.qr(np.column_stack([slopes / size, residual]), mode="r"))
        model = LinearModel(factor[:, -1], factor[:, :-1], down * size, up * size)
        step = model.step(0.0)
        self.foreseen, self.length = (
            model.foreseen(step) / float(residual @ residual),
            float(np.linalg.norm(step / size)),
        )
        if self.foreseen < self.gain:
            raise Stopped("converged: the sum of squares falls no more")

    def tried(self, least: float) -> None:
        """Judge the progress after a step; ``least`` is the smallest sum of squares so far."""
        self._trials.append((least, self.foreseen))
        if len(self._trials) <= self.window:
            return
        before, foreseen = self._trials[-1 - self.window]
        fall = 1 - least / before
        if not fall < PROGRESS or self.foreseen < foreseen / 10:
            return
        if self.foreseen < ROUGH:
            raise Stopped("converged: the sum of squares falls no more, as far as its roughness shows", rough=True)
        raise Stopped(
            f"stopped, not converged: the last {self.window} trial points lowered the sum of squares by "
            f"{100 * fall:.2g} %, and the sensitivities foresee {100 * self.foreseen:.2g} %",
            success=False,
        )

    def at_rest(self, smooth: float) -> Stopped:
        """Return how a descent ends whose parameters move no more.

        A foreseen fall above ``smooth`` shows roughness, a fall far away that there is a valley or a plateau instead.
        """
        if self.foreseen < ROUGH or self.length < FAR:
            message = "converged: the parameters move no more"
            return Stopped(message, stationary=True, rough=self.foreseen > smooth)
        return Stopped(
            "stopped, not converged: the parameters move no more, and the sensitivities foresee "
            f"{100 * self.foreseen:.2g} %",
            success=False,
        )
