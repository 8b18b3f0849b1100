"""The numbers of the benchmark models, said once and used by both sides."""

from dataclasses import dataclass

import numpy as np

GRAVITY = 9.81  # m/s^2, along -y


@dataclass(frozen=True)
class Bar:
    """A straight bar of rectangular section; angle from the X axis, counter-clockwise."""

    length: float
    elements: int
    youngs_modulus: float
    angle: float
    density: float = 5540.0
    height: float = 0.4
    width: float = 0.2

    @property
    def mass_per_length(self) -> float:
        return self.density * self.height * self.width

    @property
    def axial_stiffness(self) -> float:
        return self.youngs_modulus * self.height * self.width

    @property
    def bending_stiffness(self) -> float:
        return self.youngs_modulus * self.width * self.height**3 / 12


@dataclass(frozen=True)
class Integration:
    """Generalized-alpha with a fixed step; outputs are taken each ``every`` steps."""

    end: float
    step: float
    every: int
    spectral_radius: float = 0.8

    @property
    def steps(self) -> int:
        return round(self.end / self.step)

    @property
    def times(self) -> np.ndarray:
        return np.arange(0, self.steps + 1, self.every) * self.step


@dataclass(frozen=True)
class FlexiblePendulum:
    """Two bars pinned to each other and to the ground, at rest; joint and tip are observed."""

    oa: Bar = Bar(1.0, 2, 2e8, -np.pi / 4)
    ab: Bar = Bar(2.0, 4, 2e7, -np.pi / 6)
    integration: Integration = Integration(end=2.0, step=5e-4, every=100)


@dataclass(frozen=True)
class Rod:
    """A rigid uniform rod."""

    length: float
    mass: float
    angle: float

    @property
    def inertia(self) -> float:
        return self.mass * self.length**2 / 12


@dataclass(frozen=True)
class TwoLinkArm:
    """Two rigid rods, pinned, at rest, falling."""

    upper: Rod = Rod(1.0, 1.0, np.pi / 3)
    lower: Rod = Rod(3.0, 2.0, -np.pi / 6)
    integration: Integration = Integration(end=20.0, step=0.01, every=1)


def strip(elements: int) -> tuple[Bar, Integration]:
    """A thin steel strip, clamped level and straight, then released under its weight."""
    bar = Bar(0.52, elements, 2e11, 0.0, density=7870.0, height=1e-3, width=0.08)
    return bar, Integration(end=0.5, step=2.5e-4, every=40)


PENDULUM = FlexiblePendulum()
ARM = TwoLinkArm()


def chain(elements: int, steps: int = 200) -> tuple[Bar, Integration]:
    """A slender cable of elements 0.1 m long, pinned at one end, let go 60 degrees below the horizontal."""
    bar = Bar(0.1 * elements, elements, 2e7, -np.pi / 3, density=1000.0, height=0.02, width=0.02)
    return bar, Integration(end=steps * 1e-3, step=1e-3, every=steps)
