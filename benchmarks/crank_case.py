"""A spatial slider-crank with a flexible rod, said once and used by both sides. Nothing of it is damped."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.multibody.spatial import Section

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class SliderCrank:
    """Its size is that of studies/flexible-slider-crank, but the crank is a flywheel. All is at rest at the start.

    The crank turns about the x axis and stands upright at the start; the slider moves along this axis. The x axis of
    the rod points to the slider, and its z axis is perpendicular to the x axis.
    """

    crank: float = 0.08
    rod: float = 0.3
    bearing: Triple = (0.0, 0.1, 0.12)
    gravity: Triple = (0.0, 0.0, -9.81)
    torque: float = 1.0
    flywheel: tuple[float, float] = (0.12, 1e-2)
    slider: tuple[float, float] = (0.3, 1.25e-4)
    width: float = 0.012
    height: float = 0.005

    @cached_property
    def section(self) -> Section:
        """Stiffness and inertia of the rod."""
        return Section.rectangle(self.width, self.height, youngs_modulus=3e9, poisson_ratio=0.4, density=1150.0)

    @cached_property
    def pin(self) -> np.ndarray:
        """Place of the pin of the crank at the start, m."""
        return np.add(self.bearing, (0.0, 0.0, self.crank))

    @cached_property
    def way(self) -> float:
        """Place of the slider at the start, m."""
        return float(np.sqrt(self.rod**2 - self.pin[1] ** 2 - self.pin[2] ** 2))

    @cached_property
    def axes(self) -> np.ndarray:
        """Axes of the rod at the start, as columns."""
        along = (np.array([self.way, 0.0, 0.0]) - self.pin) / self.rod
        up = np.cross((1.0, 0.0, 0.0), along)
        up /= np.linalg.norm(up)
        return np.column_stack([along, np.cross(up, along), up])
