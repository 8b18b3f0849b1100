"""How many samples the balance of forces needs: 128 that are corrected at events leave an error below 1e-6."""

from collections.abc import Callable

import numpy as np
import pytest

from dalembert.structure import Dofs, Structure, lumped
from dalembert.vibration import (
    ElasticSlider,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    StaticForce,
    VibrationSystem,
    frequency_response,
)
from dalembert.vibration.balance.equations import equations
from dalembert.vibration.balance.newton import norm
from dalembert.vibration.laws.friction_law import SLIPPING
from vibrating_systems import chain, one_mass, pressed

HARMONICS, TURN = 7, 2 * np.pi
FINE, PLAIN = 4096, 2**15
"""Samples of the converged reference, and of the plain sums that it is compared with."""


def stopped() -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.05)]))
    system.add(HarmonicForce("m", 0.3))
    system.add(Gap("stop", "m", stiffness=10.0, gap=1.0))
    return system


def in_plane() -> VibrationSystem:
    """A mass that goes round on the ground under a force of which a part presses it."""
    stiffness, damping = np.diag([1.0, 1.3, 20.0]), np.diag([0.04, 0.05, 0.5])
    system = VibrationSystem(Structure(np.eye(3), stiffness, Dofs(("m.x", "m.y", "m.z")), damping))
    system.add(StaticForce("m.z", 8.0))
    system.add(HarmonicForce("m.x", 2.0))
    system.add(HarmonicForce("m.y", 2.0, 1.2))
    system.add(HarmonicForce("m.z", 2.0, 0.4))
    law = ElasticSlider(2.0, normal_stiffness=20.0)
    system.add(FrictionContact("foot", "m", tangential=("x", "y"), normal="z", friction=0.4, law=law))
    return system


CASES: dict[str, tuple[Callable[[], VibrationSystem], tuple[float, float]]] = {
    "elastic slider": (one_mass, (0.9, 1.3)),
    "unilateral stop": (stopped, (1.0, 1.6)),
    "three masses with sliders, cubic springs and a stop": (chain, (1.2, 2.0)),
    "load that varies": (lambda: pressed(100.0), (3.0, 4.5)),
    "two directions of slip": (in_plane, (0.8, 1.8)),
}


@pytest.mark.parametrize("name", CASES)
def test_128_samples_leave_an_error_below_1e6_of_the_forces(name: str) -> None:
    system, ends = CASES[name][0](), CASES[name][1]
    assert largest_error(system, ends, HarmonicBalance(HARMONICS, samples=128), FINE) < 1e-6
    assert largest_error(system, ends, HarmonicBalance(HARMONICS, samples=FINE), FINE, PLAIN) < 1e-4


@pytest.mark.parametrize("name", CASES)
def test_no_more_samples_are_chosen_than_the_error_asks_for(name: str) -> None:
    system, ends = CASES[name][0](), CASES[name][1]
    method = HarmonicBalance(HARMONICS)
    curve = frequency_response(system, np.linspace(*ends, 5) / TURN, method, check=False)
    assert curve.converged.all()
    assert np.all(curve.samples == method.first_samples)
    assert largest_error(system, ends, method, FINE) < method.sampling


def largest_error(
    system: VibrationSystem, ends: tuple[float, float], method: HarmonicBalance, fine: int, plain: int = 0
) -> float:
    """Largest difference to the balance with ``fine`` samples, or ``plain`` ones, over that of the forces."""
    curve = frequency_response(system, np.linspace(*ends, 5) / TURN, method, check=False)
    assert curve.converged.all()
    assert not curve.states.size or np.any(curve.states == SLIPPING)
    own = equations(system, method)
    reference = (
        equations(system, HarmonicBalance(HARMONICS, events=False)).balance(plain) if plain else own.balance(fine)
    )
    errors = []
    for unknowns, omega, samples in zip(curve.unknowns, TURN * curve.frequencies, curve.samples, strict=True):
        point, balance = own.condensation.at(omega), own.balance(int(samples))
        first, second = balance.at(point, unknowns), reference.at(point, unknowns)
        errors.append(norm(first.residual - second.residual) / (point.load + norm(second.forces)))
    return max(errors)
