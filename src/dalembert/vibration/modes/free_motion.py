"""Motions without force: points of the path of a nonlinear mode, and planes across it."""

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Linear:
    """A linear mode about a position at rest. ``rest`` (q, coefficients), ``moved`` (q,): unknowns; ``shape`` (n,):
    degrees of freedom.
    """

    omega: float
    growth: float
    rest: np.ndarray
    moved: np.ndarray
    shape: np.ndarray


@dataclass(frozen=True)
class FreeMotion:
    """A motion without force: harmonics of the unknowns (q, coefficients), ω, ξ = 2 ζ ω and amplitude, and how it was
    found.
    """

    harmonics: np.ndarray
    omega: float
    growth: float
    size: float
    iterations: int = 0
    error: float = 0.0
    converged: bool = False
    samples: int = 0


@dataclass(frozen=True)
class ModePlane:
    """A plane across the path of motions, in (Y/scale, log ω, ξ/ω, log a), through a motion."""

    direction: np.ndarray
    at: FreeMotion
    scale: float

    def from_here(self, motion: FreeMotion) -> np.ndarray:
        """The way from the plane's own motion to another."""
        # ω and the amplitude by their ratios, ξ in parts of ω: all components are without dimension.
        change = (motion.harmonics - self.at.harmonics).ravel() / self.scale
        scalars = [
            np.log(motion.omega / self.at.omega),
            (motion.growth - self.at.growth) / self.at.omega,
            np.log(motion.size / self.at.size),
        ]
        return np.append(change, scalars)

    def distance(self, motion: FreeMotion) -> float:
        """Of a motion from the plane."""
        return float(self.direction @ self.from_here(motion))

    def moved(self, motion: FreeMotion, step: np.ndarray) -> FreeMotion:
        """A motion some step on."""
        return replace(
            motion,
            # ω and a are positive and vary by decades: steps are in their logarithms, clipped to a factor e.
            harmonics=motion.harmonics + self.scale * step[:-3].reshape(motion.harmonics.shape),
            omega=float(motion.omega * np.exp(np.clip(step[-3], -1.0, 1.0))),
            growth=float(motion.growth + self.at.omega * step[-2]),
            size=float(motion.size * np.exp(np.clip(step[-1], -1.0, 1.0))),
        )
