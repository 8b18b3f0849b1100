"""Where sampling begins, and the coordinates in which the posterior is round: the mode and its curvature."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from dalembert.errors import SolveError
from dalembert.inverse.noise.likelihood.likelihood import Likelihood
from dalembert.inverse.posterior.target import Target
from dalembert.inverse.problem.prior import prior_slopes
from dalembert.parameters import Parameters

FAR = 1e3  # largest change of a target's value that its search takes for finite
SEARCHES = 12  # most searches of the mode
REACH, NEAR = 8.0, 1.0  # reach of a search in standard deviations, and how near to its start the last one ends
LOCAL = 2.0  # reach of a local search in standard deviations: a longer step may leave a narrow mode
# Fall of the log density at one standard deviation from which a local search takes the deviation for too large, and
# how often it is halved at most.
FALL, HALVINGS = 2.0, 20
STEP = 0.05  # step of second differences in coordinates without bounds, for models without a jacobian


@dataclass(frozen=True, eq=False)
class Centred:
    """A target around its mode."""

    target: Target
    vector: np.ndarray  # (parameters,): parameters at the mode of the density of the coordinates without bounds
    covariance: np.ndarray  # (parameters, parameters): of the parameters, from the linearised response and the priors
    # (parameters, parameters), or None: Fisher information of the data about the coordinates at the mode; None without
    # a jacobian.
    data_information: np.ndarray | None

    @property
    def deviations(self) -> np.ndarray:
        """Linear standard deviations (parameters,)."""
        return np.sqrt(np.diag(self.covariance))


def centred(
    likelihood: Likelihood, parameters: Parameters, start: np.ndarray, *, gradients: bool, local: bool = False
) -> Centred:
    """Return the target around the mode that is reached from a start (parameters,). With ``gradients`` the mode is
    searched by L-BFGS-B, and the curvature is JᵀΣ⁻¹J and that of the priors. Without, Nelder and Mead's simplex and
    second differences serve. A ``local`` search takes short steps, and trusts the curvature only as far as the density
    falls by it, so that it stays in a narrow mode.
    """
    count = len(parameters)
    target = Target(likelihood, parameters, np.zeros(count), np.eye(count))
    point = target.coordinates.points(start)
    value = float(target.evaluate(point[None])[0])
    if not np.isfinite(value):
        failures = likelihood.problem.journal.failures
        reason = failures[-1] if failures else "the likelihood is not finite there"
        raise SolveError(f"the posterior cannot be sampled from its start: {reason}. Change the start or the bounds")
    for number in range(SEARCHES):  # each one is in the coordinates of the end of the one before
        # Fisher scoring: JᵀΣ⁻¹J takes the place of the Hessian. It needs no second derivatives and is never indefinite.
        information, _ = _information(target, point, gradients=gradients)
        target = replace(target, centre=point, factor=_factor(information))
        target = _narrowed(target) if local else target
        place = _searched(target, LOCAL if local else REACH, gradients=gradients)
        point = target.points(place)
        if number and np.max(np.abs(place), initial=0.0) < NEAR:
            break
    information, data = _information(target, point, gradients=gradients)
    result = replace(target, centre=point, factor=_factor(information))
    result = _narrowed(result) if local else result
    rows = target.coordinates.slope(point)[:, None] * result.factor
    return Centred(result, target.coordinates.vectors(point), rows @ rows.T, data)


def _narrowed(target: Target) -> Target:
    """Return the target with columns of its factor halved until the density falls by at most FALL at their ends. A
    normal density falls by ½ there. It falls by more where the response is so nonlinear that the curvature JᵀΣ⁻¹J at
    the centre is far too small.
    """
    count = len(target.centre)
    for _ in range(HALVINGS):
        density = target.evaluate(np.concatenate([np.zeros((1, count)), np.eye(count), -np.eye(count)]))
        falls = density[0] - density[1:].reshape(2, count).mean(axis=0)
        steep = falls > FALL  # infinite where a simulation failed
        if not np.any(steep):
            break
        target = replace(target, factor=np.where(steep, 0.5, 1.0) * target.factor)
    return target


def _searched(target: Target, reach: float, *, gradients: bool) -> np.ndarray:
    """The place of the largest density, from the centre of the target."""
    origin = np.zeros(len(target.centre))
    bound = float(target.evaluate(origin[None])[0])

    def squared(place: np.ndarray) -> tuple[float, np.ndarray]:
        value, gradient = target.linearise(place)
        return (bound - value, -gradient) if np.isfinite(value) else (FAR + float(place @ place), 2 * place)

    def plain(place: np.ndarray) -> float:
        value = float(target.evaluate(place[None])[0])
        return bound - value if np.isfinite(value) else FAR + float(place @ place)

    if gradients:
        # In units of standard deviations, so one box suits all parameters.
        limits = [(-reach, reach)] * len(origin)  # a search within what the curvature allows
        return minimize(squared, origin, jac=True, method="L-BFGS-B", bounds=limits, options={"maxiter": 100}).x
    size = len(origin)
    # A first simplex of half a standard deviation.
    simplex = np.vstack([origin, 0.5 * np.eye(size)])
    options = {"maxfev": 100 * size, "initial_simplex": simplex, "xatol": 1e-3, "fatol": 1e-4}
    return minimize(plain, origin, method="Nelder-Mead", options=options).x


def _information(target: Target, point: np.ndarray, *, gradients: bool) -> tuple[np.ndarray, np.ndarray | None]:
    """Information about the coordinates (parameters, parameters), with that of priors; and that of the data alone."""
    coordinates = target.coordinates
    vector, slope = coordinates.vectors(point), coordinates.slope(point)
    prior = prior_slopes(target.parameters, vector, slope)
    # A uniform prior is ln u(1 − u) in z, with the curvature −2 u(1 − u). In |z|, which does not overflow.
    between = np.exp(-np.abs(point)) / (1 + np.exp(-np.abs(point))) ** 2  # u (1 − u)
    # The information adds up: priors, the map to z, then the data.
    known = prior.T @ prior + np.diag(2 * between)
    if gradients:
        try:
            rows = target.likelihood.expansion(vector).rows * slope
        except SolveError:
            rows = np.zeros((0, len(point)))
        return rows.T @ rows + known, rows.T @ rows
    return known + np.diag(
        _curvatures(replace(target, centre=np.zeros(len(point)), factor=np.eye(len(point))), point)
    ), None


def _curvatures(target: Target, point: np.ndarray) -> np.ndarray:
    """Second differences of the log-likelihood along each coordinate, with the sign of an information."""
    moved = STEP * np.eye(len(point))
    vectors = target.vectors(np.concatenate([point[None], point + moved, point - moved]))
    middle, above, below = np.split(target.likelihood.evaluate(vectors), [1, 1 + len(point)])
    # Convex directions count as not informed by the data: the priors alone give them a width.
    curvatures = -(above - 2 * middle + below) / STEP**2
    return np.where(np.isfinite(curvatures) & (curvatures > 0), curvatures, 0.0)


def _factor(information: np.ndarray) -> np.ndarray:
    """L⁻ᵀ of the Cholesky factor L of an information."""
    # With H = L Lᵀ, z = L⁻ᵀ y has the covariance H⁻¹ for a standard normal y.
    return np.linalg.inv(np.linalg.cholesky(information)).T
