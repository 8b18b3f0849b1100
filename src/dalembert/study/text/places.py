"""Points of a mechanism as a study file writes them: ``"OA.end"``, ``"ground"``, ``"ground(0.3, 0)"``.

In space a position has three numbers: ``"ground(0.3, 0, 1)"``.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any

from pydantic import PlainValidator, ValidationInfo, WithJsonSchema

from dalembert.errors import InputError
from dalembert.study.text.expressions import Expression
from dalembert.study.text.numbers import read_number
from dalembert.study.text.table import Context, problem

NAMES = "x-names"
"""Keyword of the JSON schema where a text is the name of something in the study: what it is."""
_POINT = re.compile(r"([^\W\d][\w-]*)\.([^\W\d][\w-]*)")
_GROUND = re.compile(r"ground\s*\((.*)\)")
_COMMA = re.compile(r",(?![^()]*(?:\([^()]*\)[^()]*)*\))")  # none inside brackets, such as those of atan2(y, x)
_WAYS = "'OA.end', 'ground(0.3, 0)' or [0.3, 0.0]"
_WAYS_IN_SPACE = "'OA.end', 'ground(0.3, 0, 1)', [0.3, 0.0, 1.0] or { position = [0.3, 0.0, 1.0], orientation = {} }"
Position = tuple[float | Expression, ...]


@dataclass(frozen=True)
class Place:
    """Where something stands: at a point of a body, or on the ground. ``body``, ``point``: their names, empty for the
    ground; ``position`` on the ground: (x, y) or (x, y, angle), in space (x, y, z); None: where the other side stands.
    """

    body: str = ""
    point: str = ""
    position: Position | None = None

    def __str__(self) -> str:
        if self.position is None:
            return f"{self.body}.{self.point}" if self.body else "ground"
        return f"ground({', '.join(map(str, self.position))})"


def read_place(value: object, names: Iterable[str] | None = None, *, bare: bool = True, space: bool = False) -> Place:
    """Return the place that a study file states, in the plane or in ``space``; ``bare`` allows ``"ground"`` alone."""
    match value:
        case "ground" if bare:
            return Place()
        case str() if match := _GROUND.fullmatch(value.strip()):
            return _on_ground(_COMMA.split(match[1]), value, names, space)
        case str() if match := _POINT.fullmatch(value.strip()):
            return Place(match[1], match[2])
        case {"x": x, "y": y, **rest} if not rest and not space:
            return _on_ground([x, y], value, names, space)
        case [*numbers]:
            return _on_ground(numbers, value, names, space)
    raise InputError(f"{value!r} was given; expected a point such as {_ways(bare, space)}")


def _on_ground(numbers: list, value: object, names: Iterable[str] | None, space: bool) -> Place:
    if space and len(numbers) != 3:
        raise InputError(f"{value!r} was given; expected x, y and z in m, such as 'ground(0.3, 0, 1)'")
    if len(numbers) not in (2, 3):
        raise InputError(f"{value!r} was given; expected x and y, or x, y and an angle, such as 'ground(0.3, 0)'")
    units = ("m", "m", "m" if space else "rad")
    return Place(position=tuple(read_number(number, unit, names) for number, unit in zip(numbers, units, strict=False)))


def _ways(bare: bool, space: bool) -> str:
    ways = _WAYS_IN_SPACE if space else _WAYS
    return f"'ground', {ways}" if bare else ways


@cache
def place(bare: bool = True, space: bool = False) -> Any:
    """Type of a key that takes a point; ``bare`` allows ``"ground"`` without a position."""

    def read(value: Any, info: ValidationInfo) -> Place:
        names = info.context.names if isinstance(info.context, Context) else None
        try:
            return read_place(value, names, bare=bare, space=space)
        except InputError as error:
            raise problem(str(error)) from None

    schema = {"type": ["string", "array", "object"], "description": f"a point such as {_ways(bare, space)}"}
    schema |= {NAMES: "point"}
    schema |= {"type": ["string", "array"]} if space else {}
    return Annotated[Any, PlainValidator(read), WithJsonSchema(schema)]


@dataclass(frozen=True)
class JointName:
    """A joint that another component refers to, by its name."""

    name: str

    def __str__(self) -> str:
        return self.name


def _read_joint(value: Any) -> JointName:
    if not isinstance(value, str):
        raise problem(f"{value!r} was given; expected the name of a joint, such as 'pin'")
    return JointName(value)


#: Type of a key that takes the name of a joint.
JOINT_KEY = Annotated[
    Any,
    PlainValidator(_read_joint),
    WithJsonSchema({"type": "string", "description": "name of a joint, such as 'pin'", NAMES: "joint"}),
]
