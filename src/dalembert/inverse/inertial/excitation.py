"""Trajectories of joints that excite inertial parameters as well as limits allow."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.findings import Finding
from dalembert.inverse.inertial.base_estimate import joint_names
from dalembert.inverse.inertial.base_parameters import BaseParameters, base_parameters
from dalembert.inverse.inertial.fourier_motion import FINE, FourierMotion, JointLimits, largest_motion
from dalembert.inverse.inertial.stacked import checked_deviations
from dalembert.results import EndedResult
from dalembert.stored_fields import Labels, Over
from dalembert.tables import Table, cells, counted, shown

Regressor = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
CRITERIA = {"D": "mean log standard deviation", "condition": "log condition number"}
SAMPLES = 8  # samples per harmonic where the criterion is computed
# Steps of the search: the first one, and that at which it starts again from another random motion.
FIRST, SMALLEST = 0.3, 1e-3


@dataclass(frozen=True, eq=False)
class ExcitingTrajectory(EndedResult):
    """A periodic motion that excites the parameters of a regressor.

    Parameters
    ----------
    motion : FourierMotion
    limits : JointLimits
    joints : tuple of str
    criterion : {"D", "condition"}
    score : float
        Of this motion; smaller is better.
    usual_score : float
        Median of random motions within the same limits.
    condition, usual_condition : float
        Condition numbers of the scaled columns of the base parameters, of this motion and the median of random ones.
    history : array, shape (evaluations,)
        Best score so far.
    seed : int
    outcome, findings : tuple of Finding
    """

    FORMAT: ClassVar[str] = "dalembert excitingtrajectory 1"
    TITLE: ClassVar[str] = "Exciting trajectory"
    VERDICTS: ClassVar[tuple[str, str]] = ("found", "")

    motion: FourierMotion
    limits: JointLimits
    joints: Annotated[tuple[str, ...], Labels("joint")]
    criterion: str
    score: float
    usual_score: float
    condition: float
    usual_condition: float
    history: Annotated[np.ndarray, Over("evaluation")]
    seed: int
    outcome: tuple[Finding, ...]
    findings: tuple[Finding, ...] = ()

    def sampled(self, rate: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Times (samples,), positions, velocities and accelerations (samples, joints) of a period at a rate, Hz."""
        times = np.arange(int(np.floor(self.motion.period * rate)) + 1) / rate
        return times, *self.motion.motion(times)

    def facts(self) -> dict[str, str]:
        return {
            "period": f"{shown(self.motion.period)} s, {self.motion.sine.shape[1]} harmonics",
            CRITERIA[
                self.criterion
            ]: f"{shown(self.score, digits=4)}, of random motions {shown(self.usual_score, digits=4)}",
            "condition number": f"{shown(self.condition, digits=4)}, of random motions "
            f"{shown(self.usual_condition, digits=4)}",
            "evaluations": counted(len(self.history)),
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the positions, velocities and accelerations of the joints with their limits."""
        rate = FINE * self.motion.sine.shape[1] / self.motion.period
        _, positions, velocities, accelerations = self.sampled(rate)
        columns = {
            "joint": self.joints,
            "smallest position": cells(positions.min(axis=0), 4),
            "lower limit": cells(self.limits.lower),
            "largest position": cells(positions.max(axis=0), 4),
            "upper limit": cells(self.limits.upper),
            "largest velocity": cells(np.abs(velocities).max(axis=0), 4),
            "limit of velocity": cells(self.limits.velocity),
            "largest acceleration": cells(np.abs(accelerations).max(axis=0), 4),
            "limit of acceleration": cells(self.limits.acceleration),
        }
        return (Table.of("limits", "Limits of the joints", columns),)


def exciting_trajectory(
    regressor: Regressor,
    names: Sequence[str],
    limits: JointLimits,
    *,
    period: float,
    harmonics: int = 5,
    joints: Sequence[str] = (),
    criterion: str = "D",
    deviations: float | Sequence[float] = 1.0,
    random: int = 20,
    evaluations: int = 1000,
    seed: int = 0,
) -> ExcitingTrajectory:
    """Search a periodic motion within limits that excites the parameters of a regressor.

    Parameters
    ----------
    regressor : callable
        Positions, velocities and accelerations (samples, joints) to Y (samples, joints, parameters).
    names : sequence of str, length parameters
    limits : JointLimits
    period : float
        s. The highest frequency is harmonics / period.
    harmonics : int
        Of each joint.
    joints : sequence of str, optional
    criterion : {"D", "condition"}
        The mean logarithm of the standard deviations, −log det(Σ YᵀY/σ²) / (2 base), which does not depend on units; or
        the logarithm of the condition number of the scaled columns.
    deviations : float or sequence of float, length joints
        Standard deviations σ of the torques.
    random : int
        Random motions; the best one is where the search starts.
    evaluations : int
        Motions of the search.
    seed : int

    Raises
    ------
    InputError
        For an unknown criterion, numbers that are not positive, or a regressor of another shape.

    Notes
    -----
    Every shape is scaled to the largest motion that keeps all limits at all times, so no constraint is left. The
    search is an evolution strategy with one parent and one child, whose step follows the rule of one success in five
    (I. Rechenberg, Evolutionsstrategie, 1973); where the step gets small, it starts again from another random motion.

    Examples
    --------
    A pendulum: inertia, weight and friction.

    >>> def regressor(q, v, a):
    ...     return np.stack([a, np.cos(q), v], axis=-1)
    >>> limits = JointLimits([-1.0], [1.0], [3.0], [20.0])
    >>> found = exciting_trajectory(regressor, ["inertia", "weight", "damping"], limits, period=5.0, evaluations=200)
    >>> bool(found.score < found.usual_score), bool(np.abs(found.sampled(100.0)[1]).max() <= 1.0)
    (True, True)
    """
    where = "exciting_trajectory"
    require_known("criterion", criterion, CRITERIA, where)
    if not 0 < period < np.inf or harmonics < 1 or random < 2 or evaluations < 0:
        raise InputError(
            f"{where}: period {period}, harmonics {harmonics}, random {random}, evaluations {evaluations}; expected a "
            "positive period, at least one harmonic, two random motions and no negative number"
        )
    joints = joint_names(joints, limits.joints, where)
    noise = checked_deviations(deviations, limits.joints, where)
    count = max(SAMPLES * harmonics, 2 * len(names) // limits.joints + 1)
    times = np.arange(count) * period / count
    rng = np.random.default_rng(seed)
    shapes = [rng.uniform(-1.0, 1.0, (limits.joints, 2 * harmonics + 1)) for _ in range(random)]
    tables = [regressor(*largest_motion(shape, period, limits).motion(times)) for shape in shapes]
    base = base_parameters(np.concatenate(tables), names)
    judge = _Judge(regressor, limits, period, times, base, noise, criterion)
    scored = [judge.scores(table) for table in tables]
    shape, (score, condition), history = _evolved(judge, shapes, scored, evaluations, rng)
    usual = np.median(np.array(scored), axis=0)
    message = (
        f"The condition number of the scaled columns is {condition:.3g}, that of random motions {usual[1]:.3g} "
        "(median). All limits hold at all times."
    )
    values = {"condition": condition, "random": float(usual[1]), "score": score}
    return ExcitingTrajectory(
        largest_motion(shape, period, limits),
        limits,
        joints,
        criterion,
        score,
        float(usual[0]),
        condition,
        float(usual[1]),
        history,
        seed,
        (Finding("exciting-trajectory", "note", values, message),),
    )


@dataclass(frozen=True, eq=False)
class _Judge:
    """Scores of regressors by a criterion, lower ones better."""

    regressor: Regressor
    limits: JointLimits
    period: float
    times: np.ndarray
    base: BaseParameters
    noise: np.ndarray
    criterion: str

    def of_shape(self, shape: np.ndarray) -> tuple[float, float]:
        """Scores of the largest motion of a shape (joints, 2 harmonics + 1) that keeps the limits."""
        return self.scores(self.regressor(*largest_motion(shape, self.period, self.limits).motion(self.times)))

    def scores(self, table: np.ndarray) -> tuple[float, float]:
        """Score and condition number of a regressor (samples, joints, parameters)."""
        rows = np.asarray(table, dtype=float)[..., self.base.independent] / self.noise[:, None]
        rows = rows.reshape(-1, self.base.rank)
        norms = np.linalg.norm(rows, axis=0)
        if not np.all(np.isfinite(norms)) or not np.all(norms > 0):
            return np.inf, np.inf
        singular = np.linalg.svd(rows / norms, compute_uv=False)
        if not singular[-1] > 0:
            return np.inf, np.inf
        condition = float(singular[0] / singular[-1])
        if self.criterion == "condition":
            return float(np.log(condition)), condition
        # log det(RᵀR) = 2 Σ log(singular values of scaled columns) + 2 Σ log(norms): units only add a constant.
        return float(-np.mean(np.log(singular)) - np.mean(np.log(norms))), condition


def _evolved(
    judge: _Judge,
    shapes: Sequence[np.ndarray],
    scored: Sequence[tuple[float, float]],
    evaluations: int,
    rng: np.random.Generator,
) -> tuple[np.ndarray, tuple[float, float], np.ndarray]:
    """Return the best shape, its scores, and the best score after each evaluation, the random ones included."""
    best = int(np.argmin([score for score, _ in scored]))
    shape, (score, condition) = shapes[best], scored[best]
    history = list(np.minimum.accumulate([value for value, _ in scored]))
    step, slow = FIRST, 1 / np.sqrt(shape.size + 1)
    parent, least = shape, score
    for _ in range(evaluations):
        child = np.clip(parent + step * rng.standard_normal(shape.shape), -1.0, 1.0)
        child_score = judge.of_shape(child)
        better = child_score[0] < least
        step *= np.exp(slow if better else -slow / 4)  # constant at one success in five
        if better:
            parent, least = child, child_score[0]
        if least < score:
            shape, (score, condition) = child, child_score
        if step < SMALLEST:
            parent, least, step = rng.uniform(-1.0, 1.0, shape.shape), np.inf, FIRST
        history.append(score)
    return shape, (score, condition), np.array(history)
