"""The table of a study file that names a robot: its file, numbers, initial state and torques at joints."""

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from dalembert.errors import DalembertError, unknown
from dalembert.study.tables.data_table import DataFile
from dalembert.study.tables.inputs import InputReference, signal_or_input
from dalembert.study.text.numbers import Number, number
from dalembert.study.text.table import Read, StudyTable, problem

if TYPE_CHECKING:
    from dalembert.multibody.trees import Tree

URDF = ".urdf"
Numbers = Annotated[dict[str, Any], Read(dict[str, number(None)])]  # pyright: ignore[reportInvalidTypeForm]
Torques = Annotated[dict[str, Any], Read(dict[str, signal_or_input(number(None))])]  # pyright: ignore[reportInvalidTypeForm]


class RobotTable(StudyTable):
    """A robot of a URDF or MJCF file."""

    file: DataFile = Field(description="'robot.urdf', or an MJCF file 'robot.xml'; relative to the study file")
    impossible: Literal["refuse", "replace"] = Field(
        "refuse", description="what becomes of an inertia in the file that no body can have"
    )
    numbers: Numbers = Field({}, description="numbers in place of those of the file: 'forearm.mass' = 'payload'")
    positions: Numbers = Field({}, description="of joints at the start; 0 where not given")
    rates: Numbers = Field({}, description="of joints at the start; 0 where not given")
    torques: Torques = Field({}, description="at joints: numbers, or { input = 'NAME' }")
    fixed: dict[str, Number] = Field({}, description="joints that are fixed, with their positions")
    slip: Annotated[Any, Read(number(None))] = Field(
        1e-3, description="rate over which Coulomb friction changes its sign, rad/s or m/s"
    )

    def _wrong(self) -> list[str]:
        try:
            tree = self.tree
        except DalembertError as error:
            raise problem(f"file: {error}") from None
        moving = [joint.name for joint in tree.moving]
        known = list(tree.numbers)
        wrong = [unknown("number", name, known, "numbers") for name in self.numbers if name not in known]
        for key in ("positions", "rates", "torques"):
            wrong += [unknown("joint", name, moving, key) for name in getattr(self, key) if name not in moving]
        return wrong

    @property
    def tree(self) -> "Tree":
        """The robot of the file, with the joints that are fixed."""
        robot = _read(self.file, self.file.stat().st_mtime_ns, self.impossible)
        return robot.with_fixed_joints(self.fixed) if self.fixed else robot

    @property
    def inputs(self) -> dict[str, str]:
        """Names of measured inputs that drive joints, by the joints."""
        return {name: torque.input for name, torque in self.torques.items() if isinstance(torque, InputReference)}

    @property
    def drive_units(self) -> dict[str, str]:
        """SI units of what drives each joint."""
        return {joint.name: "N" if joint.kind == "prismatic" else "N*m" for joint in self.tree.moving}

    @property
    def names(self) -> tuple[list[str], list[str]]:
        """Names of the bodies and of the joints of the robot's mechanism."""
        from dalembert.multibody.trees.build import names

        bodies, joints = names(self.tree)
        return bodies, list(joints.values())


@lru_cache(maxsize=8)
def _read(path: Path, changed: int, impossible: str) -> "Tree":
    """The robot of a file; read again when the file changes."""
    from dalembert.multibody.trees import read_mjcf, read_urdf

    return (read_urdf if path.suffix.lower() == URDF else read_mjcf)(path, impossible)
