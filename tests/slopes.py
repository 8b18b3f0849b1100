"""Exact derivatives of a simulated response beside the slopes of its simulations."""

import numpy as np

import dalembert.multibody as mb


def errors(model: mb.TimeResponse, relative: float = 1e-2) -> tuple[dict[str, float], dict[str, float]]:
    """Largest error of each parameter's derivative and its largest size, against the responses' sizes.

    The differences are central ones of three steps, extrapolated to the sixth order; the shortest is ``relative``.
    """
    vector = model.parameters.start
    h = relative * np.diag(np.abs(vector))
    moved = model.evaluate(np.concatenate([vector + k * h for k in (1, -1, 2, -2, 4, -4)])).only()
    moved = moved.reshape(3, 2, len(vector), *moved.shape[1:])
    one, two, four = ((moved[i, 0] - moved[i, 1]) / (2**i * 2 * relative) for i in range(3))
    slopes = (64 * one - 20 * two + four) / 45
    values, jacobian = model.linearise(vector)
    exact = np.moveaxis(jacobian * np.abs(vector), 2, 0)
    size = np.abs(values).max(axis=0) + 1e-3
    given = np.abs(exact - slopes).max(axis=1) / (np.abs(slopes).max(axis=1) + 0.1 * size)
    share = np.abs(slopes).max(axis=1) / size
    names = model.parameters.names
    return dict(zip(names, given.max(axis=1), strict=True)), dict(zip(names, share.max(axis=1), strict=True))
