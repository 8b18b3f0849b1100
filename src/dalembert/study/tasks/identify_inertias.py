"""Identify inertias: inertial parameters of a robot from recorded positions and torques of its joints."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import Field

from dalembert.data.record import FIRST
from dalembert.errors import DataError, unknown
from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.run.events import Emit
from dalembert.study.tables.builder import named_values, tree_of
from dalembert.study.tables.data_table import DataFile, DataTable
from dalembert.study.tables.robot_table import RobotTable
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_data, needs_robot
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.expressions import resolved
from dalembert.study.text.numbers import Number, fixed, wrong_units
from dalembert.study.text.table import Read, StudyTable, placed
from dalembert.units import wrong_kind

if TYPE_CHECKING:
    from dalembert.inverse.inertial import TorquePrediction
    from dalembert.multibody.trees import Tree

Hertz = Annotated[float, Read(fixed("Hz"))]
IDENTIFIED = "identified.urdf"
UNITS = {"angle": "rad", "torque": "N*m", "displacement": "m", "force": "N"}


class IdentifyInertiasTable(StudyTable):
    """Identify inertial parameters of a robot from positions and torques of its joints, near those of its file."""

    cutoff: Hertz = Field(description="of the low-pass filter: about ten times the highest frequency of the motion")
    unseen: DataFile | None = Field(
        None, description="file of another motion with the same columns, whose torques are predicted"
    )
    regularisation: float = Field(1.0, gt=0, description="weight of the prior: 1 is about 70 % of its inertias")
    deviations: Number | dict[str, Number] | None = Field(
        None, description="standard deviation of the torques, or of each joint; from the residuals if not given"
    )


class Identified(Outcome):
    """Identified inertias, and a URDF file with them."""

    def save(self, path: Path) -> None:
        from dalembert.multibody.trees import parameter_names, parameters_of, with_parameters, write_urdf

        super().save(path)
        tree = prior_of(self.study)
        values = dict(zip(parameter_names(tree), parameters_of(tree).tolist(), strict=True))
        values |= self.result.inertias.estimates
        write_urdf(with_parameters(tree, list(values.values())), path.with_name(IDENTIFIED))


class IdentifyInertias(ResultTask):
    """The task ``[identify_inertias]``."""

    name = "identify_inertias"
    kind = "dalembert.inverse.inertial:TorquePrediction"
    rank = 4
    schema = IdentifyInertiasTable
    needs = (needs_robot, needs_data)

    def wrong(self, file: Any) -> list[str]:
        wrong = super().wrong(file)
        if wrong:
            return wrong
        tree = file.model.robot_table.tree
        expected = [name for pair in channels_of(tree) for name in pair]
        channels = file.data.channels
        wrong = [f"[data], columns: no column is given for {name!r}" for name in expected if name not in channels]
        wrong += [unknown("channel", name, expected, "[data], columns") for name in channels if name not in expected]
        if file.identify_inertias.unseen is not None and file.data.more:
            wrong.append(
                "[identify_inertias], unseen: the data have further files (more), and the unseen motion is one file; "
                "write all columns of each motion into one file"
            )
        deviations = file.identify_inertias.deviations
        if isinstance(deviations, dict):
            joints, where = [joint.name for joint in tree.moving], "[identify_inertias], deviations"
            wrong += [unknown("joint", name, joints, where) for name in deviations if name not in joints]
            wrong += [f"{where}: none is given for joint {name!r}" for name in joints if name not in deviations]
        elif deviations is not None:
            deviations = dict.fromkeys(file.model.robot_table.drive_units, deviations)
        wrong += wrong_units(deviations or {}, file.model.robot_table.drive_units, "[identify_inertias], deviations")
        return wrong

    def plan(self, study: Study) -> str:
        tree, table, kept = prior_of(study), study.file.data, kept_names(prior_of(study))
        assert table is not None  # or the study was refused
        return (
            f"identifies {len(kept)} inertial and friction parameters of {len(tree.moving)} joints from the torques in "
            f"{table.file.name}: no simulation"
        )

    def parts(self, study: Study) -> Any:
        """The data and their filter."""
        return (lambda: _records(study),)

    def unknowns(self, study: Study) -> tuple[str, ...]:
        return ()

    def effort(self, study: Study) -> Effort:
        return Effort(repeatedly(lambda: _identified(study)), 1, 1, 1, "this identification, done once")

    def result(self, study: Study, emit: Emit) -> Any:
        return _identified(study)

    def outcome(self, study: Study, result: "TorquePrediction") -> Outcome:
        """Outcome with the base parameters, the largest ratio of error and noise, and the smallest eigenvalue."""
        inertias = result.inertias
        values = dict(zip(inertias.base.base, inertias.base_values.tolist(), strict=True))
        values |= {"smallest eigenvalue": float(inertias.eigenvalues.min())}
        if len(result.unseen_times):
            values |= {"prediction / noise": float(result.ratios.max())}
        return Identified(study, result, {"values": values})


def channels_of(tree: "Tree") -> list[tuple[str, str]]:
    """Channels of position and torque of each joint, such as ``("elbow.angle", "elbow.torque")``."""
    kinds = {"revolute": ("angle", "torque"), "prismatic": ("displacement", "force")}
    return [(f"{joint.name}.{kinds[joint.kind][0]}", f"{joint.name}.{kinds[joint.kind][1]}") for joint in tree.moving]


def prior_of(study: Study) -> "Tree":
    """The robot at the first guesses of the parameters."""
    return tree_of(_robot(study), values_of(study))


def _robot(study: Study) -> RobotTable:
    robot = study.file.model.robot_table
    assert robot is not None  # or the study was refused
    return robot


def values_of(study: Study) -> dict[str, Any]:
    """Parameters at their first guesses, and constants."""
    return named_values(study.file.constants, study.parameters.mapping(study.parameters.start))


def kept_names(tree: "Tree") -> list[str]:
    """Parameters that are identified: those of links, and those of joints that are not zero."""
    from dalembert.multibody.trees import parameter_names, parameters_of

    count = 10 * sum(link.inertia is not None for link in tree.links)
    pairs = enumerate(zip(parameter_names(tree), parameters_of(tree), strict=True))
    return [name for place, (name, value) in pairs if place < count or value > 0]


def regressor_of(study: Study) -> Any:
    """The regressor (samples, joints, parameters) of a motion, with the columns that are identified."""
    from dalembert.multibody.trees import parameter_names, regressor

    tree, values, model = prior_of(study), values_of(study), study.file.model
    chosen = np.isin(parameter_names(tree), kept_names(tree))
    slip = float(np.real(resolved(_robot(study).slip, values, "[model.robot], slip")))
    gravity = model.gravity or (0.0, 0.0, -9.81)
    pull = tuple(float(np.real(resolved(component, values, "[model], gravity"))) for component in gravity)

    def columns(q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        return regressor(tree, q, v, a, pull, slip=slip)[..., chosen]

    return columns


def _record(study: Study, table: DataTable, where: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (samples,), regressor and torques (samples, joints), all through the same filter."""
    from dalembert.inverse.inertial import filtered_motion, lowpass
    from dalembert.inverse.inertial.motion import kept_samples

    data, cutoff = table.read(), study.table.cutoff
    times, pairs = data.coordinate.values, channels_of(prior_of(study))
    for channel, unit in data.source_units.items():
        kind = UNITS.get(channel.rpartition(".")[2], "")
        if kind and (sentence := wrong_kind(unit, kind)):
            raise DataError(f"{where}, columns, {channel!r}: {sentence}; choose another column, or correct its unit")
    positions, torques = (data.values[:, [data.channels.index(pair[k]) for pair in pairs]] for k in (0, 1))
    with placed(where):
        motion = filtered_motion(times, positions, torques, cutoff, decimation=1)
        rate = (len(motion.times) - 1) / (motion.times[-1] - motion.times[0])
        columns = regressor_of(study)(motion.positions, motion.velocities, motion.accelerations)
        columns = lowpass(columns, rate, cutoff)  # as the torques: friction has jumps
        kept, _ = kept_samples(len(motion.times), rate, cutoff)
    return motion.times[kept], columns[kept], motion.torques[kept]


def _records(study: Study) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    data, unseen = study.file.data, study.table.unseen
    assert data is not None  # or the study was refused
    records = [_record(study, data, "[data]")]
    if unseen is not None:
        records.append(_record(study, _as_read(data, unseen), "[identify_inertias], unseen"))
    return records


def _as_read(data: DataTable, file: Path) -> DataTable:
    """The table of another motion that is read as the data are, without their times, which are those of one motion."""
    other = data.model_copy(
        update={"file": file, "between": None, "resample": None, "split": None, "trial": None, "start": FIRST}
    )
    if data.resample is None:
        return other
    first, last = other.model_copy(update={"lowpass": None}).read().coordinate.values[[0, -1]]
    step = float(np.median(np.diff(data.resample)))
    return other.model_copy(update={"resample": tuple(np.arange(first, last, step).tolist())})


def _identified(study: Study) -> "TorquePrediction":
    from dalembert.inverse.inertial import TorquePrediction, identify_inertias
    from dalembert.multibody.trees import parameter_names, parameters_of

    tree, (fitted, *further) = prior_of(study), _records(study)
    names, joints = kept_names(tree), [joint.name for joint in tree.moving]
    prior = dict(zip(parameter_names(tree), parameters_of(tree).tolist(), strict=True))
    links = [link.name for link in tree.links if link.inertia is not None]
    deviations = study.table.deviations
    estimate = identify_inertias(
        fitted[1],
        fitted[2],
        names,
        [prior[name] for name in names],
        links=links,
        joints=joints,
        positive=names[10 * len(links) :],
        regularisation=study.table.regularisation,
        deviations=[deviations[name] for name in joints] if isinstance(deviations, dict) else deviations,
    )
    none = (np.zeros(0), np.zeros((0, len(joints), len(names))), np.zeros((0, len(joints))))
    times, columns, torques = further[0] if further else none
    prediction = times, torques, estimate.torques(columns)
    return TorquePrediction(estimate, fitted[0], fitted[2], estimate.torques(fitted[1]), *prediction)
