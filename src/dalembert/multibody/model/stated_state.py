"""Initial states by coordinates and rates of joints: constraints that hold during assembly only."""

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dalembert.arguments import is_number
from dalembert.errors import InputError, require_known, shown
from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.points import Point
from dalembert.multibody.components.signals import Constant, Polynomial
from dalembert.multibody.model.lowered import Lowered

DIRECTION = "direction"
"""Of the line between the points of a distance joint."""

Stated = Mapping[tuple[str, str], Number]
"""Values by the names of a joint and of its coordinate."""


@dataclass(frozen=True)
class JointStates:
    """Coordinates and rates of joints that a state has at the start.

    ``coordinates`` (joint, coordinate): rad and m; ``rates`` (joint, coordinate): rad/s and m/s.
    """

    coordinates: Stated
    rates: Stated

    def described(self, what: str) -> str:
        """The coordinates, or the rates, in words."""
        per = "" if what == "coordinates" else "/s"
        return ", ".join(
            f"{joint}.{name} = {float(np.real(value)):.6g} {'m' if _stem(name) == 'displacement' else 'rad'}{per}"
            for (joint, name), value in getattr(self, what).items()
        )


NONE = JointStates({}, {})


def joint_values(owner: str, joints: list[Any], given: Mapping[str, Number] | None) -> Stated:
    """Values by joint and coordinate, from those by ``"pin"`` or ``"bearing.displacement"``."""
    known: dict[str, list[str]] = {joint.name: list(joint.stated_coordinates) for joint in joints}
    movable = [name for name, own in known.items() if own]
    found: dict[tuple[str, str], Number] = {}
    if not isinstance(given, Mapping | None):
        raise InputError(f"{owner}: {shown(given)} was given; expected a mapping of joints to numbers")
    for entry, value in (given or {}).items():
        joint, _, coordinate = (entry, "", "") if entry in known else entry.rpartition(".")
        require_known("joint with coordinates", joint or entry, movable, owner)
        own = known[joint]
        if not coordinate and len(own) > 1:
            names = f"{', '.join(own[:-1])} and {own[-1]}"
            raise InputError(f"{owner}: joint {joint!r} has {names}; write '{joint}.{own[0]}', for example")
        require_known("coordinate", coordinate or own[0], own, f"{owner}, joint {joint!r}")
        if not is_number(value):
            raise InputError(f"{owner}, {entry!r}: {shown(value)} was given; expected a finite number")
        found[joint, coordinate or own[0]] = value
    return found


def kept_coordinates(system: Any) -> list[tuple[str, str]]:
    """Return the coordinates that assembly keeps: of joints that close no loop, and are not stated."""
    return _alone(system, system.stated.coordinates)


def closing(system: Any, kept: Stated, placed: Lowered) -> tuple[Any, list[str]]:
    """Return a copy of the mechanism whose joints hold the stated coordinates and kept ones, with their names.

    ``placed`` has the poses from which kept ones are measured.
    """
    stated = system.stated.coordinates
    groups = {(joint, _stem(name)) for joint, name in stated}
    free = {key for key in kept if (key[0], _stem(key[1])) not in groups}  # others are measured as the stated ones
    given = {**stated, **kept}
    courses = {key: Constant(value) for key, value in given.items()}
    return _with(system, courses, free, placed), [".".join(key) for key in given]


def moving(system: Any, closed: Lowered) -> Any:
    """Return a copy of the mechanism, ``closed`` in its pose, whose joints move at the stated rates."""
    stated, free = system.stated.rates, any(value is not None for body in system.bodies for value in body.motion)
    rates = {**dict.fromkeys([] if free else _alone(system, stated), 0.0), **stated}
    directed = {joint for joint, name in stated if _stem(name) == DIRECTION}
    measured = {key for key in rates if _stem(key[1]) != DIRECTION or key[0] not in directed}
    return _with(system, {key: Polynomial((0.0, value)) for key, value in rates.items()}, measured, closed)


def _stem(coordinate: str) -> str:
    """What a coordinate is, without the axis; azimuth and elevation are a direction."""
    return DIRECTION if coordinate in ("azimuth", "elevation") else coordinate.partition("_")[0]


def _alone(system: Any, stated: Stated) -> list[tuple[str, str]]:
    """Return coordinates that are not stated, of joints without which their sides are not connected. Those of joints
    that couplings tie to each other may have to change. A point mass does not turn, so a joint that holds only a point
    mass to the rest has no angle of its bodies to keep.
    """
    coupled = {own.joint.name for joint in system.joints for own in joint.coordinates}
    turning = {body.name for body in system.bodies if body.has_axes}
    ends = {joint.name: (_side(joint.a), _side(joint.b)) for joint in system.joints}
    found = []
    for joint in system.joints:
        others = [pair for name, pair in ends.items() if name != joint.name]
        begin, end = ends[joint.name]
        reached = _reached(begin, others)
        if end in reached or joint.name in coupled:
            continue
        outer = begin if "" in _reached(end, others) else end
        found += [
            (joint.name, what)
            for what in joint.stated_coordinates
            if (joint.name, what) not in stated and (outer in turning or _stem(what) not in ("angle", "rotation"))
        ]
    return found


def _reached(side: str, pairs: list[tuple[str, str]]) -> set[str]:
    """Sides that are connected with one."""
    reached, new = set(), {side}
    while new:
        reached |= new
        new = {side for pair in pairs if reached & set(pair) for side in pair} - reached
    return reached


def _side(side: Any) -> str:
    """Name of a body, or empty for the ground."""
    return side.body.name if isinstance(side, Point) else ""


def _with(system: Any, courses: Mapping[tuple[str, str], Any], kept: set[tuple[str, str]], at: Lowered) -> Any:
    """Return a copy of the mechanism whose joints follow these courses, ``kept`` ones from the pose that is given."""
    joints: dict[str, BaseJoint] = {joint.name: joint for joint in system.joints}

    def following(name: str, what: str, course: Any) -> BaseJoint:
        if (name, what) not in kept:
            return joints[name].stating(what, course)
        kind, row = at.structure.rows[name]
        numbers, integers = at.data[kind][row], at.structure.meta[kind][row]
        return joints[name].keeping(what, course, numbers, integers, at.x[at.structure.index[kind][row]])

    own = copy(system)
    own.joints = [*system.joints, *(following(*key, course) for key, course in courses.items())]
    own.stated = NONE
    return own


def like(lowered: Lowered, other: Lowered) -> Lowered:
    """Return arrays of a mechanism with more joints at the frames and coordinates of another one."""
    n = other.structure.n
    x = np.zeros(lowered.structure.size + 1, dtype=other.x.dtype)
    x[:n] = other.x[:n]
    own = {name: getattr(lowered, name).astype(other.x.dtype) for name in ("rates", "v")}
    return replace(lowered, frames=other.frames, x=x, **own)
