"""Bounds of a Chebyshev surrogate."""

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from dalembert.arguments import Checked, limited
from dalembert.errors import require_known
from dalembert.findings import Finding
from dalembert.surrogate import Adaptive, PolynomialBounds, Surrogate, bounds, fit
from dalembert.surrogate.scheme import Scheme
from dalembert.surrogate.unseen import unseen
from dalembert.uncertainty.method import MethodBounds
from dalembert.uncertainty.runs import Runs

# Points of the scan that the optimisation of the polynomial begins with, and most in one direction.
SCANNED, MOST_EACH = 10_000, 257
STARTS = 5  # valleys of the scan that are followed to their bottom
USUAL = 0.01  # tolerance of the adaptive scheme as a part of that of the polynomial
# How far bounds of each kind hold.
RELIABILITY = {
    "optimise": "right within its estimated error",
    "scan": "right within its estimated error but for peaks between the points of the scan",
    "bernstein": "an enclosure of the surrogate, widened by its estimated error",
}


@dataclass(frozen=True)
class Chebyshev(Checked):
    """Bounds of a polynomial that stands for the model, all samples and channels at once.

    Parameters
    ----------
    scheme : TotalDegree, Tensor or Adaptive, optional
        Which terms the polynomial has, and at which points the model is run. Adaptive with a hundredth of ``tolerance``
        if not given.
    tolerance : float
        Largest estimated error of the polynomial, as a part of the largest variation of a sample of the channel over
        the box. A worse polynomial is refused, with the order that would do.
    bounds : {"optimise", "scan", "bernstein"}
        How the polynomial is bounded: by optimisation, by a scan (too narrow by its spacing), or by an enclosure of
        the polynomial in Bernstein form, to which the estimated error of the polynomial is added. It encloses the
        model as far as this estimate holds.
    held_out : int, optional
        Runs that only test the polynomial; ten, or two for each interval with a width if that is more, if not given.

    Notes
    -----
    The estimated error is the larger one of what the decay of the coefficients says and of the largest difference to
    the held-out runs. The error of an enclosure also has its overestimation: by how much it is wider than the extremes
    of the polynomial, which are optimised for this. What lies between the runs unseen is the finding
    "unseen-features". In time a polynomial needs an order of about Δω·T + 8, Δω half the range of a frequency over the
    box in rad/s, T the length of the motion.

    References
    ----------
    Wu, Luo, Zhang & Zhang, "Uncertain dynamic analysis for rigid-flexible mechanisms with random geometry and material
    properties" (2013); Wang, Tian & Hu, "Dynamic simulation of flexible multibody systems with spatial rigid bodies
    and interval parameters" (2016).
    """

    name: ClassVar[str] = "chebyshev"
    scheme: Scheme | None = None
    tolerance: float = limited(1e-4, above=0)
    bounds: Literal["optimise", "scan", "bernstein"] = "optimise"
    held_out: int | None = limited(None, least=0)

    def __post_init__(self) -> None:
        require_known("way to bound a polynomial", self.bounds, RELIABILITY, "Chebyshev, bounds")

    def most(self, runs: Runs) -> int | None:
        return None

    def bound(self, runs: Runs, seed: int) -> MethodBounds:
        box, shape = runs.box, runs.shape
        # One fit serves all samples and channels: outputs are counted sample by sample, and grouped by their channel.
        samples, channels = shape
        surrogate = fit(
            lambda points: runs.values(points).reshape(len(points), -1),
            box.lower,
            box.upper,
            self.scheme or Adaptive(USUAL * self.tolerance),
            seed=seed,
            held_out=self.held_out,
            groups=np.tile(np.arange(channels), samples),
        )
        # Bounds of a polynomial that misses its tolerance would look as exact as others, so that this raises an error.
        surrogate.demand(self.tolerance * surrogate.scale, runs.place, box.names, "optimise")
        # The extremes of the polynomial are needed with Bernstein's enclosure too: they show its overestimation.
        method, points = ("scan", None) if self.bounds == "scan" else ("optimise", _scanned(surrogate))
        bounded = bounds(surrogate.polynomial, box.lower, box.upper, method, points=points, starts=STARTS)
        kind, error, findings = "estimate", surrogate.error, [unseen(surrogate, box.names)]
        if self.bounds == "bernstein":
            enclosed = bounds(surrogate.polynomial, box.lower, box.upper, "bernstein")
            # If |f - p| <= error, the enclosure of p widened by the error encloses f.
            # The extremes of f lie within the error of those of p, so a bound is off by the excess and twice the error.
            excess = np.maximum(bounded.lower - enclosed.lower, enclosed.upper - bounded.upper)
            bounded = PolynomialBounds(enclosed.lower - error, enclosed.upper + error)
            kind, error = "enclosure of the surrogate", 2 * error + np.maximum(excess, 0.0)
            findings += _overestimation(excess, surrogate.scale, self.tolerance)
        sides: list[Any] = [
            None if side is None else side.reshape(*shape, *side.shape[1:]) for side in vars(bounded).values()
        ]
        message = (
            f"The bounds are those of a polynomial of order {surrogate.order} in place of the model, "
            f"{RELIABILITY[self.bounds]}."
        )
        outcome = Finding("surrogate-bounds", "note", {"order": surrogate.order, "bounds": self.bounds}, message)
        return MethodBounds(kind, *sides, outcome=outcome, findings=tuple(findings), error=error.reshape(shape))


def _overestimation(excess: np.ndarray, scale: np.ndarray, tolerance: float) -> list[Finding]:
    """Return a warning if the enclosure is much wider than the polynomial."""
    # A channel without a variation over the box has no scale, and an enclosure without excess.
    parts = np.divide(excess, scale, out=np.zeros_like(excess), where=scale > 0)
    if np.all(parts <= tolerance):
        return []
    worst = float(parts.max())
    message = (
        f"The enclosure by Bernstein coefficients is wider than the extremes of the surrogate by up to {worst:.2g} of "
        "the response's variation."
    )
    advice = 'Use Chebyshev(bounds="optimise") or a smaller box.'
    return [Finding("wide-enclosure", "warning", {"overestimation": worst}, message, advice)]


def _scanned(surrogate: Surrogate) -> int:
    """Points of a scan in each direction: a single box can afford more than a batch of boxes can."""
    # A polynomial of degree n has up to n - 1 extremes along a direction, so a scan needs more points than that.
    degrees = surrogate.polynomial.degrees
    fine = int(SCANNED ** (1 / max(1, np.count_nonzero(degrees))))
    return max(int(degrees.max(initial=0)) + 2, min(fine, MOST_EACH))
