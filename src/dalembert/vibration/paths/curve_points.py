"""Points of a curve: solved again, in all degrees of freedom, and which of these are observed."""

from collections.abc import Sequence

import numpy as np

from dalembert.errors import InputError
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.harmonic_balance import RECEPTANCE
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.balance.receptance_balance import ReceptanceBalance
from dalembert.vibration.fourier import in_orders
from dalembert.vibration.interface.lowering import Lowered
from dalembert.vibration.paths.curve import FrequencyCurve

ALL = 60
"""Size up to which all degrees of freedom are observed if none are named."""


def restarted(problem: Equations, curve: FrequencyCurve, point: int, where: str) -> Solution:
    """Solve a point of a curve again. ``where`` is the caller, for errors."""
    if not -len(curve) <= point < len(curve):
        raise InputError(
            f"{where}: the point is {point}; expected a number below {len(curve)}, the points of the curve"
        )
    unknowns, samples, orders = curve.unknowns[point], int(curve.samples[point]), problem.method.orders
    by_receptances = curve.provenance["method"].get("solver") == RECEPTANCE
    if by_receptances != problem.by_receptances or "control" in curve.provenance:
        # Unknowns of another solver, or with a row more for a held amplitude.
        balance, rows = problem.balance(problem.method.first_samples), curve.displacements[point]
        if isinstance(balance, ReceptanceBalance) and len(rows) == problem.lowered.seen:
            unknowns = balance.unknowns(rows, curve.forces[point])
        elif len(rows) == problem.lowered.seen:
            unknowns = rows[problem.lowered.coordinates.rows]
    if set(curve.orders) < set(orders):
        unknowns, samples = in_orders(unknowns, curve.orders, orders), max(samples, problem.method.first_samples)
    if unknowns.shape != problem.balance(samples).shape or not set(curve.orders) <= set(orders):
        raise InputError(
            f"{where}: the start has unknowns of shape {unknowns.shape} and harmonics {curve.orders}; the "
            f"system has {problem.balance(samples).shape} and {orders}; "
            "start from a curve of the same system"
        )
    return problem.solve(unknowns, problem.omega(curve.frequencies[point]), samples)


def measured_again(problem: Equations, before: Equations, solution: Solution) -> Solution:
    """Return a solution of a system in the unknowns of equations that measure one of its degrees of freedom."""
    if not problem.lowered.added:
        return solution
    # Rows that elements see, then the one that was added.
    known, balance = solution.unknowns, before.balance(solution.samples)
    rows = known if problem.by_receptances else balance.displacements(known)
    rows = np.vstack([rows, response_of(before, solution, problem.lowered.matrix[[-1]].nonzero()[1])])
    unknowns = rows if problem.by_receptances else rows[problem.lowered.coordinates.rows]
    return problem.solve(unknowns, solution.omega, solution.samples)


def require_full_load(curve: FrequencyCurve, where: str) -> None:
    """Raise InputError for a curve whose amplitude is held, which the forces of the system do not cause."""
    if "control" in curve.provenance:
        raise InputError(
            f"{where}: the curve has a held amplitude, so that its forces are not those of the system. Compute a curve "
            "without control"
        )


def observed(lowered: Lowered, names: Sequence[str] | None) -> np.ndarray:
    """Return the rows of the observed degrees of freedom: those named, or all, or those with forces and elements."""
    structure = lowered.structure
    if names is not None:
        return np.array(structure.rows(names), dtype=int)
    if structure.size <= ALL:
        return np.arange(structure.size)
    forced = [structure.dofs.index(dof) for force in lowered.forces for dof in force.dofs]
    rows = np.unique([*forced, *lowered.matrix.nonzero()[1]]).astype(int)
    return rows if len(rows) else np.arange(structure.size)


def response_of(problem: Equations, solution: Solution, dofs: np.ndarray | None = None) -> np.ndarray:
    """Return the coefficients of all degrees of freedom at a solution, or of some, (dofs, coefficients)."""
    return problem.motion(solution.point, solution.unknowns, solution.samples, dofs)
