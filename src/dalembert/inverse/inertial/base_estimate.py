"""Base parameters from torques by weighted least squares, with their standard deviations."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from scipy.special import ndtri

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.inverse.fit.fit import check_level
from dalembert.inverse.inertial.base_parameters import BaseParameters, base_parameters
from dalembert.inverse.inertial.stacked import checked_deviations, checked_regressor, checked_torques
from dalembert.inverse.problem.search_findings import converged
from dalembert.results import EndedResult
from dalembert.stored_fields import Labels, Over
from dalembert.tables import Table, cell, cells, counted
from dalembert.units import inertial_unit

ITERATIONS = 100  # most iterations of the weights
SETTLED = 1e-8  # relative change of the standard deviations at which the weights are converged
# Lag-1 autocorrelation, in standard deviations of that of white noise, from which residuals are correlated.
CORRELATED = 4.0


@dataclass(frozen=True, eq=False)
class BaseEstimate(EndedResult):
    """Base parameters from torques.

    Parameters
    ----------
    base : BaseParameters
    joints : tuple of str, length joints
    values : array, shape (base,)
    covariance : array, shape (base, base)
    noise : array, shape (joints,)
        Standard deviation of the torques of each joint.
    noise_is_known : bool
        Whether it was given; else it is estimated from the residuals.
    iterations : int
    outcome, findings : tuple of Finding
    """

    FORMAT: ClassVar[str] = "dalembert baseestimate 1"
    TITLE: ClassVar[str] = "Base parameters"
    VERDICTS: ClassVar[tuple[str, str]] = ("identified", "not identified")

    base: BaseParameters
    joints: Annotated[tuple[str, ...], Labels("joint")]
    values: Annotated[np.ndarray, Over("base")]
    covariance: Annotated[np.ndarray, Over("base", "base_")]
    noise: Annotated[np.ndarray, Over("joint")]
    noise_is_known: bool
    iterations: int
    outcome: tuple[Finding, ...]
    findings: tuple[Finding, ...] = ()

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviations (base,)."""
        return np.sqrt(np.diagonal(self.covariance))

    def intervals(self, level: float = 0.95) -> dict[str, tuple[float, float]]:
        """Interval of each base parameter that contains its true value with a probability."""
        return intervals(self.base.base, self.values, self.deviations, level)

    def torques(self, regressor: np.ndarray) -> np.ndarray:
        """Torques (samples, joints) along another motion, from its regressor (samples, joints, parameters)."""
        return np.asarray(regressor)[..., self.base.independent] @ self.values

    @property
    def success(self) -> bool:
        """Whether the weights converged."""
        return not any(finding.severity == "error" for finding in self.outcome)

    @property
    def conclusions(self) -> tuple[Finding, ...]:
        return (*self.outcome, *self.base.findings, *self.findings)

    def facts(self) -> dict[str, str]:
        return {"base parameters": counted(self.base.rank), "joints": counted(len(self.joints))}

    def tables(self) -> tuple[Table, ...]:
        """Return the base parameters, and the noise of each joint."""
        return (
            base_table(self.base, self.values, self.deviations),
            noise_table(self.joints, self.noise, self.noise_is_known),
        )


def identify_base(
    regressor: np.ndarray,
    torques: np.ndarray,
    names: Sequence[str],
    *,
    joints: Sequence[str] = (),
    base: BaseParameters | None = None,
    deviations: float | Sequence[float] | None = None,
) -> BaseEstimate:
    """Identify base parameters from torques τ = Y θ by weighted least squares.

    Parameters
    ----------
    regressor : array, shape (samples, joints, parameters)
    torques : array, shape (samples, joints)
    names : sequence of str, length parameters
    joints : sequence of str, optional
        Names of the joints; ``"1"``, ``"2"`` ... if not given.
    base : BaseParameters, optional
        If not given, those of the regressor.
    deviations : float or sequence of float, length joints, optional
        Standard deviations of the torques, N m or N. If not given, they are estimated from the residuals of each joint,
        and the weights are iterated.

    Raises
    ------
    InputError
        For other shapes, numbers that are not finite, too few samples, or deviations that are not positive.

    Notes
    -----
    Minimises Σ_j ‖Y_j β − τ_j‖² / σ_j². Without given deviations, σ_j² = ‖r_j‖² / (n − h_j) of the residuals r_j of
    joint j, with the trace h_j of its part of the hat matrix. Standard deviations hold for noise that is not
    correlated: after a filter, use every second sample of its cutoff frequency (:func:`filtered_motion`).

    Source: M. Gautier, Ph. Poignet, Extended Kalman filtering and weighted least squares dynamic identification of
    robot, Control Engineering Practice 9 (2001).

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> motion = rng.standard_normal((200, 1, 2))
    >>> found = identify_base(motion, motion @ [2.0, 0.5] + 0.1 * rng.standard_normal((200, 1)), ["inertia", "damping"])
    >>> bool(np.all(np.abs(found.values - [2.0, 0.5]) < 3 * found.deviations)), round(float(found.noise[0]), 2)
    (True, 0.1)
    """
    where = "identify_base"
    table = checked_regressor(regressor, names, where)
    measured = checked_torques(torques, table, where)
    joints = joint_names(joints, table.shape[1], where)
    base_columns = base if base is not None else base_parameters(table, names)
    known = None if deviations is None else checked_deviations(deviations, len(joints), where)
    columns = table[..., base_columns.independent]
    if columns.shape[0] * columns.shape[1] <= base_columns.rank:
        raise InputError(
            f"{where}: {columns.shape[0]} samples for {base_columns.rank} base parameters. Give more samples"
        )
    noise = np.ones(len(joints)) if known is None else known
    change, count = np.inf, 0
    while True:
        values, basis, triangle = _weighted(columns, measured, noise)
        residuals = measured - columns @ values
        if known is not None or change < SETTLED or count == ITERATIONS:
            break
        left = columns.shape[0] - np.sum(basis**2, axis=(0, 2))
        previous, noise = noise, np.sqrt(np.sum(residuals**2, axis=0) / np.maximum(left, 1.0))
        noise = np.maximum(noise, 1e-12 * np.max(np.abs(measured)))
        change, count = float(np.max(np.abs(noise / previous - 1))), count + 1
    inverse = np.linalg.inv(triangle)
    end = converged(known is not None or change < SETTLED, f"{count} iterations of the weights")
    findings = tuple(torque_findings(joints, residuals))
    return BaseEstimate(
        base_columns, joints, values, inverse @ inverse.T, noise, known is not None, count, (end,), findings
    )


def _weighted(columns: np.ndarray, torques: np.ndarray, noise: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Least squares with weights 1 / noise; also Q (samples, joints, base) and R of the weighted columns."""
    weighted = (columns / noise[:, None]).reshape(-1, columns.shape[2])
    scale = np.linalg.norm(weighted, axis=0)
    basis, triangle = np.linalg.qr(weighted / scale)
    triangle = triangle * scale
    values = np.linalg.solve(triangle, basis.T @ (torques / noise).ravel())
    return values, basis.reshape(columns.shape), triangle


def torque_findings(joints: Sequence[str], residuals: np.ndarray) -> Iterator[Finding]:
    """Yield a finding if residuals (samples, joints) are correlated from sample to sample."""
    squares = np.sum(residuals**2, axis=0)
    first = np.sum(residuals[1:] * residuals[:-1], axis=0) / np.where(squares > 0, squares, 1.0)
    worst = int(np.argmax(np.abs(first)))
    if abs(first[worst]) * np.sqrt(len(residuals)) > CORRELATED:
        yield Finding(
            "correlated-torques",
            "warning",
            {"joint": joints[worst], "autocorrelation": float(first[worst])},
            f"The residuals of the torques are correlated, most at joint {joints[worst]!r} (lag-1 autocorrelation "
            f"{first[worst]:.2f}). The standard deviations are too small.",
            "Decimate filtered data. If that does not help, add what the model lacks, for example friction.",
        )


def joint_names(joints: Sequence[str], count: int, where: str) -> tuple[str, ...]:
    """Return names of joints, ``"1"``, ``"2"`` ... if none are given."""
    names = tuple(joints) or tuple(str(k + 1) for k in range(count))
    if len(names) != count:
        raise InputError(f"{where}: {len(names)} names of joints; expected {count}, as the regressor has")
    return names


def intervals(
    names: Sequence[str], values: np.ndarray, deviations: np.ndarray, level: float
) -> dict[str, tuple[float, float]]:
    """Intervals by name: value ∓ quantile of the normal distribution × standard deviation."""
    check_level(level, "intervals")
    radius = float(ndtri((1 + level) / 2)) * deviations
    return dict(zip(names, zip((values - radius).tolist(), (values + radius).tolist(), strict=True), strict=True))


def base_table(base: BaseParameters, values: np.ndarray, deviations: np.ndarray) -> Table:
    """Return the table of base parameters."""
    columns = {
        "combination": base.words,
        "value": map(cell, values, deviations),
        "standard deviation": cells(deviations, 2),
        "unit": map(inertial_unit, base.base),
    }
    return Table.of("base", "Base parameters: the combinations that torques determine", columns)


def noise_table(joints: Sequence[str], noise: np.ndarray, known: bool, **more: np.ndarray) -> Table:
    """Return the noise of each joint, and more columns (joints,)."""
    source = "given" if known else "from the residuals"
    caption = f"Standard deviation of the noise of each joint, in N m, of a prismatic joint in N ({source})"
    columns = {"joint": joints, "noise": noise, **more}
    return Table.of("noise", caption, {name: cells(column, 3) for name, column in columns.items()})
