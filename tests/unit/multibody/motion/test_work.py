"""Work of dampers that are too strong for the step: the energy balance holds."""

import numpy as np
import pytest

import dalembert.multibody as mb


@pytest.mark.parametrize("method", [mb.Variational(1e-3), mb.EnergyMomentum(1e-3), mb.GeneralizedAlpha(1e-3)])
def test_strong_dampers_take_the_energy_that_the_motion_loses(method):
    """Stretch and shear of the beam are damped within a thousandth of a step, so that their rates are no motion."""
    system = mb.System()
    beam = system.add(mb.AncfBeam("beam", 1.0, 4, 1e9, 0.3, 1000.0, 0.01, 0.02, damping=1e-3))
    system.add(mb.FixedJoint("clamp", system.ground, beam.start))
    energies = mb.simulate(system, 0.3, method).energies
    assert energies["total"][-1] < -1.5e-3
    assert np.abs(energies["balance"]).max() < 0.02 * np.abs(energies["total"][-1])
