"""Losses that grow slower than the square, so that outliers pull less."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dalembert.arguments import is_number
from dalembert.errors import InputError, require_known, shown

Curve = Callable[[np.ndarray], np.ndarray]


LOSSES: dict[str, tuple[Curve, Curve, Curve, float]] = {
    "huber": (
        lambda x: np.where(x <= 1, x**2, 2 * x - 1),
        lambda x: np.minimum(x, 1),
        lambda x: np.where(x <= 1, 1.0, 0.0),
        1.345,
    ),
    "soft-l1": (
        lambda x: 2 * x**2 / (1 + np.sqrt(1 + x**2)),  # 2 (√(1 + x²) − 1) without cancellation
        lambda x: x / np.sqrt(1 + x**2),
        lambda x: (1 + x**2) ** -1.5,
        1.287,
    ),
    "cauchy": (lambda x: np.log1p(x**2), lambda x: x / (1 + x**2), lambda x: (1 - x**2) / (1 + x**2) ** 2, 2.385),
}
"""By name: ϱ(x) of a residual's size over the scale, half its first and second derivative, and the usual scale."""

NAMES = ("linear", *LOSSES)


@dataclass(frozen=True)
class Loss:
    """Loss scale² ϱ(r/scale) of a weighted residual r: its square where it is small, less where it is large."""

    name: str  # {"huber", "soft-l1", "cauchy"}: ϱ(x) is x² up to 1 and 2x − 1 beyond; 2 (√(1 + x²) − 1); ln(1 + x²)
    scale: float  # weighted residual from which one counts as an outlier

    def residual(self, residual: np.ndarray) -> np.ndarray:
        """Residuals whose squares are the losses, with the signs of the weighted residuals, of the same shape."""
        curve = LOSSES[self.name][0]
        return self.scale * np.sign(residual) * np.sqrt(curve(np.abs(residual) / self.scale))

    def slope(self, residual: np.ndarray) -> np.ndarray:
        """Derivative of :meth:`residual`."""
        curve, pull, *_ = LOSSES[self.name]
        x = np.abs(residual) / self.scale
        small = x < 1e-8
        return np.where(small, 1.0, pull(x) / np.sqrt(curve(np.where(small, 1.0, x))))

    def variance(self, residual: np.ndarray, freedom: int) -> float:
        """Factor s² of the covariance s² (JᵀWJ)⁻¹ from the weighted residuals (values,) at the minimum: Σψ²/freedom
        over the square of the mean of ψ', where ψ is half the loss's derivative. Source: P. J. Huber, Robust
        Statistics, 1981, section 7.6.
        """
        _, pull, stiffness, _ = LOSSES[self.name]
        x = np.abs(residual) / self.scale
        mean = float(np.mean(stiffness(x)))
        return float(np.sum((self.scale * pull(x)) ** 2)) / freedom / mean**2 if freedom > 0 and mean > 0 else np.nan

    def influence(self, residual: np.ndarray) -> np.ndarray:
        """Return ψ over the mean of ψ' of weighted residuals (values,): what each contributes to the estimate. In place
        of the residuals it makes the covariance of an estimate with this loss that of least squares. The mean square,
        over the degrees of freedom, is :meth:`variance`.
        """
        _, pull, stiffness, _ = LOSSES[self.name]
        x = np.abs(residual) / self.scale
        return np.sign(residual) * self.scale * pull(x) / np.mean(stiffness(x))


def loss_of(name: str, scale: float | None, *, known: bool) -> Loss | None:
    """Loss by name, None for the square; where deviations are known the scale has a usual value."""
    require_known("loss", str(name), NAMES)
    if name == "linear":
        if scale is not None:
            raise InputError("loss_scale was given, but the loss is 'linear', which has none; leave it out")
        return None
    if scale is None:
        if not known:
            raise InputError(
                f"loss {name!r} needs to know which residuals are large; give the data's deviations, or loss_scale, "
                "the weighted residual from which one counts as an outlier"
            )
        scale = LOSSES[name][3]
    if not is_number(scale) or np.iscomplexobj(scale) or not scale > 0:
        raise InputError(f"loss_scale is {shown(scale)}; expected a positive number")
    return Loss(name, float(scale))
