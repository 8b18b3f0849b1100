"""Base parameters of arms, against closed forms."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.inverse.inertial import BaseParameters, base_parameters
from serial_arm import PLANAR, SIX, THREE, swinging


def motion_of(arm, seed=1, samples=120):
    return arm.regressor(*swinging(arm.joints, seed, samples)[1:])


def test_combinations_of_two_links_in_a_plane_are_the_closed_form():
    """m1 c1 + l m2 and I1 + l² m2 with l = 0.4; nothing else of the masses."""
    found = base_parameters(motion_of(PLANAR), PLANAR.names)
    assert found.words == (
        "link1.first_x + 0.4 link2.mass",
        "link1.first_y",
        "link1.second_zz + 0.16 link2.mass",
        "link2.first_x",
        "link2.first_y",
        "link2.second_zz",
    )
    assert "link1.mass" in found.unidentifiable
    assert "link2.mass" not in found.unidentifiable
    assert found.findings == ()


@pytest.mark.parametrize("arm", [PLANAR, THREE, SIX], ids=["planar", "three", "six"])
def test_base_parameters_give_the_same_torques(arm):
    table, other = motion_of(arm), motion_of(arm, seed=9)
    found = base_parameters(table, arm.names)
    values = np.random.default_rng(0).normal(size=len(arm.names))
    np.testing.assert_allclose(
        other[..., found.independent] @ found.values(values), other @ values, rtol=1e-9, atol=1e-8
    )
    assert found.pivots[found.rank - 1] > 1e-2
    assert found.pivots[found.rank :].max() < 1e-12


def test_noise_of_the_regressor_does_not_raise_the_rank():
    table = motion_of(THREE, samples=400)
    noisy = table * (1 + 1e-3 * np.random.default_rng(0).standard_normal(table.shape))
    exact = base_parameters(table, THREE.names).rank
    assert base_parameters(noisy, THREE.names, noise=1e-3).rank == exact
    assert base_parameters(noisy, THREE.names).rank > exact


def test_findings():
    rng = np.random.default_rng(0)
    first = rng.standard_normal((100, 1))
    close = np.stack([first, first + 1e-3 * rng.standard_normal((100, 1))], axis=-1)
    (found,) = base_parameters(close, ["a", "b"]).findings
    assert (found.code, found.severity) == ("ill-conditioned-regressor", "warning")
    assert found.message.startswith("The condition number of the 2 scaled columns is ")
    (_, found) = sorted(
        base_parameters(np.concatenate([close, close[..., :1] + 3e-4 * rng.standard_normal((100, 1, 1))], axis=-1), "abc", noise=2e-4).findings,
        key=lambda one: one.code,
    )  # fmt: skip
    assert found.code == "unclear-rank"
    assert found.values["rank"] == 2


def test_a_stored_result_is_the_same(tmp_path):
    found = base_parameters(motion_of(THREE), THREE.names)
    found.save(tmp_path / "base.nc")
    again = BaseParameters.load(tmp_path / "base.nc")
    assert again.words == found.words
    assert again.summary() == found.summary()
    assert found.facts()["rank"] == "22 of 39"


@pytest.mark.parametrize(
    ("table", "names", "noise", "message"),
    [
        (np.ones((5, 2)), "ab", 0.0, "base_parameters: the regressor has the shape (5, 2); expected (samples, joints, 2) for 2 names"),
        (np.ones((5, 1, 2)), "aa", 0.0, "base_parameters: 'a' is named twice. Give each parameter its own name"),
        (np.full((5, 1, 2), np.nan), "ab", 0.0, "base_parameters: the regressor has a number that is not finite (sample 0, joint 0). Remove this sample"),
        (np.ones((1, 1, 2)), "ab", 0.0, "base_parameters: the regressor has 1 rows (samples x joints) for 2 parameters. Give more samples"),
        (np.zeros((5, 1, 2)), "ab", 0.0, "base_parameters: the regressor is zero. Give a regressor along a motion"),
        (np.ones((5, 1, 2)), "ab", 2.0, "base_parameters: noise is 2.0; expected a relative size from 0 to 1, such as 0.01"),
    ],
)  # fmt: skip
def test_invalid_input(table, names, noise, message):
    with pytest.raises(InputError) as refused:
        base_parameters(table, list(names), noise=noise)
    assert str(refused.value) == message
