"""The work of loads and losses is as exact as the motion, whichever integrator computed it."""

import numpy as np
import pytest

import dalembert as da
from dalembert.multibody import Integrator


def driven(torque: da.signals.Signal | None = None) -> da.System:
    """Two bars with viscous friction under a torque."""
    system = da.System()
    upper = system.add(da.RigidBar("upper", 1.0, 1.0, angle=0.3))
    lower = system.add(da.RigidBar("lower", 1.0, 1.0, start=upper.end, angle=-0.5))
    system.add(da.RevoluteJoint("shoulder", system.ground, upper.start, viscous=0.2))
    system.add(da.RevoluteJoint("elbow", upper.end, lower.start, viscous=0.1))
    system.add(da.Torque("motor", upper.end, torque or da.signals.Harmonic(2.0, 3.0)))
    return system


def gap(solver: Integrator, **options) -> float:
    return float(np.abs(da.simulate(driven(**options), 1.0, solver).energies["balance"]).max())


FIXED = {
    "generalized-alpha": (da.GeneralizedAlpha, 2),
    "without damping": (lambda step: da.GeneralizedAlpha(step, spectral_radius=1.0), 2),
    "variational": (da.Variational, 2),
    "energy-momentum": (da.EnergyMomentum, 2),
    "Runge-Kutta": (da.RungeKutta4, 4),
    "Radau IIA": (lambda step: da.RadauIIA(step=step), 4),
    "collocation": (da.Collocation, 2),
}


@pytest.mark.parametrize("name", FIXED)
def test_the_balance_converges_with_the_order_of_the_method_up_to_four(name: str) -> None:
    make, order = FIXED[name]
    coarse, fine = gap(make(8e-3)), gap(make(4e-3))
    assert np.log2(coarse / fine) > order - 0.2


@pytest.mark.parametrize(
    "solver", [da.RadauIIA(tolerance=1e-10), da.RungeKutta4(1e-3)], ids=["Radau IIA", "Runge-Kutta"]
)
def test_an_exact_motion_has_an_exact_balance(solver: Integrator) -> None:
    """The trapezoid rule leaves 5e-6 J."""
    assert gap(solver) < 1e-9


@pytest.mark.parametrize("solver", [da.RadauIIA(step=5e-3), da.RadauIIA(tolerance=1e-10)], ids=["fixed", "adaptive"])
def test_a_load_that_jumps_is_integrated_on_both_sides(solver: Integrator) -> None:
    """Jumps at times of which no step of a thousandth of the motion is one."""
    jump = da.signals.Step(3.0, start=0.25025, end=0.50075)
    assert gap(solver, torque=jump) < 2e-7
