"""The number of harmonics that is chosen by the truncation error."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.forward import Channel, findings_at
from dalembert.structure import lumped
from dalembert.vibration import (
    CubicSpring,
    ElasticSlider,
    FollowedPoint,
    FrequencyResponse,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    ResonanceTrack,
    Rigid,
    VibrationSystem,
    backbone,
    floquet_multipliers,
    frequency_response,
    frequency_responses,
    track_resonance,
)
from support import says
from vibrating_systems import duffing, one_mass, two_masses

AUTO = HarmonicBalance("auto")
FREQUENCIES = np.linspace(0.1, 0.25, 9)


def block(friction: float = 0.5) -> VibrationSystem:
    """A mass with rigid friction that needs many harmonics."""
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.0)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("foot", "m", friction=friction, preload=1.0, law=Rigid(prediction="velocity")))
    return system


def hardening(stiffness: float) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.1)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(CubicSpring("spring", "m", stiffness=stiffness))
    return system


def slider(preload: float) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0))
    law = ElasticSlider(tangential_stiffness=0.8)
    system.add(FrictionContact("damper", "m", friction=0.5, preload=preload, law=law))
    return system


def test_a_curve_has_one_number_and_says_it() -> None:
    curve = frequency_response(two_masses(), FREQUENCIES, AUTO)
    fine = frequency_response(two_masses(), FREQUENCIES, HarmonicBalance(31), check=False)
    (chosen,) = curve.findings
    assert (chosen.code, chosen.severity) == ("harmonics-chosen", "note")
    assert chosen.values["harmonics"] == curve.orders[-1] == 7
    assert chosen.values["error"] <= chosen.values["truncation"] == 5e-3
    np.testing.assert_allclose(curve.amplitude("m2"), fine.amplitude("m2"), rtol=5e-3)
    given = frequency_response(two_masses(), FREQUENCIES, HarmonicBalance(7))
    np.testing.assert_allclose(curve.amplitude("m2"), given.amplitude("m2"), rtol=1e-8)
    assert "7 harmonics were chosen" in curve.summary()
    assert len(floquet_multipliers(two_masses(), curve, 0))


def test_no_more_harmonics_than_a_linear_system_needs() -> None:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0, harmonic=4))
    curve = frequency_response(system, FREQUENCIES, AUTO)
    assert curve.orders[-1] == 9  # twice the harmonic of the force and one more
    assert curve.findings[0].values["error"] == 0.0


def test_odd_harmonics_stay_odd() -> None:
    curve = frequency_response(one_mass(), FREQUENCIES, HarmonicBalance("auto", odd_only=True, truncation=1e-4))
    assert set(np.array(curve.orders) % 2) == {1}
    assert curve.findings[0].values["error"] <= 1e-4
    assert curve.orders[-1] > 3


def test_a_limit_that_does_not_suffice_is_a_finding() -> None:
    curve = frequency_response(block(), np.array([0.6]) / (2 * np.pi), HarmonicBalance("auto", most_harmonics=20))
    (few,) = curve.findings
    assert (few.code, few.severity, few.values["harmonics"]) == ("few-harmonics", "error", 15)
    assert few.values["error"] > 5e-3
    assert few.advice.startswith("The limit is 20 harmonics: raise most_harmonics, ")
    assert not curve.success


def test_given_harmonics_that_do_not_suffice_name_the_choice() -> None:
    (few,) = frequency_response(block(), np.array([0.6]) / (2 * np.pi)).findings
    assert few.code == "few-harmonics"
    assert few.advice.startswith('Use harmonics="auto", ')
    finer = HarmonicBalance(truncation=0.9)
    assert not frequency_response(block(), np.array([0.6]) / (2 * np.pi), finer).findings


def test_a_path_is_followed_until_its_harmonics_suffice_and_then_judged() -> None:
    told: list[FollowedPoint] = []
    method = HarmonicBalance("auto", truncation=1e-4)
    curve = frequency_response(
        duffing(), (0.12, 0.3), method, continuation="arc-length", stability=True, on_point=told.append
    )
    numbers = [one.orders[-1] for one in told]
    assert numbers == sorted(numbers)
    assert {numbers[0], numbers[-1]} == {3, curve.orders[-1]}
    assert curve.orders[-1] > 3
    assert [marker for marker, _ in curve.markers] == ["fold", "fold"]
    assert np.all(curve.stable >= 0)


def test_a_curve_starts_from_one_with_fewer_harmonics() -> None:
    up = frequency_response(duffing(), np.linspace(0.12, 0.195, 16), HarmonicBalance(3))
    method = HarmonicBalance("auto", truncation=1e-4)
    again = frequency_response(duffing(), np.array([0.195, 0.19]), method, start=(up, len(up) - 1))
    assert again.orders[-1] > 3
    assert again.amplitude("m")[0] == pytest.approx(up.amplitude("m")[-1], rel=1e-2)
    wider = frequency_response(duffing(), np.array([0.195]), HarmonicBalance(5), start=(up, len(up) - 1))
    assert wider.amplitude("m")[0] == pytest.approx(again.amplitude("m")[0], rel=1e-2)


def test_each_curve_of_a_family_has_its_number() -> None:
    family = frequency_responses(block, "friction", [0.1, 0.3], np.array([0.6, 0.8]) / (2 * np.pi), AUTO)
    numbers = [0 if curve is None else curve.orders[-1] for curve in family.curves]
    assert numbers[0] < numbers[1]
    (chosen,) = family.findings
    assert (chosen.values["value"], chosen.values["harmonics"]) == (0.3, numbers[1])
    assert f"friction = 0.3: {numbers[1]} harmonics were chosen" in family.summary()
    limited = frequency_responses(
        block, "friction", [0.1, 0.3], np.array([0.6]) / (2 * np.pi), replace(AUTO, most_harmonics=7)
    )
    assert [finding.code for finding in limited.findings] == ["few-harmonics", "harmonics-chosen"]
    assert not limited.success


def test_a_backbone_has_enough_harmonics() -> None:
    amplitudes = np.geomspace(0.1, 100.0, 6)
    method = HarmonicBalance("auto", truncation=1e-3)
    mode, fine = (
        backbone(one_mass(), amplitudes, method=method),
        backbone(one_mass(), amplitudes, method=HarmonicBalance(31)),
    )
    assert 3 < mode.orders[-1] < 31
    assert mode.findings[0].values["harmonics"] == mode.orders[-1]
    np.testing.assert_allclose(mode.frequencies, fine.frequencies, rtol=1e-3)
    np.testing.assert_allclose(mode.damping, fine.damping, rtol=1e-3, atol=1e-6)
    np.testing.assert_allclose(mode.amplitude("m"), fine.amplitude("m"), rtol=1e-3)
    few = backbone(one_mass(), amplitudes, method=replace(method, most_harmonics=3))
    assert [finding.code for finding in few.findings] == ["few-harmonics"]


def test_a_tracked_peak_has_enough_harmonics(tmp_path) -> None:
    method = HarmonicBalance("auto", truncation=1e-3)
    track = track_resonance(slider, "preload", [2.0, 4.0, 8.0], (0.1, 0.3), method, dof="m")
    fine = track_resonance(slider, "preload", [2.0, 4.0, 8.0], (0.1, 0.3), HarmonicBalance(31), dof="m")
    np.testing.assert_allclose(track.amplitudes, fine.amplitudes, rtol=1e-3)
    assert track.provenance["method"]["harmonics"] == track.findings[0].values["harmonics"] < 31
    track.save(tmp_path / "track.nc")
    assert ResonanceTrack.load(tmp_path / "track.nc").findings == track.findings
    curve = frequency_response(slider(2.0), np.linspace(0.16, 0.19, 13), HarmonicBalance(3))
    again = track_resonance(slider, "preload", [2.0, 4.0, 8.0], curve, method, dof="m")
    np.testing.assert_allclose(again.amplitudes, fine.amplitudes, rtol=1e-3)


def test_a_model_chooses_once_and_keeps_the_number() -> None:
    model = FrequencyResponse(hardening, {"stiffness": (0.1, 0.3)}, ["m peak", "m harmonic 3"], FREQUENCIES, AUTO)
    number = model.balance.harmonics
    assert (
        number == frequency_response(hardening(0.2), FREQUENCIES, HarmonicBalance("auto", least_harmonics=7)).orders[-1]
    )
    assert pickle.loads(pickle.dumps(model.first(3))).balance == model.balance
    finer = model.refined()
    assert finer is not None
    assert finer.model.balance.harmonics == 2 * number + 1
    assert finer.model.findings(np.array([0.2])) == ()
    given = FrequencyResponse(
        hardening, {"stiffness": (0.1, 0.3)}, ["m peak", "m harmonic 3"], FREQUENCIES, HarmonicBalance(number)
    )
    vector = np.array([0.25])
    np.testing.assert_array_equal(model.evaluate(vector[None]).values, given.evaluate(vector[None]).values)
    np.testing.assert_array_equal(model.jacobian(vector), given.jacobian(vector))
    (chosen,) = findings_at(model, vector)
    assert (chosen.code, chosen.values["harmonics"]) == ("harmonics-chosen", number)
    assert findings_at(given, vector) == ()
    assert model.channels[0] == Channel("m peak", "m")


def test_a_model_says_where_the_chosen_number_is_too_small() -> None:
    model = FrequencyResponse(block, {"friction": (0.05, 0.5)}, ["m peak"], np.array([0.6]) / (2 * np.pi), AUTO)
    model.parameters.start[0] = 0.1
    few = [finding for finding in model.findings(np.array([0.3])) if finding.code == "few-harmonics"]
    assert len(few) == 1


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda: HarmonicBalance("many"),
            "HarmonicBalance: harmonics is 'many'; expected a whole number or 'auto'",
        ),
        (
            lambda: HarmonicBalance("auto", least_harmonics=9, most_harmonics=5),
            "HarmonicBalance: most_harmonics is 5, less than least_harmonics, 9. Raise most_harmonics",
        ),
        (
            lambda: HarmonicBalance("auto", samples=100),
            "HarmonicBalance: samples is 100, too few for 127 harmonics. Use at least 255",
        ),
        (lambda: AUTO.orders, "HarmonicBalance: harmonics is 'auto', which is not possible here. Give a number"),
    ],
)
def test_settings_that_make_no_sense_are_refused(make, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        make()
