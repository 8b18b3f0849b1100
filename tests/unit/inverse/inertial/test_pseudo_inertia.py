"""Pseudo-inertias and log-Cholesky parameters against the definition, another package of dalembert and complex steps."""

import numpy as np
import pytest

from dalembert.inverse.inertial import (
    ENTRIES,
    bregman_distances,
    from_log_cholesky,
    inertial_parameters,
    log_cholesky,
    parameter_names,
    pseudo_inertia,
    smallest_eigenvalues,
)
from dalembert.inverse.inertial.log_cholesky import log_cholesky_jacobian
from dalembert.multibody.spatial import Inertia
from serial_arm import bodies


def test_a_pseudo_inertia_is_that_of_the_multibody_package():
    inertia = Inertia(3.0, (0.05, 0.06, 0.07), (0.001, -0.002, 0.003), (0.1, -0.2, 0.3))
    centre, tensor = np.array(inertia.centre), inertia.tensor
    about_origin = tensor + 3.0 * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    entries = [about_origin["xyz".index(i), "xyz".index(j)] for i, j in (name[-2:] for name in ENTRIES[4:])]
    values = np.array([3.0, *(3.0 * centre), *entries])
    np.testing.assert_allclose(pseudo_inertia(values), inertia.pseudo, rtol=1e-14)
    np.testing.assert_allclose(inertial_parameters(inertia.pseudo), values, rtol=1e-14)


def test_the_pseudo_inertia_of_points_is_the_sum_of_their_products():
    rng = np.random.default_rng(1)
    points, masses = rng.normal(size=(6, 3)), rng.uniform(0.1, 1.0, 6)
    rows = np.column_stack([np.ones(6), points])
    pseudo = (masses[:, None] * rows).T @ rows
    second = pseudo[1:, 1:]
    tensor = np.trace(second) * np.eye(3) - second
    values = inertial_parameters(pseudo)
    assert values[:4].tolist() == [pseudo[0, 0], *pseudo[0, 1:]]
    np.testing.assert_allclose(values[4:], [*np.diagonal(tensor), tensor[0, 1], tensor[0, 2], tensor[1, 2]], rtol=1e-14)


def test_log_cholesky_parameters_of_a_cube_are_those_of_the_paper():
    """A body with mass m, centre c and equal second moments s m about the centre: e^2a = m, d = log(s) / 2, t = c."""
    centre, mass, spread = np.array([0.3, -0.2, 0.5]), 2.0, 0.04
    second = mass * (spread * np.eye(3) + np.outer(centre, centre))
    pseudo = np.block([[np.array([[mass]]), mass * centre[None]], [mass * centre[:, None], second]])
    found = log_cholesky(inertial_parameters(pseudo))
    expected = [np.log(mass) / 2, *3 * [np.log(spread) / 2], 0.0, 0.0, 0.0, *centre]
    np.testing.assert_allclose(found, expected, atol=1e-13)


def test_the_jacobian_is_that_of_complex_steps():
    logs = np.random.default_rng(3).normal(size=10)
    steps = np.array([np.imag(from_log_cholesky(logs + 1e-30j * unit)) / 1e-30 for unit in np.eye(10)]).T
    np.testing.assert_allclose(log_cholesky_jacobian(logs), steps, rtol=1e-13, atol=1e-14)


def test_every_set_of_logs_is_a_body_and_back():
    logs = np.random.default_rng(5).normal(size=(50, 10))
    values = from_log_cholesky(logs)
    assert np.linalg.eigvalsh(pseudo_inertia(values)).min() > 0
    np.testing.assert_allclose(log_cholesky(values), logs, atol=1e-9)


def test_the_distance_does_not_depend_on_the_frame():
    one, other = bodies(2, seed=4)
    turn = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    move = np.block([[np.ones((1, 1)), np.zeros((1, 3))], [np.array([[0.3], [-0.1], [2.0]]), turn]])
    moved = [inertial_parameters(move @ pseudo_inertia(body) @ move.T) for body in (one, other)]
    here, there = bregman_distances(one, other), bregman_distances(*moved)
    assert here > 0.1
    assert there == pytest.approx(here, rel=1e-10)
    assert bregman_distances(one, one) == pytest.approx(0.0, abs=1e-12)


def test_a_body_that_cannot_exist_is_infinitely_far():
    bad = np.array([[1.0, 0, 0, 0, 0.1, 0.1, 0.3, 0, 0, 0]])
    good = np.array([[1.0, 0, 0, 0, 0.1, 0.1, 0.1, 0, 0, 0]])
    assert smallest_eigenvalues(bad, good) == pytest.approx(-1.0)
    assert bregman_distances(bad, good) == np.inf


def test_names():
    assert len(parameter_names(["a", "b"])) == 20
    assert parameter_names(["a"])[4:] == tuple(f"a.second_{pair}" for pair in ("xx", "yy", "zz", "xy", "xz", "yz"))
