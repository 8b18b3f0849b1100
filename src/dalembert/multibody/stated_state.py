"""Initial states by coordinates and rates of joints: constraints that hold during assembly only."""

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dalembert.arguments import is_number
from dalembert.errors import InputError, require_known, shown
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.joint import BaseJoint
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.signals import Constant, Polynomial
from dalembert.multibody.lowered import Lowered

UNITS = {"angle": ("rad", "rad/s"), "displacement": ("m", "m/s")}

Stated = Mapping[tuple[str, str], Number]
"""Values by the names of a joint and of its coordinate."""


@dataclass(frozen=True)
class JointStates:
    """Coordinates and rates of joints that a state has at the start.

    Parameters
    ----------
    coordinates : mapping of (joint, coordinate) to float
        rad and m.
    rates : mapping of (joint, coordinate) to float
        rad/s and m/s.
    """

    coordinates: Stated
    rates: Stated

    def described(self, what: str) -> str:
        """The coordinates, or the rates, in words."""
        at = 0 if what == "coordinates" else 1
        return ", ".join(
            f"{joint}.{name} = {float(np.real(value)):.6g} {UNITS[name][at]}"
            for (joint, name), value in getattr(self, what).items()
        )


NONE = JointStates({}, {})


def joint_values(owner: str, joints: list[Any], given: Mapping[str, Number] | None) -> Stated:
    """Values by joint and coordinate, from those by ``"pin"`` or ``"bearing.displacement"``.

    Raises
    ------
    InputError
        For another joint or coordinate, a joint with several coordinates of which none is named, and what is no number.
    """
    known: dict[str, list[str]] = {joint.name: list(joint.stated_coordinates) for joint in joints}
    names = [name for name, own in known.items() if own]
    found: dict[tuple[str, str], Number] = {}
    if not isinstance(given, Mapping | None):
        raise InputError(f"{owner}: {shown(given)} was given; expected a mapping of joints to numbers")
    for entry, value in (given or {}).items():
        joint, _, coordinate = (entry, "", "") if entry in known else entry.rpartition(".")
        require_known("joint with an angle or a displacement", joint or entry, names, owner)
        own = known[joint]
        if not coordinate and len(own) > 1:
            raise InputError(f"{owner}: joint {joint!r} has {' and '.join(own)}; write '{joint}.{own[0]}', for example")
        require_known("coordinate", coordinate or own[0], own, f"{owner}, joint {joint!r}")
        if not is_number(value):
            raise InputError(f"{owner}, {entry!r}: {shown(value)} was given; expected a finite number")
        found[joint, coordinate or own[0]] = value
    return found


def kept_coordinates(system: Any) -> list[tuple[str, str]]:
    """Return the coordinates that assembly keeps: of joints that close no loop, and are not stated."""
    return _alone(system, system.stated.coordinates)


def closing(system: Any, kept: Stated) -> tuple[Any, list[str]]:
    """Return a copy of the mechanism whose joints hold the stated coordinates and kept ones, with their names."""
    given = {**system.stated.coordinates, **kept}
    return _with(system, {key: Constant(value) for key, value in given.items()}), [".".join(key) for key in given]


def moving(system: Any) -> Any:
    """Return a copy of the mechanism whose joints move at the stated rates.

    Other joints that close no loop are at rest, unless a body states its velocity.
    """
    free = any(value is not None for body in system.bodies for value in body.motion)
    kept = [] if free else _alone(system, system.stated.rates)
    rates = {**dict.fromkeys(kept, 0.0), **system.stated.rates}
    return _with(system, {key: Polynomial((0.0, value)) for key, value in rates.items()})


def _alone(system: Any, stated: Stated) -> list[tuple[str, str]]:
    """Coordinates that are not stated, of joints without which their sides are not connected.

    Those of joints that couplings tie to each other may have to change.
    """
    coupled = {own.joint.name for joint in system.joints for own in joint.coordinates}
    ends = {joint.name: (_side(joint.a), _side(joint.b)) for joint in system.joints}
    found = []
    for joint in system.joints:
        others = [pair for name, pair in ends.items() if name != joint.name]
        reached, (begin, end) = set(), ends[joint.name]
        new = {begin}
        while new:
            reached |= new
            new = {side for pair in others if reached & set(pair) for side in pair} - reached
        if end not in reached and joint.name not in coupled:
            found += [(joint.name, what) for what in joint.stated_coordinates if (joint.name, what) not in stated]
    return found


def _side(side: Any) -> str:
    """Name of a body, or empty for the ground."""
    return side.body.name if isinstance(side, Point) else ""


def _with(system: Any, courses: Mapping[tuple[str, str], Any]) -> Any:
    joints: dict[str, BaseJoint] = {joint.name: joint for joint in system.joints}
    own = copy(system)
    own.joints = [*system.joints, *(joints[name].stating(what, course) for (name, what), course in courses.items())]
    own.stated = NONE
    return own


def like(lowered: Lowered, other: Lowered) -> Lowered:
    """Return arrays of a mechanism with more joints at the frames and coordinates of another one."""
    n = other.structure.n
    x = np.zeros(lowered.structure.size + 1, dtype=other.x.dtype)
    x[:n] = other.x[:n]
    own = {name: getattr(lowered, name).astype(other.x.dtype) for name in ("rates", "v")}
    return replace(lowered, frames=other.frames, x=x, **own)
