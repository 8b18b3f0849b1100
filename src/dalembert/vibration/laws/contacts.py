"""Contacts with dry friction, and the laws that they may follow."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError, require_known, shown
from dalembert.ranges import NOT_NEGATIVE, POSITIVE

Number = float | complex
"""A float, or a complex number whose imaginary part is a direction of differentiation."""

PREDICTIONS = ("displacement", "velocity")
AXES = ("x", "y", "z")


@dataclass(frozen=True)
class ElasticSlider(Checked):
    """Contact with springs in series with the slider (Jenkins), and in the normal direction.

    Parameters
    ----------
    tangential_stiffness : float
        N/m.
    normal_stiffness : float, optional
        N/m; needed by contacts with a normal direction.
    gap : float
        Penetration at which the contact closes, m.
    """

    tangential_stiffness: Number = field(metadata={"unit": "N/m", "range": POSITIVE})
    normal_stiffness: Number | None = field(default=None, metadata={"unit": "N/m", "range": POSITIVE})
    gap: Number = field(default=0.0, metadata={"unit": "m"})


@dataclass(frozen=True)
class Iwan(Checked):
    """Several sliders side by side (Iwan), which give way one after the other: microslip.

    Parameters
    ----------
    stiffnesses : sequence of float
        Tangential stiffnesses of the cells, N/m.
    shares : sequence of float
        Parts of the friction limit that the cells carry; they add up to 1.
    normal_stiffness : float, optional
        Of all cells together, N/m.
    gap : float
        m.
    """

    stiffnesses: tuple[Number, ...] = field(metadata={"unit": "N/m", "range": POSITIVE})
    shares: tuple[Number, ...] = field(metadata={"range": NOT_NEGATIVE})
    normal_stiffness: Number | None = field(default=None, metadata={"unit": "N/m", "range": POSITIVE})
    gap: Number = field(default=0.0, metadata={"unit": "m"})

    def __post_init__(self) -> None:
        object.__setattr__(self, "stiffnesses", tuple(self.stiffnesses))
        object.__setattr__(self, "shares", tuple(self.shares))
        total = sum(self.shares)
        if len(self.stiffnesses) != len(self.shares) or not self.shares or abs(total - 1) > 1e-9:
            raise InputError(
                f"Iwan: {len(self.stiffnesses)} stiffnesses and {len(self.shares)} shares that add up to "
                f"{np.real(total):.6g} were given; expected one share for each stiffness, and a sum of 1"
            )


@dataclass(frozen=True)
class Rigid(Checked):
    """Coulomb friction and unilateral contact without compliance, by the dynamic Lagrangian method (DLFT).

    Parameters
    ----------
    penalty : float, optional
        N/m; it scales the prediction, and is no stiffness of the contact. The default is the stiffness of the structure
        behind the contact, with everything else held. Much larger values need more harmonics.
    prediction : {"displacement", "velocity"}
        Predict stuck motion by displacements, with a slider that remembers, or by velocities, without history.
        Velocities are more robust for contacts that carry mass.
    gap : float
        Penetration at which the contact closes, m.

    Notes
    -----
    Sources: Nacivet, Pierre, Thouverez and Jezequel, "A dynamic Lagrangian frequency-time method for the vibration of
    dry-friction-damped systems" (2003); Ma, Li, Fan and Wu, "Friction damping analysis by an accelerated dynamic
    Lagrangian method" (2019).
    """

    penalty: Number | None = field(default=None, metadata={"unit": "N/m", "range": POSITIVE})
    prediction: str = "displacement"
    gap: Number = field(default=0.0, metadata={"unit": "m"})

    def __post_init__(self) -> None:
        require_known("prediction", self.prediction, PREDICTIONS, "Rigid")


Law = ElasticSlider | Iwan | Rigid


@dataclass(frozen=True)
class FrictionContact(Checked):
    """Dry friction between two nodes, or a node and the ground.

    The relative displacement is that of ``first`` less that of ``second``; along the normal it is penetration.

    Parameters
    ----------
    name : str
    first : str
        A node.
    second : str, optional
        Another node; the ground if not given.
    tangential : sequence of str
        One or two directions, ``"x"``, ``"y"`` or ``"z"``.
    normal : str, optional
        Direction in which ``first`` moves into ``second``, such as ``"z"`` or ``"-z"``; if not given, the normal load
        is constant.
    friction : float
        Coefficient of friction, not negative.
    preload : float
        Normal load without any motion, N, not negative. Where static forces press the contact, 0.
    law : ElasticSlider, Iwan or Rigid

    Raises
    ------
    InputError
        For a negative coefficient of friction, preload or stiffness, or directions that make no sense.

    Examples
    --------
    >>> FrictionContact("foot", "A", tangential=("x", "y"), normal="z", friction=0.6, preload=80.0).normal
    'z'
    >>> FrictionContact("foot", "A", friction=-0.6)
    Traceback (most recent call last):
    dalembert.errors.InputError: FrictionContact 'foot': friction is -0.6; expected zero or a positive number
    """

    name: str
    first: str
    second: str | None = None
    tangential: Sequence[str] = field(default=("x",), metadata={"checked": False})
    normal: str | None = None
    friction: Number = field(kw_only=True, metadata={"unit": "", "range": NOT_NEGATIVE})
    preload: Number = field(default=0.0, kw_only=True, metadata={"unit": "N", "range": NOT_NEGATIVE})
    law: Law = field(default=Rigid(), kw_only=True, metadata={"checked": False})

    def __post_init__(self) -> None:
        where = f"contact {self.name!r}"
        _require_law(where, self.law)
        object.__setattr__(self, "tangential", _directions(where, self.tangential))
        if self.first == self.second:
            raise InputError(
                f"{where} is between the node {self.first!r} and itself; expected two nodes, or one and the ground "
                "(second=None)"
            )
        axes = [
            direction.removeprefix("-") for direction in (*self.tangential, *([self.normal] if self.normal else []))
        ]
        if len(self.tangential) not in (1, 2) or len(set(axes)) < len(axes) or not set(axes) <= set(AXES):
            raise InputError(
                f"{where}: the directions are {', '.join(self.tangential) or 'none'}, normal {self.normal}; expected "
                "one or two tangential ones and another one for the normal, if any, each x, y or z"
            )
        if self.normal is not None and not isinstance(self.law, Rigid) and self.law.normal_stiffness is None:
            raise InputError(f"{where} has a normal direction; give its law a normal_stiffness in N/m")


def _require_law(where: str, law: object) -> None:
    if isinstance(law, Law):
        return
    if callable(law) and not isinstance(law, type):
        raise InputError(
            f"{where}: law is a function; expected ElasticSlider, Iwan or Rigid. Functions can be laws without "
            "internal state only (UserElement); a law with internal state, such as friction, cannot be a function"
        )
    raise InputError(f"{where}: law is {shown(law)}; expected ElasticSlider(...), Iwan(...) or Rigid(...)")


def _directions(where: str, directions: object) -> tuple[str, ...]:
    if not isinstance(directions, Sequence) or not all(isinstance(name, str) for name in directions):
        raise InputError(
            f"{where}: tangential is {shown(directions)}; expected names of directions, such as ('x', 'y'). Directions "
            "across the axes need a structure in turned coordinates"
        )
    return tuple(directions)
