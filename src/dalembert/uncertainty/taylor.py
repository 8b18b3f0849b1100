"""First-order Taylor bounds."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.arguments import Checked, limited
from dalembert.findings import Finding
from dalembert.uncertainty.method import MethodBounds
from dalembert.uncertainty.runs import Runs
from dalembert.uncertainty.unknown_error import share_of

CURVED = 0.1  # difference at the corners, as a part of the width, from which it is a reason to doubt


@dataclass(frozen=True)
class Taylor(Checked):
    """Bounds of the response linearised in the middle of the box: ``f(x_c) ± Σ |∂f/∂x_i| x_w,i``.

    ``x_c`` are the midpoints and ``x_w`` the half widths of the intervals.

    Parameters
    ----------
    held_out : int
        Runs at random corners of the box. A finding states the largest difference between these and the linear
        response. It is no estimate of the error, as a response may be curved between its corners.
    """

    name: ClassVar[str] = "taylor"
    held_out: int = limited(4, least=0)

    def most(self, runs: Runs) -> int:
        return 1 + len(runs.box) + self.held_out * bool(len(runs.free))

    def bound(self, runs: Runs, seed: int) -> MethodBounds:
        box = runs.box
        at = runs.linearised(box.middle)
        if at is None:
            raise runs.none_succeeded()
        # Derivatives by η = (x - x_c)/x_w: the linear response is largest where each η has the sign of its slope.
        response, slopes = at[0], at[1] * box.radius
        reach = np.sum(np.abs(slopes), axis=2)
        up = np.sign(slopes)
        message = "The response is linearised over the box, which is accurate for small boxes only."
        advice = "Use method 'optimise' or 'chebyshev' for a curved response."
        outcome = Finding("linear-bounds", "note", {}, message, advice)
        finding = self._unknown(reach, self._apart(runs, seed, response, slopes))
        sides = response - reach, response + reach
        return MethodBounds("estimate", *sides, box.points(-up), box.points(up), outcome, (finding,))

    def _unknown(self, reach: np.ndarray, apart: np.ndarray | None) -> Finding:
        message = "The error of the bounds is unknown: one linearised run does not show the curvature of the response."
        if apart is None:
            return Finding("unknown-error", "note", {}, message)
        share = share_of(apart, -reach, reach)
        message += (
            f" At {self.held_out} corners the response differs from the linear one by up to {share:.2g} of the width."
        )
        curved = share > CURVED
        advice = "Use method 'optimise' or 'chebyshev'." if curved else ""
        return Finding("unknown-error", "warning" if curved else "note", {"difference": share}, message, advice)

    def _apart(self, runs: Runs, seed: int, response: np.ndarray, slopes: np.ndarray) -> np.ndarray | None:
        if not (self.held_out and len(runs.free)):
            return None
        # At corners the linear response is farthest from the middle, so curvature shows most.
        eta = np.random.default_rng(seed).choice([-1.0, 1.0], (self.held_out, len(runs.box)))
        apart = np.abs(runs.values(runs.box.points(eta)) - response - np.einsum("scd,nd->nsc", slopes, eta))
        # A run that failed is NaN throughout, so that its first number shows it.
        apart = apart[~np.isnan(apart[:, 0, 0])]
        return apart.max(axis=0) if len(apart) else None
