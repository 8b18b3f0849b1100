"""The function from parameters to a System, or a SpatialSystem, that a study file's model is."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from dalembert.errors import InputError
from dalembert.study.tables.dataclass_tables import KindTable, Written
from dalembert.study.tables.inputs import InputReference, MeasuredInput, input_named
from dalembert.study.tables.model_table import ModelTable
from dalembert.study.tables.robot_table import RobotTable
from dalembert.study.text.expressions import Expression, resolved
from dalembert.study.text.functions import FunctionReference
from dalembert.study.text.places import JointName, Place
from dalembert.study.text.table import placed

if TYPE_CHECKING:
    from dalembert.multibody.model.system import BaseSystem
    from dalembert.multibody.spatial import SpatialSystem
    from dalembert.multibody.trees import Tree

Values = Mapping[str, Any]
EMPTY: Values = {}
_COMPOSED = (Place, JointName, KindTable, FunctionReference, list, dict)
"""Types of values of keys that contain numbers or stand for objects."""


@dataclass(frozen=True)
class SystemBuilder:
    """A model written as data, called like any builder: ``builder(theta1=0.7, theta2=0.5)``.

    Numbers may be complex; they pass from a parameter to a component through arithmetic alone.

    Parameters
    ----------
    model : ModelTable
    constants : mapping of str to float or Expression
    inputs : mapping of str to MeasuredInput
    """

    model: ModelTable
    constants: Mapping[str, float | Expression]
    inputs: Mapping[str, MeasuredInput] = field(default_factory=dict)

    def __call__(self, **parameters: complex) -> "BaseSystem":
        values = named_values(self.constants, parameters)
        gravity = self.model.gravity
        options: dict[str, Any] = {
            "driving": self.model.driving,
            **({"start": self.model.start} if self.model.start else {}),
        }
        if gravity is not None:
            options["gravity"] = tuple(resolved(entry, values, "[model], gravity") for entry in gravity)
        signals = signals_of(self.inputs, values)
        robot = self.model.robot_table
        system = self._system(options) if robot is None else robot_of(robot, values, signals, options)
        bodies: dict[str, Any] = {entry.name: entry for entry in (*system.bodies, *system.joints)}
        for table, component in self.model.components:
            where = f"[[model.{table}]] {component.name!r}"
            bodies[component.name] = system.add(built(component, values, where, bodies, system, signals))
        if self.model.stated:
            stated = (("pose", self.model.pose), ("rates", self.model.rates))
            coordinates = [
                {joint: resolved(entry, values, f"[model], {key}") for joint, entry in at.items()} for key, at in stated
            ]
            system.pose(*coordinates)
        return system

    def _system(self, options: dict[str, Any]) -> "BaseSystem":
        if self.model.space:
            from dalembert.multibody.spatial import SpatialSystem as System
        else:
            from dalembert.multibody import System
        return System(**options)


def robot_of(robot: RobotTable, values: Values, signals: Values, options: Mapping[str, Any]) -> "SpatialSystem":
    """The mechanism of a robot once the parameters are known."""

    def numbers(key: str) -> dict[str, Any]:
        known = {name: entry for name, entry in getattr(robot, key).items() if not isinstance(entry, InputReference)}
        return {name: resolved(entry, values, f"[model.robot.{key}], {name}") for name, entry in known.items()}

    with placed("[model.robot]"):
        return tree_of(robot, values).system(
            numbers("positions"),
            numbers("rates"),
            slip=resolved(robot.slip, values, "[model.robot], slip"),
            torques=numbers("torques") | {name: signals[reference] for name, reference in robot.inputs.items()},
            **{key: reference for key, reference in options.items() if key != "driving"},
        )


def tree_of(robot: RobotTable, values: Values) -> "Tree":
    """The robot of a study once the parameters are known."""
    changed = {name: resolved(entry, values, "[model.robot.numbers]") for name, entry in robot.numbers.items()}
    with placed("[model.robot.numbers]"):
        return robot.tree.with_numbers(changed)


@dataclass(frozen=True)
class FunctionBuilder:
    """A model that a Python function builds: parameters by name, and fixed arguments.

    Parameters
    ----------
    function : callable
    arguments : mapping of str to any
    vibrates : bool
        Whether it builds a vibrating structure, and not a mechanism.
    inputs : mapping of str to MeasuredInput
        Of arguments that name one.
    constants : mapping of str to float or Expression
        Which numbers of the inputs may name.
    """

    function: Callable[..., Any]
    arguments: Mapping[str, Any]
    vibrates: bool = False
    inputs: Mapping[str, MeasuredInput] = field(default_factory=dict)
    constants: Mapping[str, float | Expression] = field(default_factory=dict)

    def __call__(self, **parameters: complex) -> Any:
        arguments = dict(self.arguments)
        if self.inputs:
            signals = signals_of(self.inputs, named_values(self.constants, parameters))
            arguments |= {key: signals[name] for key, value in arguments.items() if (name := input_named(value))}
        system = self.function(**parameters, **arguments)
        if not isinstance(system, self._expected):
            expected = "VibrationSystem" if self.vibrates else "System"
            more = (
                "the study is of a structure over frequency, since it has [harmonic_balance] or a task of structures"
                if self.vibrates
                else "a function that returns a ForwardModel is named by forward = in [model], and one that returns a "
                "VibrationSystem needs the table [harmonic_balance]"
            )
            raise InputError(
                f"{self.function.__name__} returned a {type(system).__name__}; expected a {expected}; {more}"
            )
        return system

    @property
    def _expected(self) -> type:
        if self.vibrates:
            from dalembert.vibration import VibrationSystem

            return VibrationSystem
        from dalembert.multibody.model.system import BaseSystem

        return BaseSystem


def named_values(constants: Mapping[str, float | Expression], parameters: Values) -> dict[str, Any]:
    """Parameters and constants as numbers, by name; constants in their order, since each may use those before it.

    >>> named_values({"half": Expression.of("L/2")}, {"L": 3.0})
    {'L': 3.0, 'half': 1.5}
    """
    values = dict(parameters)
    for name, entry in constants.items():
        values[name] = resolved(entry, values, f"[constants], {name}")
    return values


def signals_of(inputs: Mapping[str, MeasuredInput], values: Values) -> dict[str, Any]:
    """The signals of inputs, by name, once the parameters are known."""
    signals = {}
    for name, measured in inputs.items():
        with placed(f"[inputs.{name}]"):
            signals[name] = measured.signal(values)
    return signals


def built(
    table: KindTable, values: Values, where: str, bodies: Values = EMPTY, system: Any = None, signals: Values = EMPTY
) -> Any:
    """What a table describes, once the parameters are known; places are those of a mechanism's bodies.

    >>> from dalembert.structure import Modal
    >>> from dalembert.study.tables.dataclass_tables import table_of
    >>> table = table_of(Modal)(kind="Modal", ratio="2*zeta")
    >>> built(table, {"zeta": 0.005}, "[model.structure], damping")
    Modal(ratio=0.01)
    """
    arguments = table.given()
    for key, argument in arguments.items():
        if isinstance(argument, Expression):
            arguments[key] = resolved(argument, values, f"{where}, {key}")
        elif isinstance(argument, InputReference):
            arguments[key] = signals[argument.input]
        elif isinstance(argument, _COMPOSED):
            arguments[key] = _resolved(argument, values, bodies, system, f"{where}, {key}")
    result = table.target_type(**arguments)
    return result.value if isinstance(result, Written) else result


def _resolved(argument: Any, values: Values, bodies: Values, system: Any, where: str) -> Any:
    match argument:
        case Expression():
            return resolved(argument, values, where)
        case Place():
            return _place(argument, values, bodies, system, where)
        case JointName():
            return bodies[argument.name]
        case KindTable():
            try:
                return built(argument, values, where, bodies, system)
            except InputError as error:
                raise InputError(str(error) if str(error).startswith("[") else f"{where}: {error}") from None
        case FunctionReference():
            return argument.load()
        case list():
            return tuple(_resolved(entry, values, bodies, system, where) for entry in argument)
        case dict():
            return {key: _resolved(entry, values, bodies, system, where) for key, entry in argument.items()}
    return argument


def _place(place: Place, values: Values, bodies: Values, system: Any, where: str) -> Any:
    numbers = tuple(resolved(number, values, where) for number in place.position or ())
    try:
        if numbers:
            return system.ground.point(numbers) if len(system.AXES) == 3 else system.ground.point(*numbers)
        return bodies[place.body].point(place.point) if place.body else system.ground
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
