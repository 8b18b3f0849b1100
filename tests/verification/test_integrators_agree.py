"""Different formulations of the same equations come to the same motion as their steps shrink."""

from functools import cache

import numpy as np
import pytest

import dalembert.multibody as mb
from mechanisms import beam

SOURCE = "another formulation of the same equations"
TOPIC = "Agreement of integrators"
TIMES = np.linspace(0.0, 1.0, 11)


def engine() -> mb.System:
    """A crank, a rod and a slider with friction in a joint, a spring with damper, and a torque of time."""
    system = mb.System(gravity=(0.0, -9.81))
    crank = system.add(mb.RigidBar("crank", 0.5, 2.0, angle=0.6))
    rod = system.add(mb.RigidBar("rod", 1.3, 1.5, angle=-np.arcsin(0.5 * np.sin(0.6) / 1.3), start=crank.end))
    slider = system.add(mb.RigidBody("slider", 0.7, 0.01, position=rod.end))
    system.add(mb.RevoluteJoint("main", system.ground, crank.start, viscous=0.2))
    system.add(mb.RevoluteJoint("big end", crank.end, rod.start, coulomb=0.3, slip_rate=0.5))
    system.add(mb.RevoluteJoint("small end", rod.end, slider.centre))
    system.add(mb.PrismaticJoint("bore", system.ground, slider.centre))
    wall = system.ground.point(2.5, 0.0)
    system.add(mb.Spring("gas", wall, slider.centre, stiffness=40.0, damping=2.0, free_length=0.8))
    system.add(mb.Torque("starter", crank.start, mb.Harmonic(3.0, 7.0)))
    return system


def soft_pendulum() -> mb.System:
    system = mb.System(gravity=(0.0, -9.81))
    bar = system.add(beam("bar", damping=1e-3))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
    return system


MODELS = {
    "engine": (engine, ("slider.centre.x", "crank.end.y", "big end.force_x"), mb.RadauIIA(tolerance=1e-11)),
    "soft beam": (soft_pendulum, ("bar.end.x", "bar.end.y"), mb.RadauIIA(tolerance=1e-8)),
}
RIGID = {
    "generalized-alpha": (mb.GeneralizedAlpha(step=2e-4), 2e-5),
    "generalized-alpha, no damping": (mb.GeneralizedAlpha(step=2e-4, spectral_radius=1.0), 2e-5),
    "Runge-Kutta 4, projection": (mb.RungeKutta4(2e-3), 1e-7),
    "Runge-Kutta 4, partitioning": (mb.RungeKutta4(2e-3, mb.Partitioning()), 1e-7),
    "Runge-Kutta 4, Baumgarte": (mb.RungeKutta4(1e-3, mb.Baumgarte(10.0, 10.0)), 1e-6),
    "DOP853": (mb.OdeSolver("DOP853"), 1e-7),
    "BDF": (mb.OdeSolver("BDF", 1e-7, 1e-9), 1e-4),
    "variational": (mb.Variational(2e-4), 2e-5),
    "energy-momentum": (mb.EnergyMomentum(2e-4), 2e-5),
    "collocation of order 6": (mb.Collocation(5e-3, degree=4, gauss_points=3), 1e-7),
}
FLEXIBLE = {
    "generalized-alpha": (mb.GeneralizedAlpha(step=1e-4), 1e-5),
    "Runge-Kutta 4, projection": (mb.RungeKutta4(5e-4), 1e-6),
    "variational": (mb.Variational(1e-4), 1e-5),
    "energy-momentum": (mb.EnergyMomentum(1e-4), 1e-5),
    "collocation of order 4": (mb.Collocation(1e-3, degree=3), 1e-6),
}
CASES = [("engine", name, *entry) for name, entry in RIGID.items()]
CASES += [("soft beam", name, *entry) for name, entry in FLEXIBLE.items()]


@cache
def reference(model: str) -> np.ndarray:
    make, channels, solver = MODELS[model]
    return mb.simulate(make(), TIMES[-1], solver, TIMES).channels(channels)


@pytest.mark.parametrize(("model", "name", "solver", "tolerance"), CASES, ids=[f"{a}-{b}" for a, b, *_ in CASES])
def test_integrators_agree(model, name, solver, tolerance, record_evidence):
    make, channels, _ = MODELS[model]
    known = reference(model)
    apart = (mb.simulate(make(), TIMES[-1], solver, TIMES).channels(channels) - known) / np.ptp(known, axis=0)
    record_evidence(
        f"{model}: {name} against Radau IIA, relative to the range",
        0.0,
        np.max(np.abs(apart)),
        tolerance=tolerance,
        topic=TOPIC,
        kind="other method",
        source=SOURCE,
    )
