"""First-order Taylor bounds."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.settings import expect
from dalembert.uncertainty.found import Found
from dalembert.uncertainty.runs import Runs


@dataclass(frozen=True)
class Taylor:
    """Bounds of the response linearised in the middle of the box: ``f(x_c) ± Σ |∂f/∂x_i| x_w,i``.

    Parameters
    ----------
    held_out : int
        Runs at random corners of the box; how far the linear response is from them at most is the estimated error.
        None is estimated without them.
    """

    name: ClassVar[str] = "taylor"
    held_out: int = 4

    def __post_init__(self) -> None:
        expect(self, "zero or more", lambda given: given >= 0, "held_out")

    def most(self, runs: Runs) -> int:
        return 1 + len(runs.box) + self.held_out * bool(len(runs.free))

    def bound(self, runs: Runs, seed: int) -> Found:
        box = runs.box
        at = runs.linearised(box.middle)
        if at is None:
            raise runs.none_succeeded()
        response, slopes = at[0], at[1] * box.radius
        reach = np.sum(np.abs(slopes), axis=2)
        up = np.sign(slopes)
        return Found(
            "estimate",
            response - reach,
            response + reach,
            box.points(-up),
            box.points(up),
            self._error(runs, seed, response, slopes),
            "The response is taken as linear over the box, which is good for small boxes only; "
            "'optimise' or 'chebyshev' sees its curvature.",
            not runs.failures,
        )

    def _error(self, runs: Runs, seed: int, response: np.ndarray, slopes: np.ndarray) -> np.ndarray | None:
        if not (self.held_out and len(runs.free)):
            return None
        eta = np.random.default_rng(seed).choice([-1.0, 1.0], (self.held_out, len(runs.box)))
        apart = np.abs(runs.values(runs.box.points(eta)) - response - np.einsum("scd,nd->nsc", slopes, eta))
        apart = apart[~np.isnan(apart[:, 0, 0])]
        return apart.max(axis=0) if len(apart) else None
