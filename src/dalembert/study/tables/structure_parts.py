"""Masses and linear springs of a structure, as a study file writes them."""

from collections.abc import Sequence
from dataclasses import dataclass, field

Number = float | complex


@dataclass(frozen=True)
class LumpedMass:
    """A point mass of a structure.

    Parameters
    ----------
    name : str
        Of its node; its degrees of freedom are ``"NAME.x"`` and so on.
    mass : float
        kg; 0 for a node without inertia.
    directions : sequence of str
        Along which it moves.
    """

    name: str
    mass: Number = field(metadata={"unit": "kg"})
    directions: Sequence[str] = ("x",)


@dataclass(frozen=True)
class LinearSpring:
    """A spring with a damper between two degrees of freedom, or one and the ground.

    Parameters
    ----------
    first : str
        Degree of freedom, such as ``"A.x"``, or a node with only one.
    second : str, optional
        The ground if not given.
    stiffness : float
        N/m.
    damping : float
        N s/m.
    loss_factor : float
        Of hysteretic damping, η of the complex stiffness k (1 + i η) under harmonic motion.
    """

    first: str
    second: str | None = None
    stiffness: Number = field(default=0.0, kw_only=True, metadata={"unit": "N/m"})
    damping: Number = field(default=0.0, kw_only=True, metadata={"unit": "N*s/m"})
    loss_factor: Number = field(default=0.0, kw_only=True, metadata={"unit": ""})
