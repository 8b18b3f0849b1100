"""The pullback of a model that a builder makes: from the numbers of the mechanism to the parameters."""

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csc_array

from dalembert.errors import InputError, ModelError
from dalembert.forward.adjoint import Pull
from dalembert.forward.differences import COMPLEX_STEP
from dalembert.forward.sparse_steps import sparse_jacobian
from dalembert.kernels.duals import DIRECTIONS
from dalembert.multibody.adjoint.numbers import numbers_of
from dalembert.multibody.adjoint.pullback import MotionPullback, refuse
from dalembert.multibody.integrators.generalized_alpha.generalized_alpha import GeneralizedAlpha
from dalembert.multibody.kernels.callbacks import in_complex_numbers
from dalembert.multibody.kernels.elementary import STEP

if TYPE_CHECKING:
    from dalembert.multibody.motion.motion_model import BuiltModel


FEWEST = 6
"""Parameters from which an adjoint is cheaper than directions one by one, see the benchmark ``adjoint``. Eight at once
cost less than an adjoint.
"""


def adjoint_from(model: "BuiltModel") -> int | None:
    """Number of parameters from which the adjoint of a model is cheaper than its Jacobian; None without an adjoint."""
    if model.derivative != COMPLEX_STEP or len(model.parameters) < FEWEST:
        return None
    try:
        solver = _refused(model)
    except InputError:
        return None
    return DIRECTIONS + 1 if solver.takes_duals and model.shared.in_duals else FEWEST


def _refused(model: "BuiltModel") -> GeneralizedAlpha:
    """The integrator of a model, if it has an adjoint."""
    return refuse(model.shared, model.solver.suiting(model.shared, float(model.times[-1])), model.observer)


def pulled(model: "BuiltModel", vector: np.ndarray) -> tuple[np.ndarray, Pull]:
    """The response of a model (samples, channels), and what gives gradients of its weighted sums."""
    if model.derivative != COMPLEX_STEP:
        raise InputError(
            f"the adjoint needs a builder that runs in complex numbers, but derivative is {model.derivative!r}. "
            "Take derivative='complex-step' for the model"
        )
    solver = _refused(model)
    model.check_together(vector)
    with in_complex_numbers(strict=True):
        lowered = model.lowered_at(vector, model.begin, closed=True)
        motion = MotionPullback.of(lowered, solver, model.observer, model.problem, model.times)
        stored, counted = motion.motion, model.observer.counted
        turns = dict(zip(counted, stored.turns.T, strict=True))
        response = model.observer.read(lowered, lowered.real, stored.samples, model.times, turns)

    def pull(cotangent: np.ndarray) -> np.ndarray:
        with in_complex_numbers(strict=True):
            jacobian = _jacobian(model, vector)
            active = np.zeros(len(numbers_of(lowered, model.observer)), bool)
            active[jacobian.indices] = True
            slopes = motion.gradient(np.asarray(cotangent, dtype=float), active)
        return (slopes @ jacobian) / model.parameters.scale

    return response, pull


def _jacobian(model: "BuiltModel", vector: np.ndarray) -> csc_array:
    """Derivative of the mechanism's numbers by the parameters over their scales, sparse (numbers, parameters)."""
    scale = model.parameters.scale

    def along(direction: np.ndarray) -> np.ndarray:
        moved = model.along(vector, direction * scale, model.begin)
        return np.imag(numbers_of(moved, model.observer)) / STEP

    try:
        jacobian, pattern = sparse_jacobian(along, len(vector), vars(model).get("_pattern"))
    except (TypeError, ModelError, np.exceptions.ComplexWarning):
        for column in range(len(vector)):  # name the parameter
            model.perturbed_at(vector, column, model.begin, closed=True)
        raise
    vars(model)["_pattern"] = pattern
    return jacobian
