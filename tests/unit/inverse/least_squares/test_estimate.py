"""Deviations, correlation and sentences against closed forms."""

import numpy as np
import pytest

from dalembert.inverse.least_squares.identifiable import identifiability_findings
from dalembert.inverse.least_squares.estimate import estimate
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
    assert sentences(box, np.ones(3), told) == (
        "'a' and 'b' can only be told in combination: moving 'a' by +0.2 and 'b' by -0.1 together leaves the response "
        "as it is; fix one of them, or measure what tells them apart.",
    )


def test_a_parameter_that_moves_too_little_to_be_named_with_the_others_is_said_to_be_unseen():
    told = estimate(np.stack([np.ones(21), 1 + 0.05 * TIMES, TIMES], axis=1), np.ones(3), 1.0)
    box = Parameters.of(dict.fromkeys("abc", (0, 2)))
    found = sentences(box, np.ones(3), told)
    assert "'a' and 'b' can only be told in combination" in found[1]
    assert found[0] == (
        "'c' is not told by the data: it, or a combination that it is part of, leaves the response as it is; fix it, "
        "or measure another channel."
    )


def test_fewer_values_than_parameters_tell_at_most_as_many_combinations():
    told = estimate(np.array([[1.0, 0.0]]), np.ones(2), 1.0)
    assert told.deviations[0] == pytest.approx(1)
    assert np.isinf(told.deviations[1])


def test_a_response_that_sees_nothing_tells_nothing():
    assert np.isinf(estimate(np.zeros((5, 2)), np.ones(2), 1.0).deviations).all()


def test_a_parameter_on_a_bound_and_one_that_is_barely_known_are_named():
    box = Parameters.of({"stiffness": (0.0, 3.0), "mass": (0.0, 1.0)})
    told = estimate(np.diag([100.0, 1.0]), np.ones(2), 1.0)
    assert sentences(box, np.array([3.0, 0.5]), told) == (
        "'stiffness' sits on its upper bound 3; widen the bound if the true value may lie beyond.",
        "'mass' is hardly told by the data: its deviation 1 exceeds the 0.289 of a mere guess between its bounds; "
        "fix it, or measure more.",
    )
    assert sentences(box, np.array([0.0, 0.5]), told)[0].startswith("'stiffness' sits on its lower bound 0;")


def test_the_bound_of_a_parameter_that_is_not_told_is_no_hint():
    box = Parameters.of({"stiffness": (0.0, 3.0), "mass": (0.0, 1.0)})
    told = estimate(np.diag([0.0, 100.0]), np.ones(2), 1.0)
    assert not any("sits on" in sentence for sentence in sentences(box, np.array([3.0, 0.5]), told))


def test_well_told_parameters_need_no_sentence():
    assert sentences(Parameters.of({"a": (0, 2), "b": (0, 2)}), np.ones(2), estimate(10 * LINE, np.ones(2), 0.01)) == ()
