"""The function from parameters to a System that a study file's model is."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from dalembert.errors import InputError
from dalembert.study.components import KindTable
from dalembert.study.expressions import Expression
from dalembert.study.functions import FunctionReference
from dalembert.study.model_table import ModelTable
from dalembert.study.places import Place

if TYPE_CHECKING:
    from dalembert.multibody import System

Values = Mapping[str, Any]


@dataclass(frozen=True)
class SystemBuilder:
    """A model written as data, called like any builder: ``builder(theta1=0.7, theta2=0.5)``.

    Numbers may be complex; they pass from a parameter to a component through arithmetic alone.

    Parameters
    ----------
    model : ModelTable
    constants : mapping of str to float or Expression
    """

    model: ModelTable
    constants: Mapping[str, float | Expression]

    def __call__(self, **parameters: complex) -> "System":
        from dalembert.multibody import System

        values = named_values(self.constants, parameters)
        gravity = self.model.gravity
        options: dict[str, Any] = {"driving": self.model.driving}
        if gravity is not None:
            options["gravity"] = tuple(_number(one, values, "[model], gravity") for one in gravity)
        system = System(**options)
        placed: dict[str, Any] = {}
        for table, component in self.model.components:
            where = f"[[model.{table}]] {component.name!r}"
            placed[component.name] = system.add(_built(component, values, placed, system, where))
        return system


@dataclass(frozen=True)
class FunctionBuilder:
    """A model that a Python function builds: parameters by name, and fixed arguments.

    Parameters
    ----------
    function : callable
    arguments : mapping of str to any
    """

    function: Callable[..., "System"]
    arguments: Mapping[str, Any]

    def __call__(self, **parameters: complex) -> "System":
        from dalembert.multibody import System

        system = self.function(**parameters, **self.arguments)
        if not isinstance(system, System):
            raise InputError(
                f"{self.function.__name__} returned a {type(system).__name__}; expected a System; "
                "a function that returns a ForwardModel is named by forward = in [model]"
            )
        return system


def named_values(constants: Mapping[str, float | Expression], parameters: Values) -> dict[str, Any]:
    """Parameters and constants as numbers, by name; constants in their order, since each may use those before it.

    >>> named_values({"half": Expression.of("L/2")}, {"L": 3.0})
    {'L': 3.0, 'half': 1.5}
    """
    values = dict(parameters)
    for name, given in constants.items():
        values[name] = _number(given, values, f"[constants], {name}")
    return values


def _built(table: KindTable, values: Values, placed: Values, system: Any, where: str) -> Any:
    """Component or signal of a table."""
    arguments = {
        key: _resolved(given, values, placed, system, f"{where}, {key}") for key, given in table.given().items()
    }
    return table.target_type(**arguments)


def _resolved(given: Any, values: Values, placed: Values, system: Any, where: str) -> Any:
    """What a key's value stands for once the parameters are known."""
    match given:
        case Expression():
            return _number(given, values, where)
        case Place():
            return _place(given, values, placed, system, where)
        case KindTable():
            return _built(given, values, placed, system, where)
        case FunctionReference():
            return given.load()
        case list():
            return tuple(_resolved(entry, values, placed, system, where) for entry in given)
        case dict():
            return {key: _resolved(entry, values, placed, system, where) for key, entry in given.items()}
    return given


def _number(given: float | Expression, values: Values, where: str) -> complex:
    try:
        return given(values) if isinstance(given, Expression) else given
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _place(given: Place, values: Values, placed: Values, system: Any, where: str) -> Any:
    """Point of a body or of the ground."""
    if given.position is not None:
        return system.ground.point(*(_number(one, values, where) for one in given.position))
    if not given.body:
        return system.ground
    try:
        return placed[given.body].point(given.point)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
