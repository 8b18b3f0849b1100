"""Real Fourier series of periodic motions: their samples, their harmonics, their derivative."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np


@dataclass(frozen=True)
class Fourier:
    r"""Harmonics :math:`x(\tau) = X_0 + \sum_h X_{ch} \cos h\tau + X_{sh} \sin h\tau` and samples of a period.

    ``orders``: harmonics that are kept, in ascending order; 0 is the mean; ``samples``: samples of a period.
    """

    orders: tuple[int, ...]
    samples: int

    @cached_property
    def count(self) -> int:
        """Number of coefficients."""
        return 2 * len(self.orders) - self.mean

    @cached_property
    def mean(self) -> int:
        """1 if the mean is among the harmonics, else 0."""
        return int(self.orders[0] == 0)

    @cached_property
    def synthesis(self) -> np.ndarray:
        """From coefficients to samples, (samples, coefficients)."""
        return synthesis(self.orders, 2 * np.pi * np.arange(self.samples) / self.samples)

    @cached_property
    def analysis(self) -> np.ndarray:
        """From samples to coefficients, (coefficients, samples)."""
        # Samples are equally spaced and more than twice the highest harmonic: waves are orthogonal over them, and the
        # trapezoidal rule is exact for the kept harmonics.
        rows = self.synthesis.T * (2 / self.samples)
        rows[: self.mean] /= 2
        return np.ascontiguousarray(rows)

    @cached_property
    def derivative(self) -> np.ndarray:
        """Coefficients of the derivative by tau from those of the motion, (coefficients, coefficients)."""
        matrix = np.zeros((self.count, self.count))
        # (X_c cos hτ + X_s sin hτ)' = h X_s cos hτ - h X_c sin hτ
        for order, cosine in zip(self.orders[self.mean :], range(self.mean, self.count, 2), strict=True):
            matrix[cosine, cosine + 1], matrix[cosine + 1, cosine] = order, -order
        return matrix

    @cached_property
    def waves(self) -> np.ndarray:
        """The synthesis and its first two derivatives by tau, (3, samples, coefficients)."""
        first = self.synthesis @ self.derivative
        return np.stack([self.synthesis, first, first @ self.derivative])

    @cached_property
    def cosines(self) -> np.ndarray:
        """Indices of the cosine coefficients, and of the mean, (orders,)."""
        return np.array([*range(self.mean), *range(self.mean, self.count, 2)], dtype=int)

    def phasors(self, coefficients: np.ndarray) -> np.ndarray:
        """Complex amplitudes X_c - i X_s, (orders, rows), of real coefficients (rows, coefficients)."""
        mean, result = self.mean, np.empty((len(self.orders), len(coefficients)), dtype=complex)
        result[:mean] = coefficients[:, :mean].T
        result[mean:] = (coefficients[:, mean::2] - 1j * coefficients[:, mean + 1 :: 2]).T
        return result

    def coefficients(self, phasors: np.ndarray) -> np.ndarray:
        """Real coefficients (rows, coefficients) of complex amplitudes (orders, rows)."""
        mean, result = self.mean, np.empty((phasors.shape[1], self.count))
        real, imaginary = np.real(phasors), np.imag(phasors)
        result[:, :mean] = real[:mean].T
        result[:, mean::2] = real[mean:].T
        result[:, mean + 1 :: 2] = -imaginary[mean:].T
        return result


def synthesis(orders: tuple[int, ...], angles: np.ndarray) -> np.ndarray:
    """Cosines and sines of the harmonics at angles tau, (angles, coefficients)."""
    columns = [[np.ones_like(angles)] if h == 0 else [np.cos(h * angles), np.sin(h * angles)] for h in orders]
    return np.stack([column for pair in columns for column in pair], axis=1)


def in_orders(coefficients: np.ndarray, orders: tuple[int, ...], more_orders: tuple[int, ...]) -> np.ndarray:
    """Return coefficients (rows, coefficients) of a series with other orders, which contain its own; the rest is 0.
    >>> in_orders(np.array([[1.0, 2.0]]), (1,), (0, 1, 2)).tolist()
    [[0.0, 1.0, 2.0, 0.0, 0.0]]
    """
    columns = _columns(more_orders)
    result = np.zeros((len(coefficients), len(columns)))
    result[:, np.searchsorted(columns, _columns(orders))] = coefficients
    return result


def _columns(orders: tuple[int, ...]) -> np.ndarray:
    """Numbers of the coefficients in a series with all orders."""
    return np.array([column for order in orders for column in ((0,) if order == 0 else (2 * order - 1, 2 * order))])


def real_blocks(matrices: np.ndarray, mean: int) -> np.ndarray:
    """Matrices on phasors (orders, q, r) as one on real coefficients, (q, coefficients, r, coefficients)."""
    orders, q, r = matrices.shape
    count = 2 * orders - mean
    result = np.zeros((q, count, r, count))
    diagonal, up, down = map(_diagonal, (result, result[:, :-1, :, 1:], result[:, 1:, :, :-1]))
    real, imaginary = np.real(matrices), np.imag(matrices)
    # Z (X_c - i X_s) with Z = A + i B: cosines A X_c + B X_s, sines A X_s - B X_c.
    diagonal[:mean] = real[:mean]
    diagonal[mean::2] = diagonal[mean + 1 :: 2] = real[mean:]
    up[mean::2] = imaginary[mean:]
    down[mean::2] = -imaginary[mean:]
    return result


def _diagonal(blocks: np.ndarray) -> np.ndarray:
    """The part of (q, coefficients, r, coefficients) that is of one coefficient, (coefficients, q, r), to write in."""
    return np.einsum("icjc->cij", blocks)


def complex_blocks(matrices: np.ndarray, mean: int) -> np.ndarray:
    """Return the part of matrices (..., q, coefficients, r, coefficients) that multiplies each phasor by a number.

    (orders, ..., q, r): the inverse of :func:`real_blocks`, and without what couples harmonics or conjugates.
    """
    diagonal = np.moveaxis(np.diagonal(matrices, axis1=-3, axis2=-1), -1, 0)
    up = np.moveaxis(np.diagonal(matrices[..., :-1, :, 1:], axis1=-3, axis2=-1), -1, 0)[mean::2]
    down = np.moveaxis(np.diagonal(matrices[..., 1:, :, :-1], axis1=-3, axis2=-1), -1, 0)[mean::2]
    # The part of a 2 × 2 block that is a complex number: mean of its diagonal, half of its antisymmetric part. The rest
    # acts on conjugates.
    turning = (diagonal[mean::2] + diagonal[mean + 1 :: 2]) / 2 + 0.5j * (up - down)
    return np.concatenate([diagonal[:mean].astype(complex), turning])
