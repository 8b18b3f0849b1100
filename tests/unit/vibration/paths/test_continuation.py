"""Paths over frequency past turns, and points that only the curve itself leads to."""

from dataclasses import replace

import numpy as np
import pytest

from dalembert.vibration import HarmonicBalance, frequency_response
from dalembert.vibration.balance import balance
from random_vibrations import ACCEPTED, METHOD, at_frequencies, path_end, random_system, unbalanced


def test_a_path_steps_over_a_sharp_turn() -> None:
    # A rigid contact that lifts off: the tangent turns by more than a quarter between two steps of any length.
    part, path = path_end(random_system(39))
    assert part == 1.0
    assert path.converged.all()


def test_a_path_steps_over_a_sharp_turn_with_the_jacobian_by_its_structure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(balance, "LARGE", 0)
    part, path = path_end(random_system(39))
    assert part == 1.0
    assert path.converged.all()


@pytest.mark.parametrize("number", [64, pytest.param(81, marks=pytest.mark.slow)])
def test_a_path_that_turns_back_behind_its_beginning_comes_again_and_reaches_the_end(number: int) -> None:
    own = random_system(number)
    part, path = path_end(own)
    assert part == 1.0
    assert path.frequencies.min() >= own.frequencies[0] * (1 - 1e-12)
    assert np.sum(np.isclose(path.frequencies, own.frequencies[0])) == 3


@pytest.mark.parametrize("number", [115, 168, *(pytest.param(number, marks=pytest.mark.slow) for number in (85, 121))])
def test_a_point_behind_a_fold_is_found_along_the_curve(number: int) -> None:
    outcome = at_frequencies(random_system(number))
    assert len(outcome.residuals) == 5
    assert max(outcome.residuals) < ACCEPTED


@pytest.mark.slow
def test_a_mass_that_bounces_on_a_rigid_contact_is_found_from_a_motion_that_just_touches() -> None:
    own = random_system(9)
    curve = frequency_response(own.system, own.frequencies[2:], METHOD, check=False)
    assert curve.converged.all()
    assert max(unbalanced(own, curve, point) for point in range(3)) < ACCEPTED


def test_a_contact_that_can_stay_closed_does_so_at_a_first_point() -> None:
    own = random_system(55)
    _, path = path_end(own)
    assert np.abs(path.response[0]).max() < 1e-12


def test_the_evaluation_of_forces_in_plain_numpy_refuses_a_point_that_is_no_solution() -> None:
    own = random_system(3)
    curve = frequency_response(own.system, own.frequencies, METHOD)
    assert max(unbalanced(own, curve, point) for point in range(5)) < 1e-9
    moved = replace(curve, response=curve.response * (1 + 1e-6))
    assert unbalanced(own, moved, 0) > 1e-8
    few = frequency_response(own.system, own.frequencies, HarmonicBalance(5, samples=64, events=False))
    assert unbalanced(own, few, 0) > 1e-5
