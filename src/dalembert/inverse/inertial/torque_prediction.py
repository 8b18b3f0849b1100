"""Identified inertias with the torques that they were identified from, and those of a motion that was not fitted."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from scipy.special import chdtri

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.inverse.inertial.consistent_estimate import ConsistentInertias
from dalembert.results import EndedResult
from dalembert.stored_fields import Over
from dalembert.tables import Table, cells, counted, shown

CERTAIN = 1e-3  # probability of noise alone above which a prediction is as exact as the noise


@dataclass(frozen=True, eq=False)
class TorquePrediction(EndedResult):
    """Measured torques and those that identified inertias predict, along the fitted motion and an unseen one.

    Parameters
    ----------
    inertias : ConsistentInertias
    times : array, shape (samples,)
    measured, predicted : array, shape (samples, joints)
    unseen_times : array, shape (unseen samples,)
        Empty if there is no unseen motion.
    unseen_measured, unseen_predicted : array, shape (unseen samples, joints)

    Raises
    ------
    InputError
        For arrays of other shapes.

    Notes
    -----
    :attr:`ratios` are rms(predicted − measured) / noise of each joint along the unseen motion. The noise of n samples
    alone has the ratio (χ²_n / n)^½, about 1 ± 1 / (2n)^½; ``most`` is what it exceeds in 0.1 % of records.

    Examples
    --------
    >>> from dalembert.inverse.inertial import identify_inertias, parameter_names
    >>> motion, noise = np.random.default_rng(0).standard_normal((2, 80, 1, 10))
    >>> sphere = np.array([5.0, 0, 0, 0, 0.02, 0.02, 0.02, 0, 0, 0])
    >>> names, torques = parameter_names(["ball"]), motion @ sphere + noise[..., 0]
    >>> found = identify_inertias(motion[:60], torques[:60], names, sphere, links=["ball"])
    >>> times, all_of = np.arange(80.0), found.torques(motion)
    >>> told = TorquePrediction(found, times[:60], torques[:60], all_of[:60], times[60:], torques[60:], all_of[60:])
    >>> bool(told.ratios[0] < told.most)
    True
    """

    FORMAT: ClassVar[str] = "dalembert torqueprediction 1"
    TITLE: ClassVar[str] = "Inertial parameters"
    VERDICTS: ClassVar[tuple[str, str]] = ("identified", "not identified")

    inertias: ConsistentInertias
    times: Annotated[np.ndarray, Over("sample")]
    measured: Annotated[np.ndarray, Over("sample", "joint")]
    predicted: Annotated[np.ndarray, Over("sample", "joint")]
    unseen_times: Annotated[np.ndarray, Over("unseen_sample")]
    unseen_measured: Annotated[np.ndarray, Over("unseen_sample", "joint")]
    unseen_predicted: Annotated[np.ndarray, Over("unseen_sample", "joint")]

    def __post_init__(self) -> None:
        joints = len(self.inertias.joints)
        for name, times in (("", self.times), ("unseen_", self.unseen_times)):
            for attribute in ("measured", "predicted"):
                shape = np.shape(getattr(self, name + attribute))
                if shape != (len(times), joints):
                    raise InputError(
                        f"TorquePrediction: {name}{attribute} has the shape {shape}; expected ({len(times)}, {joints})"
                    )

    @property
    def outcome(self) -> tuple[Finding, ...]:  # type: ignore[override]
        """How the identification ended."""
        return self.inertias.outcome

    @property
    def success(self) -> bool:
        return self.inertias.success

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Those of the identification, and whether the unseen torques are predicted."""
        return (*self.inertias.base.findings, *self.inertias.findings, *self._told())

    @property
    def ratios(self) -> np.ndarray:
        """Rms error of the predicted unseen torques relative to the noise, (joints,); none without an unseen motion."""
        if not len(self.unseen_times):
            return np.zeros(0)
        return np.sqrt(np.mean((self.unseen_predicted - self.unseen_measured) ** 2, axis=0)) / self.inertias.noise

    @property
    def most(self) -> float:
        """Ratio that noise alone exceeds at any joint in 0.1 % of records."""
        count = len(self.unseen_times)
        level = CERTAIN / max(1, len(self.inertias.joints))
        return float(np.sqrt(chdtri(count, level) / count)) if count else np.nan

    def _told(self) -> list[Finding]:
        if not len(self.unseen_times):
            return []
        joint = int(np.argmax(self.ratios))
        worst, name = float(self.ratios[joint]), self.inertias.joints[joint]
        values = {"joint": name, "ratio": worst, "most": self.most}
        if worst < self.most:
            text = (
                f"The torques of the unseen motion are predicted as exactly as the noise allows: the rms error is at "
                f"most {worst:.3g} times the noise (joint {name!r}). Noise alone exceeds {self.most:.3g} in 0.1 % of "
                "records."
            )
            return [Finding("unseen-torques-predicted", "note", values, text)]
        text = (
            f"The torques of the unseen motion are not predicted: the rms error at joint {name!r} is {worst:.3g} times "
            f"the noise. Noise alone exceeds {self.most:.3g} in 0.1 % of records."
        )
        advice = "Excite the joints more, or add what the model lacks, for example friction or a payload."
        return [Finding("unseen-torques", "warning", values, text, advice)]

    def facts(self) -> dict[str, str]:
        facts = self.inertias.facts()
        if len(self.unseen_times):
            facts["prediction, worst joint"] = f"{shown(float(self.ratios.max()), digits=4)} times the noise"
            facts["unseen samples"] = counted(len(self.unseen_times))
        return facts

    def tables(self) -> tuple[Table, ...]:
        """Return the tables of the inertias, then the errors of the prediction."""
        if not len(self.unseen_times):
            return self.inertias.tables()
        columns = {"joint": self.inertias.joints, "error / noise": cells(self.ratios, 4)}
        caption = (
            f"Rms error of the predicted torques; noise alone exceeds {shown(self.most, digits=4)} in 0.1 % of records"
        )
        return (*self.inertias.tables(), Table.of("prediction", caption, columns))
