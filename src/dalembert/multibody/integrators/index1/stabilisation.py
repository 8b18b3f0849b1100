"""How a method that integrates the differentiated constraints keeps to the constraints themselves."""

__all__ = ["Augmented", "Baumgarte", "Partitioning", "Projection"]

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from dalembert.arguments import Checked, limited
from dalembert.errors import InputError
from dalembert.multibody.integrators.index1.index1 import AS_THEY_COME, PARTITIONED, PROJECTED, Terms
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.model.evaluate import constraint_jacobian
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.start.assemble import redundancy


class Stabilisation(Checked):
    """What is done about the drift of positions and velocities off the constraints; a frozen dataclass."""

    way: int = AS_THEY_COME

    def gains(self, step: float | None) -> tuple[float, float]:
        """Coefficients alpha and beta (1/s) of the constraints' feedback, for a method of this fixed step (s)."""
        return 0.0, 0.0


@dataclass(frozen=True)
class Augmented(Stabilisation):
    """Nothing: the constraints hold at the level of acceleration, and positions and velocities drift off them.

    Examples
    --------
    >>> Augmented().gains(0.01)
    (0.0, 0.0)
    """


@dataclass(frozen=True)
class Baumgarte(Stabilisation):
    """Feedback of the constraints: their second rate is -2 alpha (first rate) - beta^2 (constraint) instead of zero.

    Parameters
    ----------
    alpha, beta : float, optional
        1/s, both or none. If not given alpha = 1/h and beta = sqrt(2)/h of a fixed step h, with which the
        constraints at the step's end vanish to the second order of their Taylor expansion.

    References
    ----------
    J. Baumgarte, Stabilization of constraints and integrals of motion in dynamical systems, Computer Methods in Applied
    Mechanics and Engineering 1 (1972). P. Flores and others, Investigation on the Baumgarte stabilization method for
    dynamic analysis of constrained multibody systems (2009).

    Examples
    --------
    >>> Baumgarte().gains(0.5)[0], Baumgarte(5.0, 5.0).gains(None)
    (2.0, (5.0, 5.0))
    """

    alpha: float | None = field(default=None, metadata={"unit": "1/s"})
    beta: float | None = field(default=None, metadata={"unit": "1/s"})

    def __post_init__(self) -> None:
        given = [value for value in (self.alpha, self.beta) if value is not None]
        if len(given) == 1 or not all(np.isfinite(value) and value > 0 for value in given):
            raise InputError(
                f"Baumgarte: alpha is {self.alpha} and beta is {self.beta}; expected two positive numbers (1/s), or "
                "none of them, which takes 1/h and sqrt(2)/h of a fixed step h"
            )

    def gains(self, step: float | None) -> tuple[float, float]:
        """Alpha and beta, by the step if they were not given."""
        if self.alpha is not None and self.beta is not None:
            return float(self.alpha), float(self.beta)
        if step is None:
            raise InputError(
                "Baumgarte: neither alpha nor beta was given, and the integrator chooses its step by the error; give "
                "both (1/s), such as Baumgarte(alpha=10.0, beta=10.0), or use Projection() or Partitioning()"
            )
        return 1.0 / step, np.sqrt(2.0) / step


@dataclass(frozen=True)
class Projection(Stabilisation):
    """After each accepted step coordinates and velocities are moved onto the constraints, by the least kinetic energy.

    With the constraint Jacobian J and the mass matrix M the coordinates q are moved by a solution of
    M dq + J^T m = 0 and constraint(q - dq) = 0, to rounding; the velocities alike.

    References
    ----------
    E. Eich, Convergence results for a coordinate projection method applied to mechanical systems with algebraic
    constraints, SIAM Journal on Numerical Analysis 30 (1993).

    Examples
    --------
    >>> Projection()
    Projection()
    """

    way = PROJECTED


@dataclass(frozen=True)
class Partitioning(Stabilisation):
    """Only independent coordinates are integrated; the others follow from the constraints, by Newton's iteration.

    The dependent ones are those of the pivots of the constraint Jacobian. They are chosen anew when one of them changes
    more than ``limit`` times as much as an independent one that moves it, each relative to its scale. The matrices are
    dense: it is for small models.

    Parameters
    ----------
    limit : float

    References
    ----------
    R. A. Wehage and E. J. Haug, Generalized coordinate partitioning for dimension reduction in analysis of constrained
    dynamic systems, Journal of Mechanical Design 104 (1982).

    Examples
    --------
    >>> Partitioning().limit
    10.0
    """

    limit: float = limited(10.0, unit="", above=1)
    way = PARTITIONED


def posed(
    stabilisation: Stabilisation, samples: Sequence[Lowered], problem: IntegrationProblem, step: float | None
) -> tuple[IntegrationProblem, Terms]:
    """The problem with the matrices that the index-1 methods need, and what they need to know."""
    redundant = any(redundancy(lowered).rank < redundancy(lowered).count for lowered in samples)
    if redundant:
        problem = problem._replace(scale=_weighed(problem, samples[0]))
    if redundant or stabilisation.way == PARTITIONED:
        slots, layout = samples[0].structure.full.dense
        problem = problem._replace(exact_slots=slots, exact_layout=layout)
    alpha, beta = stabilisation.gains(step)
    limit = float(getattr(stabilisation, "limit", 0.0))
    nonlinear = any(kind.takes_reactions for kind in samples[0].data)
    return problem, Terms(float(alpha), float(beta), redundant, stabilisation.way, limit, nonlinear)


def _weighed(problem: IntegrationProblem, lowered: Lowered) -> np.ndarray:
    """Scales with those of the multipliers: one for forces, a lever for torques, (N + 1,). The lever is the power of
    ten, in m, nearest to the mechanism's extent where the model is built first, so that it is the same for all
    parameters of a model. A multiplier is a torque where its constraint depends on no position.
    """
    n, scale = problem.n, problem.scale.copy()
    positions = np.array(lowered.structure.kinds) == "position"
    lever = 10.0 ** np.round(np.log10(scale[:n][positions].max(initial=1e-300))) if positions.any() else 1.0
    jacobian = abs(constraint_jacobian(lowered, np.real(lowered.x)))
    held = np.asarray(jacobian[:, np.flatnonzero(positions)].sum(axis=1)).ravel() > 0
    scale[n:-1] = np.where(held, 1.0, lever)
    return scale
