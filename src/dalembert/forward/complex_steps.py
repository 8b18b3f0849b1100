"""Whether numbers that depend on a parameter carry its complex step: they are compared with central differences."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from dalembert.errors import InputError
from dalembert.parameters import Parameters

STEP = 1e-30
"""Imaginary step, in scales of the parameter; terms of second order vanish below the rounding of the first."""
DIFFERENCE = 1e-5  # step of the differences, in scales
_SAFETY = 2.0  # factor of the differences' error, which is six times what Taylor's series expects
_AGREES = 1e-6  # relative
DROPPING = "abs, np.abs, .real, np.linalg.norm, np.angle and rounding"
REMEDY = "Use absolute, norm, hypot and atan2 of dalembert, or give derivative='central-differences'"


class Lost(NamedTuple):
    """The entry whose derivative is most wrong: by the complex step, and by differences, per unit of the parameter."""

    entry: int
    by_step: float
    by_differences: float


def lost_step(numbers: Callable[[complex], np.ndarray], scale: float) -> Lost | None:
    """The number that loses a complex step most, None if all carry it.

    Parameters
    ----------
    numbers : callable
        ``numbers(shift)`` -> vector of the numbers where the parameter is moved by a real or an imaginary ``shift``.
    scale : float
        Typical size of the parameter.

    Examples
    --------
    >>> lost_step(lambda shift: np.array([(2.0 + shift) ** 2]), 1.0) is None
    True
    >>> lost_step(lambda shift: np.array([abs(2.0 + shift) + 1j * 0]), 1.0)
    Lost(entry=0, by_step=0.0, by_differences=1.0)
    """
    lifted: Any = np.asarray(numbers(1j * STEP * scale), dtype=complex)
    by_step, here = lifted.imag / (STEP * scale), lifted.real
    slope, error = _differences(numbers, here, DIFFERENCE * scale)
    excess = np.abs(by_step - slope) - error - _AGREES * np.maximum(np.abs(by_step), np.abs(slope))
    excess[~np.isfinite(excess)] = 0.0
    if np.max(excess, initial=0.0) <= 0:
        return None
    worst = int(np.argmax(excess / (np.abs(by_step) + np.abs(slope) + np.finfo(float).tiny)))
    return Lost(worst, float(by_step[worst]), float(f"{slope[worst]:.6g}"))


def _differences(
    numbers: Callable[[complex], np.ndarray], here: np.ndarray, step: float
) -> tuple[np.ndarray, np.ndarray]:
    """Central differences, and a bound of their error: truncation, kinks and rounding."""
    ahead, behind, near, before = (np.real(numbers(k * step)) for k in (1.0, -1.0, 0.5, -0.5))
    wide, slope = (ahead - behind) / (2 * step), (near - before) / step
    kink = np.abs(ahead - 2 * here + behind) / step
    rounding = 16 * np.finfo(float).eps * np.maximum(np.abs(ahead), np.abs(behind)) / step
    return slope, _SAFETY * np.abs(wide - slope) + kink + rounding


def check_steps(
    parameters: Parameters, vector: np.ndarray, numbers: Callable[[np.ndarray], np.ndarray], place: Callable[[int], str]
) -> None:
    """Raise where numbers that depend on parameters lose the complex step of one of them.

    Parameters
    ----------
    parameters : Parameters
    vector : array (parameters,)
        Where they are compared; moved inside the bounds, so that the differences stay there.
    numbers : callable
        Vector of the numbers at a real or complex vector of parameters.
    place : callable
        What an entry of the numbers is, for the message.

    Raises
    ------
    InputError
        It names the parameter and the entry.
    """
    margin = np.minimum(DIFFERENCE * parameters.scale, (parameters.upper - parameters.lower) / 4)
    inside = np.clip(vector, parameters.lower + margin, parameters.upper - margin)
    for name, unit, scale in zip(parameters.names, np.eye(len(vector)), margin / DIFFERENCE, strict=True):
        lost = lost_step(lambda shift, unit=unit: numbers(inside + shift * unit), scale)
        if lost:
            raise InputError(
                f"the derivative of {place(lost.entry)} by {name!r} is {lost.by_step:.6g} by the complex step, but "
                f"{lost.by_differences:.6g} by differences. A function of yours drops the imaginary part, as "
                f"{DROPPING} do. {REMEDY}"
            )
