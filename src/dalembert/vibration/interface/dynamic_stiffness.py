r"""The dynamic stiffness of a structure, and its derivative by the excitation frequency ω, as sums of its matrices.

At :math:`s = h\omega`, with the speed Ω of a rotor,

.. math:: Z(s) = K - s^2 M + i s C + i\,\mathrm{sign}(s) D + \Omega (N + i s G).
"""

from typing import Any

import numpy as np

Factors = dict[str, Any]
"""By the names of the matrices, in the order in which a structure has them."""


def factors(s: Any, speed: float) -> Factors:
    """Return the factors of the matrices in Z. ``s``: one frequency, or (orders, 1, ...), rad/s; ``speed``: Ω."""
    return {
        "stiffness": 1.0,
        "mass": -(s**2),
        "damping": 1j * s,
        "loss": 1j * np.sign(s),
        "circulatory": speed,
        "gyroscopic": 1j * s * speed,
    }


def slope_factors(order: Any, s: Any, spin: tuple[float, float]) -> Factors:
    """Return the factors in Z' by ω; matrices that are left out have none. ``order``: h; ``spin``: Ω and Ω'."""
    speed, rate = spin
    return {
        "mass": -2 * order * s,
        "damping": 1j * order,
        "circulatory": rate,
        "gyroscopic": 1j * (order * speed + s * rate),
    }


def combined(weights: Factors, matrices: dict[str, Any]) -> Any:
    """Return the sum of matrices, or of what they give of a motion, with their factors."""
    parts = [weights[name] * matrix for name, matrix in matrices.items() if name in weights]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total
