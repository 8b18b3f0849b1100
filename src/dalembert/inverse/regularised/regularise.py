"""Identify many parameters that are smooth: unknown histories and fields."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import cho_factor, cho_solve, solve_triangular

from dalembert.argument_readers import check_integer, names_of
from dalembert.data import Measurements
from dalembert.errors import InputError, SolveError, counted, listed, repeated, require_known
from dalembert.findings import Finding
from dalembert.forward import ForwardModel
from dalembert.forward.adjoint import AUTO, GRADIENTS
from dalembert.forward.provenance import provenance
from dalembert.inverse.events import OnEvent, Penalised
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import Linearisation, MisfitProblem, pose
from dalembert.inverse.regularised.regularised_fit import RegularisedFit
from dalembert.inverse.regularised.smoothness import Smoothed, differences
from dalembert.optimize import Minimiser
from dalembert.parameters import Parameters

L_CURVE, DISCREPANCY, GIVEN = "l-curve", "discrepancy", "given"
_SETTLED = 0.05  # relative change of the weight at which the rounds end
_CONVERGED = 1e-3  # relative decrease of the penalised misfit that the linearised problem promises
_HALVINGS = 8  # of the way to the linear solution
_NAMED = 4  # undetermined parameters in a message
_SEEN = 1e-6  # part of an undetermined combination from which a parameter is named
_REACH = 1e3  # standard deviations from the linear solution that the minimiser may go
_STEPS = {"maxiter": 30, "ftol": 1e-10, "gtol": 1e-6}


def regularise(
    model: ForwardModel,
    data: Measurements,
    *,
    smooth: Sequence[str] | None = None,
    order: int = 2,
    weight: float | str = L_CURVE,
    start: Mapping[str, float] | ArrayLike | None = None,
    derivative: str = AUTO,
    rounds: int = 8,
    on_event: OnEvent | None = None,
) -> RegularisedFit:
    """Parameters p that explain data, and are smooth: least Σ W (R(p) − data)² + μ² ‖D p/scale‖².

    Parameters
    ----------
    model : ForwardModel
        Bounds of its parameters give their scale; they do not limit the values.
    data : Measurements
        With their deviations, W = 1/deviation²; else W = 1.
    smooth : sequence of str, optional
        Names of the parameters whose differences D are penalised, in the order of the history or of the field; all if
        not given. Others are not penalised.
    order : int
        Of the differences: 2 for a history without a preferred value or slope.
    weight : float, "l-curve" or "discrepancy"
        μ, or how it is chosen: at the corner of the L-curve, or so that the residuals are as large as the noise, which
        the deviations of the data then must state.
    start : mapping or array, optional
        First guess; that of the parameters if not given.
    derivative : {"auto", "direct", "adjoint"}
        How gradients are computed, see :func:`dalembert.forward.pullback`.
    rounds : int
        Linearisations at most, after each of which the weight is chosen again.
    on_event : callable, optional
        Called with each event (see :mod:`dalembert.inverse.events`) as it happens.

    Returns
    -------
    RegularisedFit

    Raises
    ------
    InputError
        For an unknown name or rule, fewer smooth parameters than differences need, and the discrepancy principle
        without deviations.
    SolveError
        If the model cannot be simulated.

    Notes
    -----
    All sensitivities are computed once a round, for the L-curve of the linearised problem and as a preconditioner. With
    it the minimiser L-BFGS-B needs few gradients, which come from the adjoint where the model has one. Rounds end when
    the weight no longer changes, and the linearised problem would lower the sum by less than 0.1 %. Source: Hansen,
    Discrete Inverse Problems (2010).

    Examples
    --------
    >>> from dalembert.forward import PythonModel
    >>> times = np.linspace(0.0, 1.0, 41)
    >>> names = [f"c{k}" for k in range(12)]
    >>> def summed(**c):  # the integral of a history by pieces
    ...     return np.cumsum(np.interp(times, np.linspace(0, 1, 12), np.real(list(c.values())))
    ...                      + 1j * np.interp(times, np.linspace(0, 1, 12), np.imag(list(c.values())))) / 40
    >>> model = PythonModel(summed, dict.fromkeys(names, (-2.0, 2.0)), ["x"], times)
    >>> truth = np.sin(np.linspace(0, 3, 12))
    >>> noise = 1e-3 * np.random.default_rng(0).normal(size=(41, 1))
    >>> measured = model.evaluate(truth[None]).values[0] + noise
    >>> fit = regularise(model, Measurements.of(times, {"x": measured[:, 0]}, deviations={"x": 1e-3}))
    >>> bool(np.abs(fit.values - truth).max() < 0.05)
    True
    """
    require_known("derivative", derivative, GRADIENTS, "regularise")
    if isinstance(weight, str):
        require_known("weight", weight, (L_CURVE, DISCREPANCY), "regularise")
        if weight == DISCREPANCY and data.deviations is None:
            raise InputError(
                "regularise: the discrepancy principle needs the noise of the data. Give their deviations, or take "
                "weight='l-curve'"
            )
    problem = replace(pose(model, data, None, Journal(len(data.coordinate.values), on_event)), derivative=derivative)
    names = model.parameters.names
    chosen = tuple(names if smooth is None else names_of(smooth, "regularise", "smooth"))
    for name in chosen:
        require_known("parameter", name, names, "regularise")
    if len(chosen) <= order:
        raise InputError(
            f"regularise: {len(chosen)} smooth parameters have no differences of order {order}. "
            "Name more of them, or lower the order"
        )
    if several := repeated(chosen):
        raise InputError(
            f"regularise: smooth names {listed(list(map(repr, several)))} more than once. Name each parameter once, in "
            "the order in which the values change smoothly"
        )
    penalty = differences(np.array([names.index(name) for name in chosen]), len(names), order)
    first = model.parameters.start if start is None else start
    vector = model.parameters.real_vector(first)  # pyright: ignore[reportArgumentType]
    check_integer("regularise", "rounds", rounds, 1)
    return _identified(problem, vector, penalty, chosen, weight, rounds)


def _identified(
    problem: MisfitProblem, vector: np.ndarray, penalty: np.ndarray, smooth: tuple[str, ...], weight: float | str,
    rounds: int,
) -> RegularisedFit:  # fmt: skip
    scale, before, settled, left = problem.model.parameters.scale, np.nan, False, np.inf
    at, many, corner, discrepancy = _linearised(problem, vector, penalty)
    mu = _weight(weight, corner, discrepancy)
    for number in range(1, rounds + 1):
        stage = _Stage(problem.journal, number, rounds, mu)
        vector = scale * _minimised(problem, many, mu, vector / scale, stage)
        at, many, corner, discrepancy = _linearised(problem, vector, penalty)
        before, mu = mu, _weight(weight, corner, discrepancy)
        settled, left = abs(mu - before) <= _SETTLED * before, many.decrease(vector / scale, mu)
        if settled and left <= _CONVERGED:
            break
    residual = many.matrix @ (vector / scale) - many.right
    effective = many.effective(mu)
    variance = 1.0 if problem.data.deviations is not None else residual @ residual / max(1.0, len(residual) - effective)
    covariance = cho_solve(cho_factor(many.normal(mu)), np.eye(len(vector)))
    curve = many.standard.weights
    parameters = problem.model.parameters
    return RegularisedFit(
        names=parameters.names,
        units=tuple(item.unit for item in parameters),
        smooth=smooth,
        values=vector,
        deviations=scale * np.sqrt(variance * np.diag(covariance)),
        weight=mu,
        rule=weight if isinstance(weight, str) else GIVEN,
        corner=corner,
        discrepancy=discrepancy,
        weights=curve,
        residual_norms=many.standard.residual_norms(curve),
        penalty_norms=many.standard.step_norms(curve),
        residual_norm=float(np.linalg.norm(residual)),
        penalty_norm=float(np.linalg.norm(penalty @ (vector / scale))),
        effective=effective,
        data=problem.data,
        response=at.response,
        simulations=problem.journal.simulations,
        provenance=provenance(problem.model, None, data=problem.data.fingerprint, weight=weight),
        findings=(
            *(_findings(before, mu, left) if not settled or left > _CONVERGED else ()),
            *(_above_noise(many, residual, mu) if weight == DISCREPANCY else ()),
            *_beyond_bounds(parameters, vector),
        ),
    )


def _beyond_bounds(parameters: Parameters, values: np.ndarray) -> Iterator[Finding]:
    """Yield that values (parameters,) lie beyond the bounds, which the penalty does not know."""
    beyond = np.flatnonzero((values < parameters.lower) | (values > parameters.upper))
    if not len(beyond):
        return
    item, value = parameters.items[beyond[0]], float(values[beyond[0]])
    yield Finding(
        "values-beyond-bounds",
        "warning",
        {"values": len(beyond), "parameter": item.name, "value": value},
        f"{counted(len(beyond), 'value')} beyond the bounds, the first: {item.name!r} is {value:.4g}, expected "
        f"{item.lower:.4g} to {item.upper:.4g}. Regularisation does not keep bounds.",
        "Widen the bounds if such values are possible, or give a larger weight.",
    )


def _above_noise(many: Smoothed, residual: np.ndarray, mu: float) -> Iterator[Finding]:
    """Yield that the smallest weight leaves residuals (values,) above the noise, so that no weight balances them."""
    ratio = float(np.sqrt(np.mean(residual**2)))
    if mu <= many.standard.least * (1 + 1e-9) and ratio > 1:
        yield Finding(
            "misfit-above-noise",
            "warning",
            {"ratio": ratio},
            f"The root mean square of the residuals is {ratio:.2g} times the standard deviations of the data, even at "
            "the smallest weight. The values follow the noise.",
            "Check the standard deviations and the model structure, or take weight='l-curve'.",
        )


def _findings(before: float, mu: float, left: float) -> tuple[Finding, ...]:
    """What was still moving in the last round."""
    findings = []
    if abs(mu - before) > _SETTLED * before:
        findings.append(
            Finding(
                "weight-not-settled",
                "warning",
                {"before": before, "weight": mu},
                f"The weight of the penalty still changed from {before:.3g} to {mu:.3g} in the last round.",
                "Start from these values, or give the weight.",
            )
        )
    if left > _CONVERGED:
        findings.append(
            Finding(
                "values-not-settled",
                "warning",
                {"decrease": left},
                f"Another round would still lower the sum that is minimised by about {100 * left:.2g} %.",
                "Take more rounds, or start from these values.",
            )
        )
    return tuple(findings)


def _linearised(
    problem: MisfitProblem, vector: np.ndarray, penalty: np.ndarray
) -> tuple[Linearisation, Smoothed, float, float]:
    """The linearised response and problem, the corner of its L-curve, and the weight by the discrepancy principle."""
    scale = problem.model.parameters.scale
    at = problem.linearise(vector)
    residual = problem.residual(at.response)
    used = problem.weights.ravel() > 0
    matrix = problem.weighted(at.jacobian, at.response).reshape(len(residual), -1)[used] * scale
    many = Smoothed(matrix, matrix @ (vector / scale) - residual[used], penalty)
    if many.blind.size:
        undetermined = np.any(np.abs(many.blind) > _SEEN, axis=1)
        names = [
            repr(name) for name, is_free in zip(problem.model.parameters.names, undetermined, strict=True) if is_free
        ]
        more = [f"{len(names) - _NAMED} others"] if len(names) > _NAMED + 1 else names[_NAMED:]
        raise InputError(
            f"regularise: neither the data nor the penalty determine {listed([*names[:_NAMED], *more])}. Name them in "
            "smooth, fix them by equal bounds, or measure what shows them"
        )
    known = problem.data.deviations is not None
    discrepancy = many.standard.discrepancy(np.sqrt(used.sum())) if known else np.nan
    return at, many, many.standard.corner(), float(discrepancy)


def _weight(weight: float | str, corner: float, discrepancy: float) -> float:
    if weight == DISCREPANCY and np.isinf(discrepancy):
        raise InputError(
            "regularise: parameters whose penalty is 0 explain the data within their standard deviations, so that the "
            "discrepancy principle gives no weight. Correct the deviations of the data, or give a weight"
        )
    return {L_CURVE: corner, DISCREPANCY: discrepancy}[weight] if isinstance(weight, str) else float(weight)


@dataclass(frozen=True)
class _Stage:
    """A round of at most ``of``, which reports each gradient."""

    journal: Journal
    number: int
    of: int
    weight: float

    def tell(self) -> None:
        self.journal.tell(Penalised(self.number, self.of, self.weight, self.journal.simulations))


def _minimised(problem: MisfitProblem, many: Smoothed, mu: float, near: np.ndarray, stage: _Stage) -> np.ndarray:
    """z of the least nonlinear misfit, by L-BFGS-B in coordinates in which the linearised misfit is round. z = z₁ +
    C⁻ᵀ u, with C Cᵀ the normal matrix of the linearised problem, and z₁ on the way from the last values, ``near``, to
    its minimum: the whole way if that lowers the misfit, else a part of it.
    """
    scale, penalty = problem.model.parameters.scale, mu * many.penalty
    factor, goal = np.linalg.cholesky(many.normal(mu)), many.solution(mu)

    def misfits(places: np.ndarray) -> np.ndarray:
        squares = problem.squares(problem.responses(places * scale))
        return np.sum(squares, axis=(1, 2)) + np.sum((places @ penalty.T) ** 2, axis=1)

    shares = np.concatenate([[0.0], 0.5 ** np.arange(_HALVINGS)])
    before, *rest = misfits(near + shares[:, None] * (goal - near))
    lower = [share for share, value in zip(shares[1:], rest, strict=True) if value < before]
    base = near + (lower[0] if lower else 0.0) * (goal - near)

    def place(u: np.ndarray) -> np.ndarray:
        return base + solve_triangular(factor, u, lower=True, trans=1)

    def gradient(u: np.ndarray) -> np.ndarray:
        z = place(u)
        stage.tell()
        try:
            slope = problem.slope(z * scale) * scale
        except SolveError:  # the minimiser turns back from there
            return np.zeros_like(u)
        return solve_triangular(factor, slope + 2 * penalty.T @ (penalty @ z), lower=True)

    reach = np.full(len(base), _REACH)
    minimum = Minimiser("L-BFGS-B", _STEPS).minimise(
        lambda batch: misfits(np.array([place(u) for u in batch])), -reach, reach, 0,
        start=np.zeros(len(base)), gradient=gradient,
    )  # fmt: skip
    if not np.isfinite(minimum.misfit):
        raise SolveError(
            f"the model cannot be simulated near the start: {problem.journal.failures[0]}. "
            "Start from other values, or give a larger weight"
        )
    return place(minimum.x)
