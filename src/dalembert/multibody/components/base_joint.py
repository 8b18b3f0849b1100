"""What every joint offers, in the plane and in space."""

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from dalembert.arguments import Checked
from dalembert.multibody.components.fields import Number
from dalembert.multibody.kernels.kind import Kind


class Smoothing(NamedTuple):
    """How a joint smooths its Coulomb friction, as tanh(rate / slip).

    ``channel``: output of the joint that has the rate; ``setting``: name of the field that has the ``slip``, which is
    in the ``unit`` of the rate.
    """

    channel: str
    setting: str
    slip: Number
    unit: str


@dataclass(frozen=True)
class BaseJoint(Checked):
    """Base of all joints: a name and two sides."""

    name: str
    a: Any
    b: Any

    kind: ClassVar[Kind]

    @property
    def coordinates(self) -> tuple[Any, ...]:
        """Bodies without mass, one for each coordinate of a joint that the component needs."""
        return ()

    @property
    def smoothing(self) -> Smoothing | None:
        """How the joint smooths Coulomb friction; None without it. The finding ``slip-rate`` judges it."""
        return None

    @property
    def coupled(self) -> "tuple[BaseJoint, str] | None":
        """Joint on whose second side a coupling acts about or along its axis, and the output; None for other joints."""
        return None

    def axis_directions(self, numbers: np.ndarray, integers: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Directions of the axis in the fixed axes, (frames, 3), from its numbers and unknowns (frames, width)."""
        raise NotImplementedError

    @property
    def parts(self) -> dict[str, Kind]:
        """Kinds of parts with separate channels, by the end of their names: ``pin.friction`` has ``torque``."""
        return {}

    def position(self, kind: Kind, numbers: np.ndarray, integers: np.ndarray, x: np.ndarray) -> np.ndarray | None:
        """Where to draw the joint, (frames, 2 or 3), from its unknowns (frames, width); None for none."""
        return None

    def misaligned(
        self, kind: Kind, numbers: np.ndarray, integers: np.ndarray, placed: np.ndarray, closed: np.ndarray
    ) -> str:
        """Say how the joint is closed in another position than the one that is meant, or return an empty string.

        ``placed`` and ``closed`` are its unknowns (width,) before assembly and after it.
        """
        return ""

    @property
    def stated_coordinates(self) -> tuple[str, ...]:
        """Coordinates that the joint leaves free: an initial state may state them, and keeps them otherwise.

        Those in m are named ``"displacement"``, all others are in rad.
        """
        return ()

    def stating(self, coordinate: str, course: Any) -> "BaseJoint":
        """The joint that makes one of these coordinates follow a signal, named ``"pin.angle"``."""
        raise NotImplementedError

    def keeping(
        self, coordinate: str, course: Any, numbers: np.ndarray, integers: np.ndarray, x: np.ndarray
    ) -> "BaseJoint":
        """The joint that makes the change of a coordinate follow a signal, from the joint's numbers and unknowns."""
        return self.stating(coordinate, course)

    @abstractmethod
    def lower(self, lowering: Any) -> None:
        """Write the rows of the kernels."""
