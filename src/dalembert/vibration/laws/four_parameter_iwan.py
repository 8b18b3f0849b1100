r"""Segalman's four-parameter Iwan model of a joint: sliders whose limits have a distribution by a power law.

Sliders that give way at displacements φ have the density

.. math:: \rho(\varphi) = R\,\varphi^{\chi} \quad (0 < \varphi < \varphi_{max}), \qquad
          \text{and } S\,\delta(\varphi - \varphi_{max}).

At first loading the force is :math:`F_0(u) = K_T u - R\,u^{\chi+2} / ((\chi+1)(\chi+2))` up to
:math:`\varphi_{max}`, and :math:`F_S` beyond. All sliders together remember the displacements at which the motion has
turned, as far as no larger motion has come since (Masing's rules): after a turn at :math:`u_r` with the force
:math:`F_r` the force is :math:`F_r \pm 2 F_0(|u - u_r|/2)`. This is the continuous distribution, without cells.

Source: Segalman, "A four-parameter Iwan model for lap-type joints", Journal of Applied Mechanics 72 (2005), 752-760.
"""

from dataclasses import dataclass, field

from dalembert.kernels.kernel import inner
from dalembert.ranges import NOT_NEGATIVE, POSITIVE, Range
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.law import law

STIFFNESS, EXPONENT, REACH, SOFTENING = range(4)
"""Columns of the numbers: K_T, χ, φ_max, R/((χ + 1)(χ + 2))."""
COUNT, LAST, FIRST = range(3)
"""Places of the state: how many turns there are, the displacement before, and the first turn."""
TURNS = 24
"""Turns that are remembered: where there are more, the two of the smallest motion are forgotten."""


@inner
def _loading(x, numbers):
    """F_0 of a displacement that is not negative."""
    # All sliders slip beyond φ_max: the force stays.
    if x.real >= numbers[REACH].real:
        x = numbers[REACH]
    power = x ** (numbers[EXPONENT] + 2.0) if x.real > 0.0 else 0.0 * x
    return numbers[STIFFNESS] * x - numbers[SOFTENING] * power


@inner
def _branch(u, start, part, numbers):
    """Force gained from one turn to the next: part 1 at first loading, 2 after."""
    way = (u - start) / part
    return part * _loading(way, numbers) if way.real >= 0.0 else -part * _loading(-way, numbers)


@inner
def _forget(u, z, count):
    """Turns that remain where the motion is at u: those that u has passed are forgotten in pairs."""
    while count > 0:
        # Masing's rule of memory: a loop that closes is forgotten with both of its turns, and the branch before it goes
        # on.
        last = z[FIRST + count - 1]
        # A single turn is passed by the opposite displacement, where first loading begins again.
        opposite = -last if count == 1 else z[FIRST + count - 2]
        beyond = u.real <= opposite.real if last.real > opposite.real else u.real >= opposite.real
        if not beyond:
            return count
        z[FIRST + count - 1] = 0.0 * u
        count -= 1
        if count > 0:
            z[FIRST + count - 1] = 0.0 * u
            count -= 1
    return 0


@law
def four_parameter_iwan(u, v, z, numbers, force):
    """The state: turns in their order, of which the last begins the present branch, and the displacement before."""
    count, place, before = int(z[COUNT].real), u[0], z[LAST]
    start = z[FIRST + count - 1] if count > 0 else 0.0 * place
    # The direction changes at the displacement before: a turn, which begins a branch.
    if (place.real - before.real) * (before.real - start.real) < 0.0:
        if count == TURNS:
            z[FIRST + count - 1] = 0.0 * place
            z[FIRST + count - 2] = 0.0 * place
            count -= 2
        z[FIRST + count] = before
        count += 1
    count = _forget(place, z, count)
    total, start = 0.0 * place, 0.0 * place
    # Forces add up over the turns: each branch is the loading curve with twice its size (Masing), the first one as it
    # is.
    for i in range(count):
        total += _branch(z[FIRST + i], start, 1.0 if i == 0 else 2.0, numbers)
        start = z[FIRST + i]
    force[0] = total + _branch(place, start, 1.0 if count == 0 else 2.0, numbers)
    z[COUNT], z[LAST] = count, place


@dataclass(frozen=True)
class FourParameterIwan(LawElement):
    r"""Microslip of a joint (Segalman), between two degrees of freedom, or one and the ground.

    Parameters
    ----------
    name : str
    first : str
        Degree of freedom, such as ``"A.x"``.
    second : str, optional
        The ground if not given; u is the first displacement less the second.
    force_limit : float
        :math:`F_S`, at which all slides, N.
    stiffness : float
        :math:`K_T`, of small motions, N/m.
    exponent : float
        χ, more than -1 and at most 0. The energy of a cycle grows with the amplitude to the power of χ + 3.
    ratio : float
        β, not negative: stiffness of the sliders that give way last, as part of that of all others.

    Raises
    ------
    InputError
        For numbers outside of these ranges.

    Notes
    -----
    Source: Segalman, "A four-parameter Iwan model for lap-type joints", Journal of Applied Mechanics 72 (2005),
    752-760, equations 22 to 30. At most 24 nested turns are remembered.

    Examples
    --------
    >>> joint = FourParameterIwan("joint", "A.x", force_limit=100.0, stiffness=1e6, exponent=-0.5, ratio=1.0)
    >>> float(round(joint.reach, 9))
    0.00015
    """

    force_limit: Number = field(kw_only=True, metadata={"unit": "N", "range": POSITIVE})
    stiffness: Number = field(kw_only=True, metadata={"unit": "N/m", "range": POSITIVE})
    exponent: Number = field(kw_only=True, metadata={"unit": "", "range": Range(above=-1.0, most=0.0)})
    ratio: Number = field(kw_only=True, metadata={"unit": "", "range": NOT_NEGATIVE})

    law = four_parameter_iwan

    @property
    def states(self) -> int:
        """Number of turns, the displacement before, the turns."""
        return FIRST + TURNS

    @property
    def _share(self) -> Number:
        return self.ratio + (self.exponent + 1) / (self.exponent + 2)

    @property
    def reach(self) -> Number:
        r"""Displacement :math:`\varphi_{max}` at which all slides, m (equation 27)."""
        return self.force_limit * (1 + self.ratio) / (self.stiffness * self._share)

    @property
    def numbers(self) -> dict[str, Number]:
        """What the law takes in place of the parameters."""
        density = self.force_limit * (self.exponent + 1) / (self.reach ** (self.exponent + 2) * self._share)
        softening = density / ((self.exponent + 1) * (self.exponent + 2))
        return {"stiffness": self.stiffness, "exponent": self.exponent, "reach": self.reach, "softening": softening}
