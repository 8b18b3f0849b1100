"""Weighted least squares of base parameters."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.inverse.inertial import BaseEstimate, identify_base
from serial_arm import PLANAR, swinging, truth

TABLE = PLANAR.regressor(*swinging(2, 1, 150)[1:])
TRUE = truth(PLANAR)
NOISE = np.array([0.5, 0.02])


def measured(seed, correlation=0.0):
    noise = NOISE * np.random.default_rng(seed).standard_normal((150, 2))
    for k in range(1, 150):
        noise[k] += correlation * noise[k - 1]
    return TABLE @ TRUE + noise


def test_weights_follow_the_noise_of_each_joint():
    found = identify_base(TABLE, measured(0), PLANAR.names, joints=["shoulder", "elbow"])
    assert found.status == "Converged."
    np.testing.assert_allclose(found.noise, NOISE, rtol=0.15)
    given = identify_base(TABLE, measured(0), PLANAR.names, deviations=NOISE)
    np.testing.assert_allclose(found.values, given.values, rtol=2e-3, atol=2e-3)
    assert "shoulder  " in found.summary()


def test_equal_weights_are_worse_for_the_parameters_of_the_quiet_joint():
    errors = []
    for seed in range(20):
        for given in (None, 1.0):
            found = identify_base(TABLE, measured(seed), PLANAR.names, deviations=given)
            errors.append((found.values - found.base.values(TRUE))[3:])
    weighted, plain = (np.sqrt(np.mean(np.square(errors[k::2]))) for k in (0, 1))
    assert plain > 3 * weighted


def test_normalised_errors_have_unit_variance():
    """Sum of squares of normalised errors: chi-square with 6 degrees of freedom, mean over 200 runs within 4 deviations."""
    sums = []
    for seed in range(200):
        found = identify_base(TABLE, measured(seed), PLANAR.names)
        error = found.values - found.base.values(TRUE)
        sums.append(error @ np.linalg.solve(found.covariance, error))
    assert abs(np.mean(sums) - 6) < 4 * np.sqrt(2 * 6 / 200) + 0.1


def test_correlated_residuals_are_a_warning():
    (found,) = identify_base(TABLE, measured(0, 0.9), PLANAR.names).findings
    assert (found.code, found.severity) == ("correlated-torques", "warning")
    assert found.values["autocorrelation"] > 0.7


def test_a_stored_result_is_the_same(tmp_path):
    found = identify_base(TABLE, measured(0), PLANAR.names)
    found.save(tmp_path / "base.nc")
    again = BaseEstimate.load(tmp_path / "base.nc")
    assert again.summary() == found.summary()
    assert again.intervals() == found.intervals()
    np.testing.assert_array_equal(again.torques(TABLE), found.torques(TABLE))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"torques": np.zeros((3, 2))}, "identify_base: the torques have the shape (3, 2); expected (150, 2) (samples, joints), as the regressor"),
        ({"torques": np.full((150, 2), np.inf)}, "identify_base: the torques have a number that is not finite (sample 0, joint 0). Remove this sample"),
        ({"joints": ["a"]}, "identify_base: 1 names of joints; expected 2, as the regressor has"),
        ({"deviations": [1.0, 0.0]}, "identify_base: deviations are [1.0, 0.0]; expected a positive number, or 2 of them, one for each joint"),
    ],
)  # fmt: skip
def test_invalid_input(change, message):
    with pytest.raises(InputError) as refused:
        identify_base(**{"regressor": TABLE, "torques": measured(0), "names": PLANAR.names, **change})
    assert str(refused.value) == message
