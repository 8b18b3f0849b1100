"""The flexible double pendulum of the published tables, and those of its tables that give bounds."""

from pathlib import Path

import numpy as np

import dalembert as da

STUDIES = Path(__file__).parents[1] / "studies"
CHANNELS = ("AB.end.x", "AB.end.y")


def pendulum(theta1: float, theta2: float, youngs_ab: float = 2e7) -> da.System:
    """Sections 0.4 m high, as the tables need it (0.04 m is printed), and the published element."""
    section = {"poisson_ratio": 0.3, "density": 5540.0, "height": 0.4, "width": 0.2, "formulation": "continuum"}
    system = da.System(gravity=(0.0, -9.81))
    oa = system.add(da.AncfBeam("OA", 1.0, 2, 2e8, angle=-theta1, **section))
    ab = system.add(da.AncfBeam("AB", 2.0, 4, youngs_ab, angle=-theta2, start=oa.end, **section))
    system.add(da.RevoluteJoint("O", system.ground, oa.start))
    system.add(da.RevoluteJoint("A", oa.end, ab.start))
    return system


def tip(parameters: dict[str, tuple[float, float]], end: float = 2.0) -> da.TimeResponse:
    """The tip of the pendulum every 0.05 s, as in the tables."""
    times = np.arange(round(end / 0.05) + 1) * 0.05
    solver = da.GeneralizedAlpha(step=5e-4, spectral_radius=0.8, initial_acceleration="zero")
    return da.TimeResponse(pendulum, parameters, CHANNELS, times, solver)


def table(name: str) -> da.Bands:
    """Published bounds of the tip: ``"a2"``, ``"a3"`` or ``"a4"``."""
    columns = {f"AB.end.{axis}": (f"{axis}_lower", f"{axis}_upper") for axis in "xy"}
    return da.read_bands(STUDIES / "interval-pendulum" / f"table-{name}.csv", columns=columns)


def within(share: float, **middles: float) -> dict[str, da.Interval]:
    """Intervals about middles, of a radius that is a share of them."""
    return {name: da.Interval.about(middle, relative=share) for name, middle in middles.items()}
