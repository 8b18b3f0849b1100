r"""The law of Bouc and Wen: hysteresis with a smooth transition to yielding.

With u the displacement and z the share of the yield force that the hysteretic part carries,

.. math:: \lambda = \alpha k u + (1 - \alpha) k u_y z, \qquad
          u_y \frac{\mathrm{d}z}{\mathrm{d}u} = 1 - |z|^n \left(\gamma + \beta\,\mathrm{sgn}(z\,\mathrm{d}u)\right).

Source: Wen, "Method for random vibration of hysteretic systems", Journal of the Engineering Mechanics Division 102
(1976), equation 4 with A = 1, after Bouc (1967).
"""

from dataclasses import dataclass, field

import numpy as np

from dalembert.errors import InputError
from dalembert.kernels.kernel import inner
from dalembert.ranges import POSITIVE, Range
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.law import law

STIFFNESS, RATIO, YIELD, BETA, GAMMA, EXPONENT = range(6)
"""Columns of the numbers."""
STEPS = 32.0
"""Runge-Kutta steps while the displacement moves by the yield displacement: an error of 1e-8 of the yield force."""
MOST = 2000
"""Runge-Kutta steps from one displacement to the next."""
# Gauss-Legendre quadrature on (0, 1); Abramowitz and Stegun, table 25.4.
_PLACES, _WEIGHTS = (tuple(float(x) for x in own) for own in np.polynomial.legendre.leggauss(8))


@inner
def _power(z, n):
    """|z|^n, in complex arithmetic the analytic continuation of its branch."""
    # Without abs, which would drop the imaginary part: |z|^n is analytic on each side of zero.
    size = z if z.real >= 0.0 else -z
    return size**n if size.real > 0.0 else 0.0 * z


@inner
def _slope(z, side, numbers):
    """dz/d(u/u_y), where displacements grow (side 1) or fall (-1)."""
    turn = side if z.real >= 0.0 else -side
    return 1.0 - _power(z, numbers[EXPONENT]) * (numbers[GAMMA] + turn * numbers[BETA])


@inner
def _to_zero(z, side, numbers):
    """Displacement/u_y after which a falling |z| is zero, ∫ dz/(dz/du): the slope has a kink there."""
    total = 0.0 * z
    for i in range(len(_PLACES)):
        total += 0.5 * _WEIGHTS[i] / _slope(0.5 * (1.0 + _PLACES[i]) * z, side, numbers)
    return -z * total


@inner
def _smooth(z, way, numbers):
    """Runge and Kutta's classical method over a displacement/u_y on which z does not change its sign."""
    side = 1.0 if way.real >= 0.0 else -1.0
    # Steps in displacement, not in time: the law has no rate, and its result must not depend on the number of samples.
    count = min(int(STEPS * abs(way.real)) + 1, MOST)
    h = way / count
    for _ in range(count):
        a = _slope(z, side, numbers)
        b = _slope(z + 0.5 * h * a, side, numbers)
        c = _slope(z + 0.5 * h * b, side, numbers)
        z = z + h * (a + 2.0 * b + 2.0 * c + _slope(z + h * c, side, numbers)) / 6.0
    return z


@law
def bouc_wen(u, v, z, numbers, force):
    """The state: z, and the displacement before."""
    way = (u[0] - z[1]) / numbers[YIELD]
    # z passes zero on the way: there sgn(z du) changes, so that Runge-Kutta steps across it would lose their order. The
    # way to it is a quadrature.
    if way.real * z[0].real < 0.0:
        side = 1.0 if way.real >= 0.0 else -1.0
        first = _to_zero(z[0], side, numbers)
        if first.real * side > 0.0 and first.real * side < way.real * side:
            # z = 0 at this place, which moves with z before: the rest of the way begins there
            z[0] = 0.0 * z[0]
            way = way - first
    z[0] = _smooth(z[0], way, numbers)
    z[1] = u[0]
    ratio = numbers[RATIO]
    force[0] = numbers[STIFFNESS] * (ratio * u[0] + (1.0 - ratio) * numbers[YIELD] * z[0])


@dataclass(frozen=True)
class BoucWen(LawElement):
    r"""Hysteresis with a smooth transition to yielding, between two degrees of freedom, or one and the ground.

    Parameters
    ----------
    name : str
    first : str
        Degree of freedom, such as ``"A.x"``.
    second : str, optional
        The ground if not given; u is the first displacement less the second.
    stiffness : float
        k, before yielding, N/m.
    ratio : float
        α: stiffness after yielding, as part of k, from 0 to 1.
    yield_displacement : float
        :math:`u_y`, m; the hysteretic part carries at most :math:`(1 - \alpha) k u_y (\beta + \gamma)^{-1/n}`.
    beta, gamma : float
        Shape of the loops; :math:`\beta + \gamma > 0`, and :math:`\beta \geq |\gamma|`, so that loops never give
        energy.
    exponent : float
        n, at least 1: how sharp the transition is.

    Raises
    ------
    InputError
        For numbers outside of these ranges.

    Notes
    -----
    Source: Wen, "Method for random vibration of hysteretic systems", Journal of the Engineering Mechanics Division 102
    (1976). Loops of small cycles about a load do not close exactly; this is a property of the model.

    Examples
    --------
    >>> BoucWen("damper", "A.x", stiffness=100.0, ratio=0.1, yield_displacement=0.01).exponent
    1.0
    """

    stiffness: Number = field(kw_only=True, metadata={"unit": "N/m", "range": POSITIVE})
    ratio: Number = field(default=0.0, kw_only=True, metadata={"unit": "", "range": Range(least=0.0, most=1.0)})
    yield_displacement: Number = field(kw_only=True, metadata={"unit": "m", "range": POSITIVE})
    beta: Number = field(default=0.5, kw_only=True, metadata={"unit": ""})
    gamma: Number = field(default=0.5, kw_only=True, metadata={"unit": ""})
    exponent: Number = field(default=1.0, kw_only=True, metadata={"unit": "", "range": Range(least=1.0)})

    law = bouc_wen

    def __post_init__(self) -> None:
        beta, gamma = np.real(self.beta), np.real(self.gamma)
        if not (beta + gamma > 0 and beta >= abs(gamma)):
            raise InputError(
                f"BoucWen {self.name!r}: beta is {beta:g} and gamma is {gamma:g}; expected beta + gamma > 0 and beta "
                "at least |gamma|"
            )

    @property
    def states(self) -> int:
        """z, and the displacement before."""
        return 2
