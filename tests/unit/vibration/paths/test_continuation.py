"""Paths over frequency past turns, and points that only the curve itself leads to."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from dalembert.vibration import HarmonicBalance, frequency_response
from dalembert.vibration.balance import balance
from dalembert.vibration.paths import continuation
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


@dataclass(frozen=True)
class OnBranch:
    """A solution of :class:`TwoBranches`."""

    omega: float
    unknowns: np.ndarray
    converged: bool
    samples: int = 64
    iterations: int = 1

    def rate(self) -> np.ndarray:
        return np.zeros_like(self.unknowns)


class TwoBranches:
    """The branch at 0 ends at ω = 2; that at 1 begins at 1.5, and Newton's method reaches it from 0 at 3 only."""

    method = HarmonicBalance(halvings=0)

    def solve(self, unknowns: np.ndarray, omega: float, samples: int, plane: object = None) -> OnBranch:
        on_second = bool(unknowns[0] > 0.5)
        if omega >= 3 or (on_second and omega >= 1.5):
            return OnBranch(omega, np.ones(1), converged=True)
        return OnBranch(omega, unknowns, converged=not on_second and omega < 2)

    def first(self, omega: float) -> OnBranch:
        return self.solve(np.zeros(1), omega, 64)


def test_points_that_are_not_found_are_sought_from_behind() -> None:
    points = continuation.at_frequencies(TwoBranches(), np.array([1.0, 2.0, 2.5, 3.0]), None)
    found = [point.solution for point in points]
    assert [(one.omega, one.unknowns[0]) for one in found] == [(1.0, 0.0), (2.0, 1.0), (2.5, 1.0), (3.0, 1.0)]
    assert all(one.converged for one in found)
    assert [
        point.solution.converged for point in continuation.at_frequencies(TwoBranches(), np.array([1.0, 2.0]), None)
    ] == [1, 0]
