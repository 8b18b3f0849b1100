r"""The dynamic stiffness of a structure, and its derivative by the excitation frequency ω, as sums of its matrices.

At :math:`s = h\omega`, with the speed Ω of a rotor,

.. math:: Z(s) = K - s^2 M + i s C + i\,\mathrm{sign}(s) D + \Omega (N + i s G).
"""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

Factors = dict[str, Any]
"""By the names of the matrices, in the order in which a structure has them."""
OF_STIFFNESS: dict[str, Callable[[Any, float], Any]] = {
    "stiffness": lambda s, speed: None,
    "mass": lambda s, speed: -(s**2),
    "damping": lambda s, speed: 1j * s,
    "loss": lambda s, speed: 1j * np.sign(s),
    "circulatory": lambda s, speed: speed,
    "gyroscopic": lambda s, speed: 1j * s * speed,
}
"""Factors of the matrices in Z, by s and Ω; None for 1."""
OF_SLOPE: dict[str, Callable[[Any, Any, tuple[float, float]], Any]] = {
    "mass": lambda order, s, spin: -2 * order * s,
    "damping": lambda order, s, spin: 1j * order,
    "circulatory": lambda order, s, spin: spin[1],
    "gyroscopic": lambda order, s, spin: 1j * (order * spin[0] + s * spin[1]),
}
"""Factors in Z' by ω, by h, s and (Ω, Ω'); the others have none."""


def factors(names: Iterable[str], s: Any, speed: float) -> Factors:
    """Return the factors of matrices in Z. ``s``: one frequency, or (orders, 1, ...), rad/s; ``speed``: Ω."""
    return {name: OF_STIFFNESS[name](s, speed) for name in names}


def slope_factors(names: Iterable[str], order: Any, s: Any, spin: tuple[float, float]) -> Factors:
    """Return the factors of matrices in Z' by ω. ``order``: h; ``spin``: Ω and Ω'."""
    return {name: OF_SLOPE[name](order, s, spin) for name in names if name in OF_SLOPE}


def combined(weights: Factors, matrices: dict[str, Any]) -> Any:
    """Return the sum of matrices, or of what they give of a motion, with their factors."""
    parts = [
        matrix if (weight := weights[name]) is None else weight * matrix
        for name, matrix in matrices.items()
        if name in weights
    ]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total
