"""Whether a model is a mechanism in space, and what that changes for all of its tables."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator, ValidationInfo

from dalembert.study.text.numbers import number, read_number, row
from dalembert.study.text.table import Context, checked, problem

IN_SPACE = "space"  # the key of [model] that says so
_EXPECTED = {
    2: "two numbers, along x and y; a mechanism in space has space = true in [model]",
    3: "three numbers, along x, y and z, since the mechanism is in space (space = true)",
}


def is_in_space(model: Any) -> bool:
    """Whether a model, or its table in a document, is a mechanism in space."""
    return (model.get(IN_SPACE) if isinstance(model, Mapping) else getattr(model, IN_SPACE, False)) is True


def gravity_key(axes: int) -> Any:
    """Type of the key of gravity, a number along each axis."""

    def counted(value: Any) -> Any:
        if isinstance(value, list) and len(value) != axes:
            raise problem(f"{value} was given; expected {_EXPECTED[axes]}")
        return value

    return Annotated[row(number("m/s^2"), axes), BeforeValidator(counted)]


def by_joint(derivative: int) -> Any:
    """Read coordinates of joints (0) or their rates (1): lengths for displacements, else angles.

    The name of a joint without a coordinate is an angle: write ``"slide.displacement"``.
    """
    units = {False: ("rad", "rad/s"), True: ("m", "m/s")}

    def read(value: Any, info: ValidationInfo) -> Any:
        if not isinstance(value, Mapping):
            raise problem(f"{value!r} was given; expected a table of joints, such as {{ pin = '30 deg' }}")
        names = info.context.names if isinstance(info.context, Context) else None
        units_here = {
            name: units[str(name).rpartition(".")[2].startswith("displacement") and "." in str(name)][derivative]
            for name in value
        }
        return {name: checked(read_number, number, units_here[name], names) for name, number in value.items()}

    return read


def elsewhere(document: Mapping[str, Any]) -> dict[str, Any]:
    """The document with its model in space instead of in the plane, or the other way round."""
    model = document.get("model")
    return {**document, "model": {**model, IN_SPACE: not is_in_space(model)}} if isinstance(model, Mapping) else {}
