"""Base parameters: the combinations of parameters that torques depend on."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from scipy.linalg import qr, solve_triangular

from dalembert.errors import InputError, counted
from dalembert.findings import Finding
from dalembert.inverse.inertial.stacked import checked_regressor
from dalembert.results import Result
from dalembert.stored_fields import Labels, Over
from dalembert.tables import Table, shown

# Size of a column, relative to the largest, and of a pivot, relative to the first, that are rounding errors.
ROUNDING = 1e-10
GAP = 10.0  # ratio of the last independent to the first dependent pivot below which the rank is not clear
ILL = 100.0  # condition number of the scaled columns above which a motion excites the parameters badly
TIE = 1e-9  # relative preference of a column to the next one, so that equal columns have a certain order
SAFETY = 3.0  # how many times the noise a pivot must exceed


@dataclass(frozen=True, eq=False)
class BaseParameters(Result):
    """Independent columns of a regressor Y, and the combinations of parameters that they stand for.

    Parameters
    ----------
    names : tuple of str, length parameters
    base : tuple of str, length base
        Each base parameter by the name of its independent column.
    independent : array of int, shape (base,)
        Independent columns, in the order of the parameters: Y θ = Y[:, independent] β.
    combinations : array, shape (base, parameters)
        K of β = K θ.
    pivots : array, shape (pivots,)
        Diagonal of R of the scaled columns, relative to the first one.
    threshold : float
        Smaller pivots are those of dependent columns.
    condition : float
        Condition number of the scaled independent columns.
    findings : tuple of Finding
    """

    FORMAT: ClassVar[str] = "dalembert baseparameters 1"
    TITLE: ClassVar[str] = "Base parameters"

    names: Annotated[tuple[str, ...], Labels("parameter")]
    base: Annotated[tuple[str, ...], Labels("base")]
    independent: Annotated[np.ndarray, Over("base")]
    combinations: Annotated[np.ndarray, Over("base", "parameter")]
    pivots: Annotated[np.ndarray, Over("pivot")]
    threshold: float
    condition: float
    findings: tuple[Finding, ...] = ()

    @property
    def rank(self) -> int:
        """Number of base parameters."""
        return len(self.base)

    @property
    def words(self) -> tuple[str, ...]:
        """The combinations in words, such as ``"m2 + 0.4 m3"``."""
        return tuple(
            _in_words(row, self.names, first) for row, first in zip(self.combinations, self.independent, strict=True)
        )

    @property
    def unidentifiable(self) -> tuple[str, ...]:
        """Parameters that no torque depends on."""
        return tuple(name for name, column in zip(self.names, self.combinations.T, strict=True) if not np.any(column))

    def values(self, parameters: np.ndarray) -> np.ndarray:
        """Base parameters (..., base) of parameters (..., parameters)."""
        return np.asarray(parameters) @ self.combinations.T

    def facts(self) -> dict[str, str]:
        return {"rank": f"{self.rank} of {len(self.names)}", "condition number": shown(self.condition, digits=4)}

    def tables(self) -> tuple[Table, ...]:
        """Return the combinations of parameters."""
        columns = {"base parameter": self.base, "combination": self.words}
        return (Table.of("base", "Combinations that torques depend on", columns),)


def base_parameters(regressor: np.ndarray, names: Sequence[str], *, noise: float = 0.0) -> BaseParameters:
    """Return the base parameters of torques τ = Y θ.

    Parameters
    ----------
    regressor : array, shape (samples, joints, parameters)
        Y at positions, velocities and accelerations that excite all joints.
    names : sequence of str, length parameters
    noise : float
        Relative standard deviation of the entries of the regressor, from noise of the positions and their derivatives;
        0 for exact motions. Combinations whose columns are smaller than three times this are dependent.

    Raises
    ------
    InputError
        For another shape, a number that is not finite, fewer rows than parameters, or a negative noise.

    Notes
    -----
    With columns scaled to the norm 1, QR with pivoting gives Y D⁻¹ Π = Q [[R1, R2], [0, ~0]]; the combinations are
    β = θ1 + D1⁻¹ R1⁻¹ R2 D2 θ2. Which columns are independent is a choice; the subspace is not.

    Source: M. Gautier, Numerical calculation of the base inertial parameters of robots, Journal of Robotic Systems 8
    (1991).

    Examples
    --------
    Two masses at the ends of one lever: the torque contains only their sum.

    >>> acceleration = np.sin(np.arange(20.0))
    >>> found = base_parameters(np.stack([acceleration, 0.4 * acceleration], axis=-1)[:, None], ["m2", "m3"])
    >>> found.words
    ('m2 + 0.4 m3',)
    """
    table, names = checked_regressor(regressor, names, "base_parameters"), tuple(names)
    if not 0 <= noise < 1:
        raise InputError(f"base_parameters: noise is {noise}; expected a relative size from 0 to 1, such as 0.01")
    stacked = table.reshape(-1, len(names))
    sizes = np.linalg.norm(stacked, axis=0)
    if not np.any(sizes):
        raise InputError("base_parameters: the regressor is zero. Give a regressor along a motion")
    seen = np.flatnonzero(sizes > ROUNDING * sizes.max())
    sizes = sizes * (1.0 + TIE * np.arange(len(sizes)))
    threshold = max(ROUNDING, SAFETY * noise)
    scaled = stacked[:, seen] / sizes[seen]
    # A first QR without pivoting makes the table small.
    small = np.linalg.qr(scaled, mode="r") if len(scaled) > scaled.shape[1] else scaled
    factors = qr(small, mode="r", pivoting=True)
    triangle, order = np.asarray(factors[0])[: scaled.shape[1]], np.asarray(factors[-1])
    pivots = np.abs(np.diagonal(triangle)) / np.abs(triangle[0, 0])
    rank = int(np.count_nonzero(pivots > threshold))
    first, rest = seen[order[:rank]], seen[order[rank:]]
    mixed = solve_triangular(triangle[:rank, :rank], triangle[:rank, rank:])
    mixed[np.abs(mixed) < ROUNDING**0.75] = 0.0
    combinations = np.zeros((rank, len(names)))
    combinations[np.arange(rank), first] = 1.0
    combinations[:, rest] = mixed * sizes[rest] / sizes[first][:, None]
    sort = np.argsort(first)
    first = first[sort]
    condition = float(np.linalg.cond(triangle[:rank, :rank]))
    base = tuple(names[k] for k in first)
    findings = tuple(_findings(pivots, rank, condition))
    return BaseParameters(names, base, first, combinations[sort], pivots, threshold, condition, findings)


def _findings(pivots: np.ndarray, rank: int, condition: float) -> Iterator[Finding]:
    """Yield that the rank is not clear, or that the motion excites the parameters badly."""
    after = float(pivots[rank]) if rank < len(pivots) else 0.0
    last = float(pivots[rank - 1])
    if last < GAP * after:
        yield Finding(
            "unclear-rank",
            "warning",
            {"rank": rank, "last": last, "next": after},
            f"The rank {rank} is not clear: the last independent pivot is {last:.2g}, the next one {after:.2g}.",
            "Use a motion that excites the joints more, or give the noise of the regressor.",
        )
    if condition > ILL:
        yield Finding(
            "ill-conditioned-regressor",
            "warning",
            {"condition": condition, "limit": ILL},
            f"The condition number of the {counted(rank, 'scaled column')} is {condition:.3g}, more than {ILL:g}.",
            "Use an exciting trajectory, or more of them.",
        )


def _in_words(row: np.ndarray, names: Sequence[str], first: int) -> str:
    """A combination in words, the independent parameter first."""
    text = names[first]
    for k in map(int, np.flatnonzero(row)):
        if k != first:
            size = f"{abs(row[k]):.4g}"
            text += f" {'+' if row[k] > 0 else '−'} {names[k] if size == '1' else f'{size} {names[k]}'}"
    return text
