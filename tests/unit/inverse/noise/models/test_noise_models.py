"""Arguments of noise models."""

import pytest

from dalembert.errors import InputError
from dalembert.inverse.noise.models.correlated_noise import AutoregressiveNoise, OrnsteinUhlenbeckNoise
from dalembert.inverse.noise.models.independent_noise import ConstantNoise, MixedNoise, ProportionalNoise


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: ConstantNoise(deviation=-1.0),
            "ConstantNoise: deviation is -1.0; expected a positive number, or two of them, the lower one first",
        ),
        (
            lambda: ProportionalNoise(relative=(0.2, 0.1)),
            "ProportionalNoise: relative is (0.2, 0.1); expected a positive number, or two of them, the lower one first",
        ),
        (
            lambda: MixedNoise(deviation=(0.0, 1.0)),
            "MixedNoise: deviation is (0.0, 1.0); expected a positive number, or two of them, the lower one first",
        ),
        (
            lambda: MixedNoise(relative="much"),
            "MixedNoise: relative is 'much'; expected a number or two finite numbers, such as (0.0, 0.0)",
        ),
        (
            lambda: AutoregressiveNoise(order=-1),
            "AutoregressiveNoise: order is -1; expected a whole number, at least 0",
        ),
        (
            lambda: AutoregressiveNoise(partial=(0.5, 1.5)),
            "AutoregressiveNoise: partial has 1.5; expected numbers between -1 and 1",
        ),
        (
            lambda: AutoregressiveNoise(order=1, partial=(0.5, 0.1)),
            "AutoregressiveNoise: order is 1, but partial has 2 numbers; give as many",
        ),
        (
            lambda: AutoregressiveNoise(deviation=ConstantNoise(local=True)),
            "AutoregressiveNoise: local is an argument of AutoregressiveNoise, not of its deviation; give it there",
        ),
        (
            lambda: OrnsteinUhlenbeckNoise(time=0.0),
            "OrnsteinUhlenbeckNoise: time is 0.0; expected a positive number, or two of them, the lower one first",
        ),
    ],
)
def test_arguments_that_cannot_be_are_refused(make, message):
    with pytest.raises(InputError) as refused:
        make()
    assert str(refused.value) == message


def test_a_correlated_model_is_no_model_of_a_deviation():
    with pytest.raises(InputError, match="expected a model of independent noise"):
        OrnsteinUhlenbeckNoise(deviation=AutoregressiveNoise(order=1))
