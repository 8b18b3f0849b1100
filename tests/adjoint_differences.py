"""Gradients by the adjoint against those by direct sensitivities."""

import numpy as np

import dalembert.multibody as mb


def points_alone(model: mb.TimeResponse, **changed) -> mb.TimeResponse:
    """The same model, read at points and components alone."""
    names = [name for name in model.channel_names if not name.startswith("system.")]
    given = {"channels": names, "times": model.times, "solver": model.solver} | changed
    return mb.TimeResponse(model.builder, model.parameters, **given)


def difference(model: mb.TimeResponse) -> float:
    """Largest difference of the gradient of a random sum from the direct one, relative to the sizes of its terms."""
    vector = model.parameters.start
    response, jacobian = model.linearise(vector)
    cotangent = np.random.default_rng(0).normal(size=response.shape) / (np.abs(response).max(axis=0) + 1.0)
    own, pull = model.pullback(vector)
    np.testing.assert_allclose(own, response, rtol=0, atol=1e-12 * np.abs(response).max())
    terms = np.einsum("sc,scp->p", np.abs(cotangent), np.abs(jacobian))
    error = pull(cotangent) - np.einsum("sc,scp->p", cotangent, jacobian)
    return float(np.max(np.abs(error) / np.maximum(terms, 1e-300)))
