"""Repeated identifications of simulated torques."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.inverse.inertial import Recovery, simulated_recovery
from serial_arm import PLANAR, swinging, truth, wrong

MOTIONS = [PLANAR.regressor(*swinging(2, seed, 100)[1:]) for seed in (1, 2)]
TRUE = truth(PLANAR)


def test_few_runs(tmp_path):
    found, again = (
        simulated_recovery(*MOTIONS, PLANAR.names, TRUE, wrong(TRUE, 2, 0.3, 1), links=PLANAR.links, runs=10)
        for _ in range(2)
    )
    np.testing.assert_array_equal(found.prediction, again.prediction)
    assert found.covered.shape == (10, 6)
    assert found.covered.mean() > 0.8
    assert found.consistent.all()
    assert np.all(found.prediction / found.unseen_noise < 1.1)
    assert found.gradients.max() < 1e-5
    found.save(tmp_path / "recovery.nc")
    assert Recovery.load(tmp_path / "recovery.nc").summary() == found.summary()


def test_invalid_input():
    message = "simulated_recovery: runs 0, noise 0.02; expected positive numbers"
    with pytest.raises(InputError) as refused:
        simulated_recovery(*MOTIONS, PLANAR.names, TRUE, TRUE, links=PLANAR.links, runs=0)
    assert str(refused.value) == message
