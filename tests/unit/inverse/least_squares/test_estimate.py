"""Deviations, correlation and sentences against closed forms."""

import numpy as np
import pytest
from inline_snapshot import snapshot

from dalembert.inverse.least_squares.estimate import estimate
from dalembert.inverse.least_squares.identifiable import identifiability_findings
from dalembert.parameters import Parameters

TIMES = np.linspace(0, 2, 21)
LINE = np.stack([np.ones(21), TIMES], axis=1)


def test_a_straight_line_has_the_textbook_covariance():
    """Var(slope) = s²/Σ(t − t̄)², Var(offset) = s² Σt²/(n Σ(t − t̄)²), corr = −t̄ √(n/Σt²)."""
    scale, variance = np.array([3.0, 0.5]), 0.04
    told = estimate(LINE * scale, scale, variance)
    around = np.sum((TIMES - TIMES.mean()) ** 2)
    expected = np.sqrt([variance * np.sum(TIMES**2) / (21 * around), variance / around])
    np.testing.assert_allclose(told.deviations, expected, rtol=1e-12)
    np.testing.assert_allclose(told.correlation[0, 1], -TIMES.mean() * np.sqrt(21 / np.sum(TIMES**2)), rtol=1e-12)
    np.testing.assert_array_equal(np.diag(told.correlation), [1, 1])


def test_singular_values_and_directions_rebuild_the_information():
    told = estimate(LINE, np.ones(2), 1.0)
    rebuilt = told.directions.T @ np.diag(told.singular_values**2) @ told.directions
    np.testing.assert_allclose(rebuilt, LINE.T @ LINE, rtol=1e-12)


def test_a_combination_that_the_response_does_not_see_leaves_deviations_infinite():
    told = estimate(np.stack([TIMES, 2 * TIMES, np.ones(21)], axis=1), np.ones(3), 1.0)
    assert np.isinf(told.deviations[:2]).all()
    assert np.isfinite(told.deviations[2])
    np.testing.assert_allclose(told.correlation[0, 1], -1, rtol=1e-9)
    box = Parameters.of({"a": (0, 2), "b": (0, 2), "c": (-9, 9)})
    (finding,) = identifiability_findings(box, np.ones(3), told)
    assert str(finding) == snapshot(
        "Only a combination of 'a' and 'b' is identifiable: changing 'a' by +0.2 and 'b' by -0.1 together does not change the response. Fix one of them, or measure a quantity that separates them."
    )


def test_a_parameter_that_moves_too_little_to_be_named_with_the_others_is_said_to_be_unseen():
    told = estimate(np.stack([np.ones(21), 1 + 0.05 * TIMES, TIMES], axis=1), np.ones(3), 1.0)
    box = Parameters.of(dict.fromkeys("abc", (0, 2)))
    alone, together, *_ = identifiability_findings(box, np.ones(3), told)
    assert (alone.code, alone.values) == ("unidentifiable-parameter", {"parameter": "c"})
    assert str(alone) == snapshot(
        "'c' is not identifiable: it, or a combination with it, does not change the response. Fix it, or measure another channel."
    )
    assert (together.code, together.values["parameters"]) == ("unidentifiable-combination", "a, b")


def test_fewer_values_than_parameters_tell_at_most_as_many_combinations():
    told = estimate(np.array([[1.0, 0.0]]), np.ones(2), 1.0)
    assert told.deviations[0] == pytest.approx(1)
    assert np.isinf(told.deviations[1])


def test_a_response_that_sees_nothing_tells_nothing():
    assert np.isinf(estimate(np.zeros((5, 2)), np.ones(2), 1.0).deviations).all()


def test_a_parameter_on_a_bound_and_one_that_is_barely_known_are_named():
    box = Parameters.of({"stiffness": (0.0, 3.0), "mass": (0.0, 1.0)})
    told = estimate(np.diag([100.0, 1.0]), np.ones(2), 1.0)
    found = tuple(identifiability_findings(box, np.array([3.0, 0.5]), told))
    assert [item.code for item in found] == ["parameter-at-bound", "weakly-identifiable-parameter"]
    assert list(map(str, found)) == snapshot(
        [
            "'stiffness' is at its upper bound 3. Widen the bound if the true value may lie beyond it.",
            "'mass' is hardly identifiable: its standard deviation 1 exceeds 0.289, that of a uniform distribution between its bounds. Fix it, or measure more.",
        ]
    )
    lower = next(identifiability_findings(box, np.array([0.0, 0.5]), told))
    assert lower.values == {"parameter": "stiffness", "side": "lower", "bound": 0.0}


def test_the_bound_of_a_parameter_that_is_not_told_is_no_hint():
    box = Parameters.of({"stiffness": (0.0, 3.0), "mass": (0.0, 1.0)})
    told = estimate(np.diag([0.0, 100.0]), np.ones(2), 1.0)
    found = identifiability_findings(box, np.array([3.0, 0.5]), told)
    assert [item.code for item in found] == ["unidentifiable-parameter"]


def test_well_told_parameters_need_no_sentence():
    box = Parameters.of({"a": (0, 2), "b": (0, 2)})
    assert not list(identifiability_findings(box, np.ones(2), estimate(10 * LINE, np.ones(2), 0.01)))
