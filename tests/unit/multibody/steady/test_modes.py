"""Small vibrations: both ways of solving, and what is left out."""

import numpy as np
import pytest

import dalembert as da


def oscillator(damping: float) -> da.System:
    """Mass 2 kg between two springs of 50 N/m in line, held on the line by a slide."""
    system = da.System(gravity=(0.0, 0.0))
    slider = system.add(da.RigidBody("slider", mass=2.0, inertia=1.0))
    system.add(da.PrismaticJoint("slide", system.ground, slider.centre))
    for name, x in (("left", -1.0), ("right", 1.0)):
        system.add(da.Spring(name, system.ground.point(x, 0.0), slider.centre, stiffness=50.0, damping=damping / 2))
    return system


@pytest.mark.parametrize("damping", [0.0, 4.0])
def test_an_oscillator(damping: float) -> None:
    found = da.modes(oscillator(damping))
    natural, ratio = np.sqrt(100.0 / 2.0), damping / (2 * np.sqrt(100.0 * 2.0))
    np.testing.assert_allclose(found.frequencies, [natural * np.sqrt(1 - ratio**2) / (2 * np.pi)], rtol=1e-12)
    np.testing.assert_allclose(found.damping_ratios, [ratio], atol=1e-12)
    np.testing.assert_allclose(np.abs(found.shapes[:3, 0]), [1.0, 0.0, 0.0], atol=1e-12)


def test_an_aperiodic_motion_is_no_vibration() -> None:
    assert len(da.modes(oscillator(damping=100.0)).frequencies) == 0


def test_a_pendulum_hangs() -> None:
    """A uniform rod swings with the square of its angular frequency at 3 g / (2 L)."""
    system = da.System()
    rod = system.add(da.RigidBar("rod", length=1.2, mass=3.0, angle=-np.pi / 2))
    system.add(da.RevoluteJoint("pin", system.ground, rod.start))
    np.testing.assert_allclose(da.modes(system).frequencies, [np.sqrt(1.5 * 9.81 / 1.2) / (2 * np.pi)], rtol=1e-10)
