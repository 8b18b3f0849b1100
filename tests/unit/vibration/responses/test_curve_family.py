"""Curves for several values of a parameter: peaks, the best value, the envelope, and what could not be computed."""

import numpy as np
import pytest

from dalembert.errors import InputError, SolveError
from dalembert.structure import lumped
from dalembert.vibration import (
    CubicSpring,
    CurveFamily,
    ElasticSlider,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    VibrationSystem,
    frequency_response,
    frequency_responses,
)
from support import says

FREQUENCIES = np.linspace(0.12, 0.25, 14)
METHOD = HarmonicBalance(3, samples=128)


def damped(preload: float) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("damper", "m", friction=0.5, preload=preload, law=ElasticSlider(0.8)))
    return system


def free_or_damped(preload: float) -> VibrationSystem:
    """Without a load there is no contact at all."""
    system = damped(preload)
    system.elements = system.elements if preload else []
    return system


def hardening(force: float) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.05)]))
    system.add(HarmonicForce("m", force))
    system.add(CubicSpring("cubic", "m", stiffness=0.1))
    return system


def test_each_curve_is_that_of_its_value() -> None:
    told: list[tuple] = []
    family = frequency_responses(
        damped, "preload", [0.0, 2.0], FREQUENCIES, METHOD, unit="N", workers=2, on_curve=lambda *one: told.append(one)
    )
    alone = [frequency_response(damped(preload), FREQUENCIES, METHOD) for preload in (0.0, 2.0)]
    for one, other in zip(family.curves, alone, strict=True):
        assert one is not None
        np.testing.assert_array_equal(one.response, other.response)
    assert family.peaks("m") == tuple(one.peak("m") for one in alone)
    assert told == [(0, family.curves[0], None), (1, family.curves[1], None)]
    assert family.success
    assert family.best("m") == 2.0
    assert family.reduction("m")[1] == pytest.approx(1 - alone[1].peak("m").amplitude / alone[0].peak("m").amplitude)
    assert family.status == "2 of 2 curves over preload, 28 of 28 points found."
    assert family.facts()["preload of the smallest peak"] == "2 N"


@pytest.mark.parametrize("builder", [damped, free_or_damped])
def test_a_family_is_kept_to_the_bit(tmp_path, builder) -> None:
    family = frequency_responses(builder, "preload", [0.0, -1.0, 2.0], (0.12, 0.25), METHOD, unit="N")
    family.save(tmp_path / "family.nc")
    again = CurveFamily.load(tmp_path / "family.nc")
    assert (again.parameter, again.unit, again.failures) == (family.parameter, family.unit, family.failures)
    assert again.curves[1] is None
    for one, other in zip(again.curves, family.curves, strict=True):
        if one is not None and other is not None:
            np.testing.assert_array_equal(one.response, other.response)
            assert one.provenance == other.provenance
    assert again.summary() == family.summary()


def test_a_value_without_a_curve_is_marked_with_its_reason() -> None:
    family = frequency_responses(damped, "preload", [2.0, -1.0], FREQUENCIES, METHOD, unit="N")
    reason = "FrictionContact 'damper': preload is -1 N; expected zero or a positive number"
    assert family.failures == (None, reason)
    assert not family.success
    assert family.status == f"1 of 2 curves over preload, 14 of 14 points found; preload = -1: {reason}."
    assert np.isnan(family.peaks("m")[1].amplitude)
    assert family.best("m") == 2.0


def test_the_envelope_is_the_smallest_and_largest_of_all() -> None:
    family = frequency_responses(damped, "preload", [0.0, 1.0, 2.0, 20.0], FREQUENCIES, METHOD)
    every = np.array([one.amplitude("m") for one in family.curves if one is not None])
    envelope = family.envelope("m")
    np.testing.assert_allclose(envelope.frequencies, FREQUENCIES)
    np.testing.assert_allclose(envelope.smallest, every.min(axis=0))
    np.testing.assert_allclose(envelope.largest, every.max(axis=0))


def test_past_folds_all_branches_count() -> None:
    family = frequency_responses(hardening, "force", [0.18], (0.12, 0.25), METHOD, continuation="arc-length")
    envelope = family.envelope("m")
    (curve,) = family.curves
    assert curve is not None
    between = (curve.folds.min() < envelope.frequencies) & (envelope.frequencies < curve.folds.max())
    assert np.all(envelope.largest[between] > 1.5 * envelope.smallest[between])
    outside = envelope.frequencies > curve.folds.max()
    np.testing.assert_array_equal(envelope.largest[outside], envelope.smallest[outside])


def test_where_there_is_no_curve_at_all_the_first_reason_is_raised() -> None:
    with pytest.raises(
        InputError, match=says("FrictionContact 'damper': preload is -2 N; expected zero or a positive number")
    ):
        frequency_responses(damped, "preload", [-2.0, -1.0], FREQUENCIES, METHOD)
    with pytest.raises(
        InputError,
        match=says("frequency_responses: the values of 'preload' are []; expected one or more numbers"),
    ):
        frequency_responses(damped, "preload", [], FREQUENCIES, METHOD)


def test_a_builder_that_raises_is_the_failure_of_its_value() -> None:
    def builder(preload: float) -> VibrationSystem:
        return damped(1 / preload)

    line = builder.__code__.co_firstlineno + 1
    reason = f"ZeroDivisionError: float division by zero (test_curve_family.py, line {line})"
    family = frequency_responses(builder, "preload", [0.0, 2.0], FREQUENCIES, METHOD)
    assert family.failures == (reason, None)
    with pytest.raises(SolveError, match=says(reason)):
        frequency_responses(builder, "preload", [0.0], FREQUENCIES, METHOD)


def test_curves_that_nobody_waits_for_end_at_their_next_point() -> None:
    """As where the user stops a run while curves are followed in threads."""
    begun: list[float] = []

    def builder(preload: float) -> VibrationSystem:
        begun.append(preload)
        return damped(preload)

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    values, many = np.linspace(1.0, 2.0, 40), np.linspace(0.12, 0.25, 400)
    with pytest.raises(KeyboardInterrupt):
        frequency_responses(builder, "preload", values, many, METHOD, workers=2, on_curve=stop)
    assert len(begun) < 10
