"""Exciting trajectory: a motion of a robot that excites its inertial parameters within the limits of its joints."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field

from dalembert.errors import unknown
from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.identify_inertias import kept_names, prior_of, regressor_of
from dalembert.study.tasks.requirements import needs_robot
from dalembert.study.tasks.samples_file import write_samples
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.numbers import Number, NumberOfEach, Seconds, fixed, pair
from dalembert.study.text.table import Read, StudyTable

if TYPE_CHECKING:
    from dalembert.inverse.inertial import JointLimits
    from dalembert.multibody.trees import Tree

MOTION = "motion.csv"
Pairs = Annotated[dict[str, list[float]], Read(dict[str, pair(fixed(None))])]  # pyright: ignore


class ExcitingTrajectoryTable(StudyTable):
    """Search a periodic motion that excites the inertial parameters of a robot."""

    period: Seconds
    harmonics: int = Field(5, ge=1, description="of each joint; the highest frequency is harmonics / period")
    acceleration: NumberOfEach = Field(description="limit of the joints: a number, or one for each joint")
    velocity: NumberOfEach | None = Field(None, description="limit of the joints; that of the file if not given")
    positions: Pairs = Field({}, description="limits of joints, lower and upper; those of the file where not given")
    deviations: Number | None = Field(None, gt=0, description="standard deviation of the torques; 1 if not given")
    criterion: Literal["D", "condition"] = Field(
        "D", description="'D': mean log standard deviation, 'condition': of the scaled columns"
    )
    evaluations: int = Field(1000, ge=0, description="motions of the search")
    rate: Annotated[float, Read(fixed("Hz"))] = Field(100.0, description="of the samples in motion.csv")
    seed: int = Field(0, ge=0, description="of all random numbers")


class Excited(Outcome):
    """An exciting trajectory, and a file with a period of it."""

    @property
    def success(self) -> bool:
        return True

    def save(self, path: Path) -> None:
        super().save(path)
        times, *motion = self.result.sampled(self.study.table.rate)
        names = [f"{joint}.{what}" for what in ("position", "velocity", "acceleration") for joint in self.result.joints]
        write_samples(path.with_name(MOTION), names, times, np.column_stack(motion))


class ExcitingTrajectoryTask(ResultTask):
    """The task ``[exciting_trajectory]``."""

    name = "exciting_trajectory"
    kind = "dalembert.inverse.inertial:ExcitingTrajectory"
    rank = 8
    schema = ExcitingTrajectoryTable
    needs = (needs_robot,)

    def wrong(self, file: Any) -> list[str]:
        wrong = super().wrong(file)
        if wrong:
            return wrong
        table, moving = file.exciting_trajectory, file.model.robot_table.tree.moving
        joints = [joint.name for joint in moving]
        for key in ("acceleration", "velocity", "positions"):
            value, where = getattr(table, key), f"[exciting_trajectory], {key}"
            if isinstance(value, dict):
                wrong += [unknown("joint", name, joints, where) for name in value if name not in joints]
                missing = [name for name in joints if name not in value and key == "acceleration"]
                wrong += [f"{where}: none is given for joint {name!r}" for name in missing]
        for joint in moving:
            if joint.name not in table.positions and not np.isfinite([joint.lower, joint.upper]).all():
                wrong.append(
                    f"[exciting_trajectory], positions: joint {joint.name!r} has no limits in the file; give its lower "
                    "and its upper one"
                )
        return wrong

    def plan(self, study: Study) -> str:
        limits_of(study, prior_of(study))
        return (
            f"searches a motion of {study.table.period:g} s that excites {len(kept_names(prior_of(study)))} parameters "
            f"among {study.table.evaluations} motions: no simulation"
        )

    def parts(self, study: Study) -> Any:
        """None: the plan checks all."""
        return ()

    def unknowns(self, study: Study) -> tuple[str, ...]:
        return ()

    def effort(self, study: Study) -> Effort:
        few = min(20, study.table.evaluations)
        return Effort(
            repeatedly(lambda: _trajectory(study, few)), 20 + few, 20, 20 + study.table.evaluations, "the first motions"
        )

    def result(self, study: Study, emit: Emit) -> Any:
        return _trajectory(study, study.table.evaluations)

    def outcome(self, study: Study, result: Any) -> Outcome:
        """Outcome with the score and the condition number, and those of random motions."""
        keys = ("score", "usual_score", "condition", "usual_condition")
        return Excited(study, result, {"values": {key: float(getattr(result, key)) for key in keys}})


def limits_of(study: Study, tree: "Tree") -> "JointLimits":
    """Limits of the joints: those of the study, else those of the file."""
    from dalembert.inverse.inertial import JointLimits

    table = study.table
    pairs = [table.positions.get(joint.name, (joint.lower, joint.upper)) for joint in tree.moving]
    velocities = [_each(table.velocity, joint.name, joint.velocity) for joint in tree.moving]
    acceleration = [_each(table.acceleration, joint.name, np.inf) for joint in tree.moving]
    lower, upper = np.array(pairs).T
    return JointLimits(lower, upper, np.array(velocities), np.array(acceleration))


def _each(numbers: Any, name: str, otherwise: float) -> float:
    if isinstance(numbers, dict):
        return numbers.get(name, otherwise)
    return otherwise if numbers is None else numbers


def _trajectory(study: Study, evaluations: int) -> Any:
    from dalembert.inverse.inertial import exciting_trajectory

    tree, table = prior_of(study), study.table
    return exciting_trajectory(
        regressor_of(study),
        kept_names(tree),
        limits_of(study, tree),
        joints=[joint.name for joint in tree.moving],
        deviations=1.0 if table.deviations is None else table.deviations,
        evaluations=evaluations,
        **table.picked("period", "harmonics", "criterion", "seed"),
    )
