"""The table of a study file that describes its model: components as data, or a Python function."""

from functools import cache, lru_cache
from itertools import chain
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, ConfigDict, Field

from dalembert.errors import repeated, unknown
from dalembert.study.tables.catalogue import Words, kinds_of
from dalembert.study.tables.dataclass_tables import any_of, table_of
from dalembert.study.tables.inputs import signal_or_input
from dalembert.study.tables.robot_table import RobotTable
from dalembert.study.tables.structure_table import (
    PARTS,
    StructureTable,
    part_tables,
    rotor_speed,
    structure_table,
    wrong_structure,
)
from dalembert.study.text.functions import FunctionName
from dalembert.study.text.places import JointName, Place
from dalembert.study.text.spaces import IN_SPACE, by_joint, gravity_key, is_in_space
from dalembert.study.text.table import Read, StudyTable, alternative, completed, problem
from dalembert.units import is_quantity, si

_TABLES = ("body", "joint", "load")
_MEANINGS = {
    "body": "a body of a mechanism",
    "joint": "a joint of a mechanism",
    "load": "a force, spring, motor or sensor of a mechanism",
    "mass": "a mass of a structure",
    "spring": "a spring of a structure",
    "rotor": "a disc or a rotating damper of a structure",
    "force": "a force on a structure",
    "contact": "a contact of a structure",
}


class ModelTable(StudyTable):
    """The model: a mechanism of bodies, joints and loads; a structure with forces and contacts; or a Python function.

    ``function`` maps parameters to a System, a SpatialSystem or a VibrationSystem, as these tables do; ``forward`` maps
    the parameters' names and bounds to a ForwardModel of any kind.
    """

    file: str | None = Field(None, description="another TOML file, which holds the model's tables")
    function: FunctionName | None = Field(None, description="Python function that returns a system: 'model.py:name'")
    forward: FunctionName | None = Field(None, description="Python function that returns a model: 'model.py:name'")
    arguments: dict[str, Any] = Field({}, description="fixed arguments of the function")
    space: Literal[False] = Field(False, description="true for a mechanism in space: its components and three axes")
    gravity: Annotated[list[Any], Read(gravity_key(2))] | None = Field(
        None, description="acceleration along x and y; [0, -9.81] if not given"
    )
    driving: list[str] = Field(
        [], description="placement coordinates kept while a closed loop is assembled: 'AB.angle'"
    )
    start: Literal["placed", "equilibrium"] | None = Field(
        None, description="where a mechanism begins: as it is placed, or at rest in its equilibrium under the loads"
    )
    pose: Annotated[dict[str, Any], BeforeValidator(by_joint(0))] = Field(
        {}, description="angles and displacements of joints at the start: { pin = '30 deg' }"
    )
    rates: Annotated[dict[str, Any], BeforeValidator(by_joint(1))] = Field(
        {}, description="rates of joints at the start: { pin = '2 rad/s' }"
    )
    body: list[Any] = []
    joint: list[Any] = []
    load: list[Any] = []
    structure: StructureTable | None = None
    mass: list[Any] = []
    spring: list[Any] = []
    rotor: list[Any] = []
    speed: Annotated[Any, Read(rotor_speed())] | None = Field(
        None, description="of the rotor parts of a structure: '300 rpm', or 'synchronous' for that of the excitation"
    )
    force: list[Any] = []
    contact: list[Any] = []

    @property
    def holding(self) -> str:
        """Where the file says what holds a structure."""
        if self.mass:
            return "[[model.spring]]"
        return "[model.structure], fixed" if self.is_structure else "[model], function"

    @property
    def is_structure(self) -> bool:
        """Whether the tables describe a structure."""
        return bool(self.mass) or (self.structure is not None and self.structure.source)

    @property
    def stated(self) -> bool:
        """Whether coordinates or rates of joints are given."""
        return bool(self.pose or self.rates)

    @property
    def robot_table(self) -> RobotTable | None:
        """The robot, if the model has one."""
        return getattr(self, "robot", None)

    @property
    def components(self) -> list[tuple[str, Any]]:
        """All components in the order in which they are added, with the names of their tables."""
        return [(table, component) for table in _TABLES for component in getattr(self, table)]

    @property
    def resolved_arguments(self) -> dict[str, Any]:
        """The function's arguments, quantities with a unit in SI."""
        return {
            key: si(value, None, f"[model.arguments], {key}")
            if isinstance(value, str) and is_quantity(value)
            else value
            for key, value in self.arguments.items()
        }

    def _wrong(self) -> list[str]:
        robot = self.robot_table
        if self.space and not self.body and robot is None:
            raise problem("space belongs to a model of [[model.body]] tables or of a robot, and there is none")
        if robot is not None and self.driving:
            raise problem("driving is for components, and the positions of a robot's joints are given; leave it out")
        ways = [name for name in ("function", "forward") if getattr(self, name)]
        ways += ["body"] * (bool(self.body) or robot is not None)
        ways += ["mass" if self.mass else "structure"] * self.is_structure
        if len(ways) != 1:
            stated = f"{' and '.join(ways)} are" if ways else "neither body, mass, structure, function nor forward is"
            raise problem(
                f"{stated} given; expected either the [[model.body]] tables of a mechanism, or the [[model.mass]] "
                "tables or the [model.structure] of a structure, or function = 'model.py:name', or "
                "forward = 'model.py:name'"
            )
        self._refuse_other_parts(ways)
        if ("body" in ways or self.is_structure) and self.arguments:
            raise problem("arguments are for a function, and there is none")
        return [*_wrong_names(self.components, robot), *wrong_structure(self)]

    def _refuse_other_parts(self, ways: list[str]) -> None:
        """Refuse parts of a structure in a mechanism, and parts of a mechanism in a structure or beside a function."""
        if not self.is_structure and (
            self.structure is not None or any(getattr(self, name) for name in (*PARTS, "speed"))
        ):
            stated = (
                "here is a mechanism, whose springs and forces stand in [[model.load]]"
                if "body" in ways
                else "here a function gives it"
            )
            raise problem(
                "structure, spring, rotor, speed, force and contact belong to a structure of [[model.mass]] tables or "
                f"of matrices in [model.structure]; {stated}"
            )
        states = self.driving or self.start or self.stated
        if "body" not in ways and (self.joint or self.load or self.gravity or states):
            stated = "this is a structure" if self.is_structure else "here a function gives it"
            raise problem(
                f"joint, load, gravity, driving, start, pose and rates belong to a model of [[model.body]] "
                f"tables; {stated}"
            )


def _wrong_names(components: list[tuple[str, Any]], robot: RobotTable | None) -> list[str]:
    of_robot: tuple[list[str], list[str]] = robot.names if robot else ([], [])
    bodies, joints = (
        [*names, *(component.name for table, component in components if table == kind)]
        for names, kind in zip(of_robot, ("body", "joint"), strict=True)
    )
    wrong = [
        f"{count} components are called {name!r}; expected different names"
        for name, count in repeated([*chain(*of_robot), *(component.name for _, component in components)]).items()
    ]
    for table, component in components:
        known = bodies[: bodies.index(component.name)] if table == "body" else bodies
        before = joints[: joints.index(component.name)] if table == "joint" else joints
        for key, value in component.given().items():
            if isinstance(value, JointName) and value.name not in before:
                late = "; a joint must stand before those that refer to it" if value.name in joints else ""
                text = unknown("joint", value.name, before)
                wrong.append(f"[[model.{table}]] {component.name!r}, {key}: {str(value)!r} was given; {text}{late}")
            if isinstance(value, Place) and value.body and value.body not in known:
                late = "; a body must stand before those placed at it" if value.body in bodies else ""
                text = unknown("body", value.body, known)
                wrong.append(f"[[model.{table}]] {component.name!r}, {key}: {str(value)!r} was given; {text}{late}")
    return wrong


def _only_mechanism(schema: dict[str, Any]) -> None:
    for key in ("function", "forward", "arguments", "structure", "speed", *PARTS):
        schema["properties"].pop(key, None)


class SpatialModelTable(ModelTable):
    """The model: a mechanism in space of bodies, joints and loads."""

    model_config = ConfigDict(json_schema_extra=_only_mechanism)

    space: Literal[True]
    gravity: Annotated[list[Any], Read(gravity_key(3))] | None = Field(
        None, description="acceleration along x, y and z; [0, 0, -9.81] if not given"
    )
    robot: RobotTable | None = None
    structure: Any = None

    @property
    def is_structure(self) -> bool:
        return False


@cache
def model_key(words: Words = None) -> Any:
    """Type of the model's key: the table of a mechanism in space, or of other models; one of them where words say."""
    if words is not None:
        return spatial_model_table(words) if IN_SPACE in words else model_table(words)
    return alternative(is_in_space, spatial_model_table(), model_table())


@lru_cache(maxsize=16)
def spatial_model_table(words: Words = None) -> type[ModelTable]:
    """The table of a mechanism in space with all kinds of components that there are, or those that words name."""
    from dalembert.study.tables.spatial_parts import spatial_part, spatial_place

    options = {"part": spatial_part, "place": spatial_place, "prefix": "Spatial"}
    return completed(SpatialModelTable, **_components(words, space=True, **options))


def _components(words: Words, *, space: bool = False, **options: Any) -> dict[str, Any]:
    lists: dict[str, Any] = {}
    if words is None or not words.isdisjoint(_TABLES):
        signal = signal_or_input(any_of([table_of(target) for target in kinds_of("signal")]))
        for table in _TABLES:
            kinds = kinds_of(table, words, space=space)
            kinds = kinds or (kinds_of(table, space=space) if table in (words or ()) else ())
            if kinds:
                tables = [table_of(target, signal=signal, **options) for target in kinds]
                lists[table] = (list[any_of(tables)], Field([], description=_MEANINGS[table]))
    return lists


@lru_cache(maxsize=16)
def model_table(words: Words = None) -> type[ModelTable]:
    """The model's table with all kinds of components that there are, or those that words name."""
    lists = _components(words)
    if words is None or not words.isdisjoint((*PARTS, "structure")):
        lists |= {name: (kind, Field([], description=_MEANINGS[name])) for name, kind in part_tables().items()}
        lists["structure"] = (structure_table() | None, None)
    return completed(ModelTable, **lists)
