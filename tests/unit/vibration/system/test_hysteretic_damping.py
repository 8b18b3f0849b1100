"""What is refused with hysteretic damping, and the files of curves with it."""

import re
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.structure import craig_bampton, lumped
from dalembert.vibration import (
    CubicSpring,
    FrequencyCurve,
    HarmonicBalance,
    HarmonicForce,
    VibrationSystem,
    backbone,
    compare_in_time,
    floquet_multipliers,
    frequency_response,
    steady_state,
)
from dalembert.vibration.interface.lowering import lower

METHOD = HarmonicBalance(3)
FREQUENCIES = np.array([0.1, 0.2])


def system(eta: float = 0.05) -> VibrationSystem:
    made = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.0, eta)]))
    made.add(HarmonicForce("m", 0.1))
    made.add(CubicSpring("cubic", "m", stiffness=0.1))
    return made


@pytest.fixture(scope="module")
def curve() -> FrequencyCurve:
    return frequency_response(system(), FREQUENCIES, METHOD)


@pytest.mark.parametrize(
    ("call", "what"),
    [
        (lambda curve: frequency_response(system(), FREQUENCIES, METHOD, stability=True), "stability"),
        (lambda curve: floquet_multipliers(system(), curve, 0), "stability"),
        (lambda curve: floquet_multipliers(system(), curve, 0, "time map"), "stability"),
        (lambda curve: backbone(system(), [0.1], method=METHOD), "nonlinear modes"),
        (lambda curve: steady_state(system(), 0.1), "motions in time"),
        (lambda curve: steady_state(system(), 0.1, way="shooting"), "motions in time"),
        (lambda curve: compare_in_time(system(), curve, points=[0]), "motions in time"),
    ],
)
def test_what_is_not_periodic_of_one_frequency_is_refused(
    curve: FrequencyCurve, call: Callable[[FrequencyCurve], object], what: str
) -> None:
    with pytest.raises(
        InputError, match=re.escape("hysteretic damping (loss), which is defined for harmonic motions only")
    ) as caught:
        call(curve)
    assert what in str(caught.value)
    assert "Modal(loss factor / 2)" in str(caught.value)


def test_a_loss_of_zero_is_none() -> None:
    assert frequency_response(system(0.0), FREQUENCIES, METHOD, stability=True).stable.all()


def test_checkpoints_of_other_losses_are_told_apart() -> None:
    names = {lower(system(eta)).fingerprint(METHOD) for eta in (0.0, 0.05, 0.06)}
    assert len(names) == 3


def test_a_reduced_structure_answers_as_the_full_one() -> None:
    names = [f"m{number}" for number in range(6)]
    springs = [("m0", None, 1.0, 0.0, 0.1)] + [(a, b, 1.0, 0.0, 0.02) for a, b in pairwise(names)]
    chain = lumped(dict.fromkeys(names, 1.0), springs)
    amplitudes = []
    for structure in (chain, craig_bampton(chain, ["m5"], modes=5)):
        made = VibrationSystem(structure)
        made.add(HarmonicForce("m5", 1.0))
        amplitudes.append(frequency_response(made, FREQUENCIES, METHOD, observe=["m5"]).amplitude("m5"))
    np.testing.assert_allclose(amplitudes[1], amplitudes[0], rtol=1e-12)
