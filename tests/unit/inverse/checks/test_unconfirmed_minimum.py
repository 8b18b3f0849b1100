"""A minimum that one of several starts reached is confirmed by others, by noise-like residuals or by known noise."""

from dataclasses import replace

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import PythonModel
from dalembert.inverse import identify
from dalembert.inverse.checks.unconfirmed_minimum import single_start
from dalembert.inverse.identification.search import MisfitMinimum
from dalembert.inverse.least_squares.descent import End
from dalembert.inverse.noise.noise_floor import NoiseFloor
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import pose

TIMES = np.linspace(0.0, 10.0, 101)
FLOOR = NoiseFloor(1e-6, "arithmetic", True)
SWING = PythonModel(lambda rate: np.cos(rate * TIMES), {"rate": (0.5, 8.0)}, ["x"], TIMES)
LACKING = Measurements.of(TIMES, {"x": np.cos(6.3 * TIMES) + 0.3 * np.sin(TIMES)})


@pytest.fixture(scope="module")
def problem():
    return pose(SWING, LACKING, None, Journal(101))


def end(problem, rate):
    point = problem.search.points(np.array([rate]))
    return End(point, float(problem.misfit(point[None])[0]), True, "")


def codes(problem, rates, best=6.3, floor=FLOOR):
    ends = [end(problem, rate) for rate in rates]
    return list(single_start(MisfitMinimum(problem, end(problem, best), floor, ends)))


def test_a_minimum_that_one_start_of_three_reached_is_no_success(problem):
    (found,) = codes(problem, [6.3, 1.0, 3.1])
    assert (found.code, found.severity) == ("unconfirmed-minimum", "error")
    assert found.values == {"at_best": 1, "starts": 3}


def test_starts_that_lead_to_the_same_minimum_confirm_it(problem):
    assert not codes(problem, [6.3, 6.3, 1.0])
    assert not codes(problem, [6.3, 6.32, 1.0])  # on its way


def test_a_misfit_that_known_noise_explains_confirms_a_minimum(problem):
    assert not codes(problem, [6.3, 1.0, 3.1], floor=replace(FLOOR, misfit=1e9))


def test_residuals_like_noise_confirm_a_minimum():
    """One start of three is at the frequency; only noise remains."""
    noise = 0.05 * np.random.default_rng(0).standard_normal(101)
    noisy = Measurements.of(TIMES, {"x": np.cos(6.3 * TIMES) + noise})
    model = PythonModel(lambda rate: np.cos(rate * TIMES), {"rate": (0.5, 30.0)}, ["x"], TIMES)
    assert identify(model, noisy, starts=3, start={"rate": 6.3}, horizon=None).success


def test_two_starts_and_fits_that_did_not_converge_have_no_finding(problem):
    assert not codes(problem, [6.3, 1.0])
    ends = [end(problem, rate) for rate in (6.3, 1.0, 3.1)]
    failed = replace(ends[0], success=False)
    assert not list(single_start(MisfitMinimum(problem, failed, FLOOR, ends)))


def test_an_identification_with_an_unconfirmed_minimum_is_no_success():
    """One start of three is at the frequency; a slow motion that the model lacks remains."""
    model = PythonModel(lambda rate: np.cos(rate * TIMES), {"rate": (0.5, 30.0)}, ["x"], TIMES)
    fit = identify(model, LACKING, starts=3, start={"rate": 6.3}, horizon=None)
    assert not fit.success
    assert fit.outcome[-1].code == "unconfirmed-minimum"
    assert identify(model, LACKING, starts=1, start={"rate": 6.3}, horizon=None).success
