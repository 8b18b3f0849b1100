"""Periodic motions of joints as Fourier series within limits."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from dalembert.errors import InputError
from dalembert.stored_fields import Over

FINE = 40  # samples per harmonic where the limits are checked


@dataclass(frozen=True, eq=False)
class JointLimits:
    """Limits of joints.

    Parameters
    ----------
    lower, upper : array, shape (joints,)
        Of the positions, rad or m; finite.
    velocity, acceleration : array, shape (joints,)
        Of their sizes; may be infinite.

    Raises
    ------
    InputError
        For other shapes, positions that are not finite or in order, or limits that are not positive.
    """

    lower: Annotated[np.ndarray, Over("joint", name="lower_limit")]
    upper: Annotated[np.ndarray, Over("joint", name="upper_limit")]
    velocity: Annotated[np.ndarray, Over("joint", name="velocity_limit")]
    acceleration: Annotated[np.ndarray, Over("joint", name="acceleration_limit")]

    def __post_init__(self) -> None:
        limits = [np.atleast_1d(np.asarray(limit, dtype=float)) for limit in vars(self).values()]
        for name, limit in zip(vars(self), limits, strict=True):
            object.__setattr__(self, name, limit)
        lower, upper, velocity, acceleration = limits
        if len({limit.shape for limit in limits}) > 1 or lower.ndim != 1:
            shapes = ", ".join(str(limit.shape) for limit in limits)
            raise InputError(f"JointLimits: the arrays have the shapes {shapes}; expected (joints,) for all")
        for k in range(len(lower)):
            if not (np.isfinite(lower[k]) and np.isfinite(upper[k]) and lower[k] < upper[k]):
                raise InputError(
                    f"JointLimits: joint {k + 1} has positions from {lower[k]:g} to {upper[k]:g}; expected finite "
                    "ones, the lower one first"
                )
            if not (velocity[k] > 0 and acceleration[k] > 0):
                raise InputError(
                    f"JointLimits: joint {k + 1} has a velocity of {velocity[k]:g} and an acceleration of "
                    f"{acceleration[k]:g}; expected positive limits"
                )

    @property
    def joints(self) -> int:
        return len(self.lower)


@dataclass(frozen=True, eq=False)
class FourierMotion:
    """q(t) = centre + Σ_k sine_k sin(2π k t / period) + cosine_k cos(2π k t / period).

    Parameters
    ----------
    period : float
        s.
    centre : array, shape (joints,)
    sine, cosine : array, shape (joints, harmonics)

    Notes
    -----
    Source: J. Swevers, C. Ganseman, D. Tükel, J. De Schutter, H. Van Brussel, Optimal robot excitation and
    identification, IEEE Transactions on Robotics and Automation 13 (1997).

    Examples
    --------
    >>> swing = FourierMotion(2.0, np.zeros(1), np.ones((1, 1)), np.zeros((1, 1)))
    >>> [one.round(6).tolist() for one in swing.motion(np.array([0.0]))]
    [[[0.0]], [[3.141593]], [[0.0]]]
    """

    period: float
    centre: Annotated[np.ndarray, Over("joint")]
    sine: Annotated[np.ndarray, Over("joint", "harmonic")]
    cosine: Annotated[np.ndarray, Over("joint", "harmonic")]

    def motion(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Positions, velocities and accelerations (samples, joints) at times (samples,)."""
        rates = 2 * np.pi * np.arange(1, self.sine.shape[1] + 1) / self.period
        angles = np.outer(times, rates)
        sine, cosine = np.sin(angles), np.cos(angles)
        positions = self.centre + sine @ self.sine.T + cosine @ self.cosine.T
        velocities = (cosine * rates) @ self.sine.T - (sine * rates) @ self.cosine.T
        accelerations = -(sine * rates**2) @ self.sine.T - (cosine * rates**2) @ self.cosine.T
        return positions, velocities, accelerations


def largest_motion(shape: np.ndarray, period: float, limits: JointLimits) -> FourierMotion:
    """Return the largest motion of a shape that keeps the limits at all times. ``shape`` (joints, 2 harmonics + 1),
    from −1 to 1: sines and cosines of the velocity, and where the motion lies between the limits of the position.

    Between N even samples a trigonometric polynomial of degree n is at most 1 / cos(π n / N) times its largest sample,
    here 1.003 times (H. Ehlich, K. Zeller, Schwankung von Polynomen zwischen Gitterpunkten, Mathematische Zeitschrift
    86, 1964).
    """
    harmonics = shape.shape[1] // 2
    orders = np.arange(1, harmonics + 1)
    sine, cosine = shape[:, :harmonics] / orders, shape[:, harmonics:-1] / orders
    plain = FourierMotion(period, np.zeros(len(shape)), sine, cosine)
    path, velocity, acceleration = plain.motion(np.arange(FINE * harmonics) * period / (FINE * harmonics))
    between = 1.0 / np.cos(np.pi / FINE)
    top, bottom = path.max(axis=0), path.min(axis=0)
    half = 0.5 * (top - bottom) * between
    bounds = [
        0.5 * (limits.upper - limits.lower) / half,
        limits.velocity / (np.abs(velocity).max(axis=0) * between),
        limits.acceleration / (np.abs(acceleration).max(axis=0) * between),
    ]
    size = np.min(bounds, axis=0)
    slack = 0.5 * (limits.upper - limits.lower) - size * half
    centre = 0.5 * (limits.upper + limits.lower) + shape[:, -1] * slack - 0.5 * size * (top + bottom)
    return FourierMotion(period, centre, sine * size[:, None], cosine * size[:, None])
