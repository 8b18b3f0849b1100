"""Physically consistent inertial parameters from torques."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from dalembert.errors import InputError, listed, unknown
from dalembert.findings import Finding
from dalembert.inverse.inertial.base_estimate import identify_base, joint_names, torque_findings
from dalembert.inverse.inertial.base_parameters import BaseParameters
from dalembert.inverse.inertial.consistent_estimate import ConsistentInertias
from dalembert.inverse.inertial.consistent_problem import ConsistentProblem
from dalembert.inverse.inertial.log_cholesky import log_cholesky, log_cholesky_jacobian
from dalembert.inverse.inertial.pseudo_inertia import bregman_distances, smallest_eigenvalues
from dalembert.inverse.inertial.stacked import checked_regressor, checked_torques
from dalembert.inverse.problem.search_findings import converged

LEAST = 1e-2  # smallest eigenvalue relative to the prior of a projected start
# Half the squared Newton decrement below which the point is stationary: the objective would fall by no more. Rounding
# errors of the residuals may be larger where the torques are nearly exact, see :func:`_settled`.
DECREMENT = 1e-8
EDGE = 1e-4  # smallest eigenvalue relative to the prior below which a link is nearly one that cannot exist
NEAR = 1e-7  # the same, below which whole steps are taken while it falls
STEPS = 100  # most Newton steps
DECADES = 10  # largest factor of the regularisation, as a power of ten, where a path of problems begins
SHORTEST = 1e-10  # smallest part of a Newton step


def identify_inertias(
    regressor: np.ndarray,
    torques: np.ndarray,
    names: Sequence[str],
    prior: np.ndarray | Sequence[float],
    *,
    links: Sequence[str],
    joints: Sequence[str] = (),
    positive: Sequence[str] = (),
    regularisation: float = 1.0,
    base: BaseParameters | None = None,
    deviations: float | Sequence[float] | None = None,
) -> ConsistentInertias:
    """Identify inertial parameters that bodies can have, near prior ones.

    Parameters
    ----------
    regressor : array, shape (samples, joints, parameters)
        Its first columns are those of the links, ten each, in the order of
        :data:`~dalembert.inverse.inertial.ENTRIES`; then columns of friction, motors and so on.
    torques : array, shape (samples, joints)
    names : sequence of str, length parameters
    prior : array, shape (parameters,)
        Values from CAD or a description of the robot. Those of each link must be those of a body that can exist.
    links : sequence of str
        Names of the links.
    joints : sequence of str, optional
    positive : sequence of str
        Names of other parameters that are positive, such as friction and armature; their prior values are, too.
    regularisation : float
        γ, positive. 1 is about a standard deviation of 70 % of the prior inertias.
    base : BaseParameters, optional
        If not given, those of the regressor.
    deviations : float or sequence of float, length joints, optional
        Standard deviations of the torques, N m or N. If not given, those of :func:`identify_base`.

    Raises
    ------
    InputError
        For other shapes, a prior that no body can have, unknown names, or a regularisation that is not positive.

    Notes
    -----
    Minimises Σ_j ‖Y_j θ − τ_j‖² / σ_j² + γ Σ_i D(P_i, P_i⁰), with the log-det Bregman distance D of pseudo-inertias,
    over log-Cholesky parameters relative to the prior, and over logarithms of positive parameters with the distance
    p/p₀ − 1 − log(p/p₀). The search starts at the prior or at the projected least-squares solution, whichever is
    better. By θ the objective is convex, so there are no other minima, and Newton's method with exact Hessians steps
    there. The gradient by log-Cholesky parameters is zero at the same point. The covariance is the inverse of the
    Hessian of half the objective by θ.

    Source: T. Lee, P. M. Wensing, F. C. Park, IEEE Transactions on Robotics 36 (2020); C. Rucker, P. M. Wensing, IEEE
    Robotics and Automation Letters 7 (2022).

    Examples
    --------
    A body that turns about z: the torque depends on one of its ten parameters. The prior mass is kept nearly.

    >>> acceleration = np.sin(np.arange(50.0))
    >>> columns = np.zeros((50, 1, 10))
    >>> columns[:, 0, 6] = acceleration
    >>> torques = 0.03 * acceleration[:, None] + 1e-3 * np.random.default_rng(0).standard_normal((50, 1))
    >>> sphere = [5.0, 0, 0, 0, 0.02, 0.02, 0.02, 0, 0, 0]
    >>> from dalembert.inverse.inertial import parameter_names
    >>> found = identify_inertias(columns, torques, parameter_names(["ball"]), sphere, links=["ball"])
    >>> round(float(found.values[6]), 3), bool(found.eigenvalues[0] > 0.5), found.success
    (0.03, True, True)
    """
    where = "identify_inertias"
    table = checked_regressor(regressor, names, where)
    measured = checked_torques(torques, table, where)
    joints = joint_names(joints, table.shape[1], where)
    known = _checked_prior(prior, names, links, positive, where)
    if not 0 < regularisation < np.inf:
        raise InputError(f"{where}: regularisation is {regularisation}; expected a positive number, such as 1.0")
    plain = identify_base(table, measured, names, joints=joints, base=base, deviations=deviations)
    triangle, right = _compressed(table, measured, plain.noise)
    chosen = np.isin(names, positive)
    problem = ConsistentProblem(triangle, right, known, len(links), chosen, float(regularisation))
    started, unknowns = _start(problem, plain.base, plain.values)
    values, decrement, steps = _minimised(problem, problem.parameters(unknowns))
    if not decrement < _settled(problem, values):
        started, values, decrement, steps = "prior", *_followed(problem)
    root = _covariance_root(problem, values)
    mixed = plain.base.combinations
    spread = mixed @ root
    inertial, tail = values[: 10 * len(links)].reshape(-1, 10), slice(10 * len(links), None)
    before = known[: 10 * len(links)].reshape(-1, 10)
    logs = log_cholesky(inertial)
    slope = problem.slope(values)
    by_logs = np.array([log_cholesky_jacobian(row).T @ slope[10 * k : 10 * k + 10] for k, row in enumerate(logs)])
    eigenvalues = smallest_eigenvalues(inertial, before)
    residuals = measured - table @ values
    success = decrement < _settled(problem, values)
    end = converged(success, f"{steps} steps, half the squared Newton decrement {decrement:.1g}")
    findings = (*_findings(links, eigenvalues), *torque_findings(joints, residuals))
    return ConsistentInertias(
        base=plain.base,
        links=tuple(links),
        joints=joints,
        prior=known,
        values=values,
        deviations=np.linalg.norm(root, axis=1),
        base_values=mixed @ values,
        base_covariance=spread @ spread.T,
        plain_values=plain.values,
        plain_covariance=plain.covariance,
        noise=plain.noise,
        noise_is_known=plain.noise_is_known,
        log_cholesky=logs,
        gradient=by_logs,
        other_gradient=(problem.slope(values) * np.where(chosen, values, 1.0))[tail],
        eigenvalues=eigenvalues,
        plain_eigenvalues=smallest_eigenvalues(
            _spread(problem, plain.base, plain.values)[: inertial.size].reshape(-1, 10), before
        ),
        distances=bregman_distances(inertial, before),
        residual=np.sqrt(np.mean(residuals**2, axis=0)),
        regularisation=float(regularisation),
        started=started,
        steps=steps,
        decrement=decrement,
        success=success,
        outcome=(end,),
        findings=findings,
    )


def _checked_prior(
    prior: object, names: Sequence[str], links: Sequence[str], positive: Sequence[str], where: str
) -> np.ndarray:
    """Return prior values (parameters,)."""
    values = np.asarray(prior, dtype=float)
    if values.shape != (len(names),) or not np.all(np.isfinite(values)):
        raise InputError(f"{where}: the prior has the shape {values.shape}; expected ({len(names)},) finite numbers")
    if not 0 < 10 * len(links) <= len(names):
        raise InputError(
            f"{where}: {len(links)} links have {10 * len(links)} parameters, and there are {len(names)}; expected ten "
            "parameters a link first, then others"
        )
    for name in positive:
        if name not in names:
            raise InputError(unknown("parameter", name, names, where))
        if list(names).index(name) < 10 * len(links):
            raise InputError(f"{where}: {name!r} belongs to a link. Name only other parameters as positive")
        if not values[list(names).index(name)] > 0:
            raise InputError(
                f"{where}: the prior of {name!r} is {values[list(names).index(name)]:g}; expected a positive number. "
                "Give an expected size"
            )
    of_links = values[: 10 * len(links)].reshape(-1, 10)
    for link, row in zip(links, of_links, strict=True):
        try:
            log_cholesky(row)
        except np.linalg.LinAlgError:
            raise InputError(
                f"{where}: no body can have the prior inertia of link {link!r} (mass {row[0]:g} kg). Check its mass, "
                "first moments and inertia about the origin of the link"
            ) from None
    return values


def _compressed(table: np.ndarray, torques: np.ndarray, noise: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """R and c with ‖R θ − c‖² = Σ ‖Y_j θ − τ_j‖² / σ_j² less a constant."""
    rows = (table / noise[:, None]).reshape(-1, table.shape[2])
    scale = np.linalg.norm(rows, axis=0)
    scale[scale == 0] = 1.0
    basis, triangle = np.linalg.qr(rows / scale)
    return triangle * scale, basis.T @ (torques / noise).ravel()


def _spread(problem: ConsistentProblem, base: BaseParameters, values: np.ndarray) -> np.ndarray:
    """Parameters with given base parameters that are nearest to the prior, relative to its sizes."""
    size = np.linalg.norm(_covariance_root(problem, problem.prior), axis=1)
    mixed = base.combinations * size
    return problem.prior + size * (np.linalg.pinv(mixed) @ (values - base.combinations @ problem.prior))


def _start(problem: ConsistentProblem, base: BaseParameters, values: np.ndarray) -> tuple[str, np.ndarray]:
    """The better one of the prior and the projected least-squares solution, with its name."""
    starts = {
        "prior": np.zeros(len(problem.prior)),
        "projected": problem.start(_spread(problem, base, values), LEAST),
    }
    best = min(starts, key=lambda name: float(np.real(problem.value(starts[name]))))
    return best, starts[best]


def _followed(problem: ConsistentProblem) -> tuple[np.ndarray, float, int]:
    """The same from the prior, by problems whose regularisation decreases to that of the problem."""
    values, decrement, steps = problem.prior, np.inf, 0
    for power in np.arange(DECADES, -0.5, -0.5):
        scaled = replace(problem, regularisation=problem.regularisation * 10.0**power)
        values, decrement, count = _minimised(scaled, values)
        steps += count
    return values, decrement, steps


def _minimised(problem: ConsistentProblem, start: np.ndarray) -> tuple[np.ndarray, float, int]:
    """Parameters at the minimum, half the squared Newton decrement, and the number of steps. Newton's method by θ with
    a line search that keeps links possible: the objective is convex there, and combinations that the torques determine
    well are straight. It is curved over log-Cholesky parameters.
    """
    values, misfit, last = start, problem.value_at(start), np.inf
    for steps in range(STEPS):
        step, decrement = newton_step(problem, values)
        if not np.isfinite(decrement):
            return values, decrement, steps
        if decrement < NEAR:  # the objective changes by less than its rounding errors
            if not decrement < 0.1 * last or not np.isfinite(problem.value_at(values + step)):
                return values, decrement, steps
            values, last, misfit = values + step, decrement, np.inf
            continue
        size = 1.0
        while size > SHORTEST and not problem.value_at(values + size * step) < misfit - 1e-4 * size * decrement:
            size *= 0.5
        if size <= SHORTEST:
            return values, decrement, steps
        values = values + size * step
        misfit = problem.value_at(values)
    return values, newton_step(problem, values)[1], STEPS


def newton_step(problem: ConsistentProblem, values: np.ndarray) -> tuple[np.ndarray, float]:
    """Newton's step by θ (parameters,), and half the squared Newton decrement."""
    try:
        rows, right = problem.linearised(values)
    except np.linalg.LinAlgError:  # a link that nearly cannot exist
        return np.zeros_like(values), np.inf
    scale = np.linalg.norm(rows, axis=0)
    scale[scale == 0] = 1.0
    step = -np.linalg.lstsq(rows / scale, right, rcond=None)[0] / scale
    return step, 0.5 * float(np.sum((rows @ step) ** 2))


def _settled(problem: ConsistentProblem, values: np.ndarray) -> float:
    """Half the squared Newton decrement of a stationary point: no less than rounding errors of the residuals make."""
    return max(DECREMENT, problem.rounding(values))


def _covariance_root(problem: ConsistentProblem, values: np.ndarray) -> np.ndarray:
    """Q (parameters, rows) with Q Qᵀ the inverse of the Hessian by θ."""
    rows, _ = problem.linearised(values)
    scale = np.linalg.norm(rows, axis=0)
    scale[scale == 0] = 1.0
    return np.linalg.pinv(rows / scale) / scale[:, None]


def _findings(links: Sequence[str], eigenvalues: np.ndarray) -> Iterator[Finding]:
    """Yield whether all links are consistent, and which are nearly not."""
    least = int(np.argmin(eigenvalues))
    values = {"link": links[least], "eigenvalue": float(eigenvalues[least])}
    near = [repr(link) for link, size in zip(links, eigenvalues, strict=True) if size < EDGE]
    if near:
        yield Finding(
            "inertia-at-edge",
            "warning",
            values,
            f"The inertias of {listed(near)} are at the edge of those that bodies can have (smallest eigenvalue "
            f"{eigenvalues[least]:.2g} of the prior one).",
            "Check the signs and units of the torques, and add what the model lacks, or increase the regularisation.",
        )
    else:
        yield Finding(
            "consistent-inertias",
            "note",
            values,
            "All links are physically consistent: the smallest eigenvalue of a pseudo-inertia is "
            f"{eigenvalues[least]:.3g} of the prior one (link {links[least]!r}).",
        )
