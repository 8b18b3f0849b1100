"""Noise that is correlated along time, for the tests of identification."""

import numpy as np

from dalembert.inverse.noise.correlation.series import Series, even_grid


def autoregressive(seed, number, coefficient, repetitions=None):
    """Stationary noise of variance 1, e_t = coefficient · e_{t−1} + white noise: (number,) or (repetitions, number)."""
    white = np.random.default_rng(seed).standard_normal((repetitions or 1, number))
    noise = white.copy()
    for k in range(1, number):
        noise[:, k] = coefficient * noise[:, k - 1] + np.sqrt(1 - coefficient**2) * white[:, k]
    return noise if repetitions else noise[0]


def exponential(seed, times, time):
    """Stationary noise of variance 1 with the correlation exp(−|Δt|/time) at uneven times: (samples,)."""
    noise = np.random.default_rng(seed).standard_normal(len(times))
    for k, factor in enumerate(np.exp(-np.diff(times) / time), start=1):
        noise[k] = factor * noise[k - 1] + np.sqrt(1 - factor**2) * noise[k]
    return noise


def series(along):
    grid, step = even_grid(along)
    return Series("x", np.arange(len(along)), along, grid, step, "s")


def left(noise, columns):
    """What a fit of columns (values, parameters) leaves of noise (values,), and the columns' orthonormal basis."""
    basis = np.linalg.qr(columns)[0]
    return noise - basis @ (basis.T @ noise), basis


def polynomials(along, degree):
    return np.stack([(along / along[-1]) ** power for power in range(degree + 1)], axis=1)
