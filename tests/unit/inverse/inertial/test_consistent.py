"""Physically consistent inertias: exact derivatives, stationary results, and an independent minimisation."""

import numpy as np
import pytest
from scipy.optimize import minimize

from dalembert.errors import InputError
from dalembert.inverse.inertial import (
    ConsistentInertias,
    bregman_distances,
    from_log_cholesky,
    identify_inertias,
    log_cholesky,
    parameter_names,
)
from dalembert.inverse.inertial.consistent_problem import ConsistentProblem
from serial_arm import PLANAR, THREE, bodies, swinging, truth, wrong


@pytest.fixture(scope="module")
def problem():
    """Two links, two positive parameters and a free one."""
    rng = np.random.default_rng(0)
    prior = np.concatenate([bodies(2).ravel(), [0.3, 0.7, -0.2]])
    return ConsistentProblem(
        rng.normal(size=(15, 23)), rng.normal(size=15), prior, 2, np.arange(23) // 20 * (np.arange(23) < 22) > 0, 0.7
    )


@pytest.fixture(scope="module")
def point():
    return 0.4 * np.random.default_rng(1).normal(size=23)


def test_unknowns_zero_are_the_prior(problem):
    zero = np.zeros(23)
    np.testing.assert_allclose(problem.parameters(zero), problem.prior, rtol=1e-12, atol=1e-14)
    assert problem.distance(zero) == pytest.approx(0.0, abs=1e-12)


def test_the_distance_is_that_of_the_definition(problem, point):
    values = problem.parameters(point)
    links = bregman_distances(values[:20].reshape(2, 10), problem.prior[:20].reshape(2, 10))
    ratio = values[20:22] / problem.prior[20:22]
    assert problem.distance(point) == pytest.approx(links.sum() + np.sum(ratio - 1 - np.log(ratio)), rel=1e-10)


def test_gradient_and_hessian_are_exact(problem, point):
    gradient, hessian = problem.derivatives(point)
    steps = [np.imag(problem.value(point + 1e-30j * unit)) / 1e-30 for unit in np.eye(23)]
    np.testing.assert_allclose(gradient, steps, rtol=1e-11, atol=1e-11)
    differences = [
        (problem.derivatives(point + 1e-6 * unit)[0] - problem.derivatives(point - 1e-6 * unit)[0]) / 2e-6
        for unit in np.eye(23)
    ]
    np.testing.assert_allclose(hessian, differences, rtol=1e-6, atol=1e-6)


def test_derivatives_by_the_parameters_are_exact(problem, point):
    values = problem.parameters(point)
    jacobian = np.array([np.imag(problem.parameters(point + 1e-30j * unit)) / 1e-30 for unit in np.eye(23)]).T
    slope = problem.slope(values)
    np.testing.assert_allclose(jacobian.T @ slope, problem.derivatives(point)[0], rtol=1e-9, atol=1e-9)
    size = 1e-6 * np.abs(values).clip(1e-2)
    differences = [
        (problem.slope(values + h * unit) - problem.slope(values - h * unit)) / (2 * h)
        for h, unit in zip(size, np.eye(23), strict=True)
    ]
    np.testing.assert_allclose(problem.curvature(values), differences, rtol=1e-4, atol=1e-3)


def test_a_projected_start_is_the_point_itself_where_it_is_consistent(problem, point):
    np.testing.assert_allclose(problem.start(problem.parameters(point), 1e-6), point, atol=1e-9)
    bad = problem.parameters(point)
    bad[0] = -1.0
    bad[20] = -0.1
    found = problem.parameters(problem.start(bad, 1e-2))
    assert found[20] == pytest.approx(0.01 * problem.prior[20])
    assert np.all(np.isfinite(log_cholesky(found[:20].reshape(2, 10))))


@pytest.fixture(scope="module")
def arm_fit():
    table = THREE.regressor(*swinging(3, 1, 200)[1:])
    true = truth(THREE)
    torques = table @ true
    noise = 0.02 * np.sqrt(np.mean(torques**2, axis=0))
    torques = torques + noise * np.random.default_rng(0).standard_normal(torques.shape)
    prior = wrong(true, 3, 0.3, 5)
    found = identify_inertias(table, torques, THREE.names, prior, links=THREE.links, positive=THREE.others)
    return table, torques, prior, true, found


def test_the_result_is_stationary_and_consistent(arm_fit):
    *_, true, found = arm_fit
    assert found.success
    assert np.abs(found.gradient).max() < 1e-6
    assert np.abs(found.other_gradient).max() < 1e-6
    assert found.decrement < 1e-15
    assert found.consistent.all()
    assert found.plain_eigenvalues.min() < 0 < found.eigenvalues.min()  # least squares alone is not consistent
    assert np.linalg.eigvalsh(found.pseudo_inertias).min() > 0
    error = (found.base_values - found.base.values(true)) / found.base_deviations
    assert np.abs(error).max() < 4
    np.testing.assert_allclose(from_log_cholesky(found.log_cholesky).ravel(), found.values[:30], rtol=1e-9, atol=1e-12)


@pytest.mark.slow
def test_another_minimiser_over_other_parameters_finds_the_same(arm_fit):
    """BFGS over the parameters of Rucker and Wensing and logarithms, from the truth, with the definition of the sum."""
    table, torques, prior, true, found = arm_fit
    others = prior[30:]

    def objective(unknowns):
        inertial = from_log_cholesky(unknowns[:30].reshape(3, 10))
        values = np.concatenate([inertial.ravel(), np.exp(unknowns[30:])])
        ratio = values[30:] / others
        misfit = np.sum(((table @ values - torques) / found.noise) ** 2)
        return misfit + bregman_distances(inertial, prior[:30].reshape(3, 10)).sum() + np.sum(ratio - 1 - np.log(ratio))

    best = np.concatenate([found.log_cholesky.ravel(), np.log(found.values[30:])])
    at = objective(best)
    start = np.concatenate([log_cholesky(true[:30].reshape(3, 10)).ravel(), np.log(true[30:])])
    other = minimize(objective, start, method="BFGS", options={"maxiter": 400})
    assert other.fun > at - 1e-6
    assert other.fun == pytest.approx(at, abs=0.05)
    for seed in range(20):
        step = 1e-3 * np.random.default_rng(seed).normal(size=39)
        assert objective(best + step) > at


@pytest.mark.parametrize("noise", [1e-9, 1e-11, 0.0])
def test_nearly_exact_torques_converge_from_any_prior(noise):
    """Rounding errors of the residuals, relative to such a noise, are larger than the usual Newton decrement."""
    table = PLANAR.regressor(*swinging(2, 1, 300)[1:])
    true = truth(PLANAR)
    torques = table @ true
    size = noise * np.sqrt(np.mean(torques**2, axis=0))
    for seed in range(5):
        given = torques + size * np.random.default_rng(seed).standard_normal(torques.shape)
        found = identify_inertias(table, given, PLANAR.names, wrong(true, 2, 0.3, seed), links=PLANAR.links)
        assert found.success
        assert np.all(np.isfinite(found.base_deviations))
        np.testing.assert_allclose(found.base_values, found.base.values(true), atol=max(noise, 1e-12))


def test_more_regularisation_moves_to_the_prior(arm_fit):
    table, torques, prior, _, found = arm_fit
    distances = [found.distances.sum()]
    for size in (1e3, 1e6, 1e9):
        firm = identify_inertias(
            table, torques, THREE.names, prior, links=THREE.links, positive=THREE.others, regularisation=size
        )
        assert firm.success
        distances.append(firm.distances.sum())
    assert np.all(np.diff(distances) < 0)
    assert distances[-1] < 1e-6


def test_torques_of_wrong_sign_end_at_the_edge():
    table = PLANAR.regressor(*swinging(2, 1, 100)[1:])
    true = truth(PLANAR)
    found = identify_inertias(table, -(table @ true), PLANAR.names, true, links=PLANAR.links, deviations=1e-3)
    assert "inertia-at-edge" in {one.code for one in found.doubts}
    assert found.consistent.all()


def test_a_summary_and_a_stored_result(arm_fit, tmp_path):
    *_, found = arm_fit
    found.save(tmp_path / "arm.nc")
    again = ConsistentInertias.load(tmp_path / "arm.nc")
    text = found.summary()
    assert again.summary() == text
    assert again.estimates == found.estimates
    assert "link1" in text
    assert "joint3.armature" in text
    assert [one.code for one in again.conclusions] == ["converged", "consistent-inertias"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"regularisation": 0.0}, "identify_inertias: regularisation is 0.0; expected a positive number, such as 1.0"),
        ({"prior": np.ones(3)}, "identify_inertias: the prior has the shape (3,); expected (20,) finite numbers"),
        ({"prior": -truth(PLANAR)}, "identify_inertias: no body can have the prior inertia of link 'link1' (mass -19.2845 kg). Check its mass, first moments and inertia about the origin of the link"),
        ({"links": ["a", "b", "c"]}, "identify_inertias: 3 links have 30 parameters, and there are 20; expected ten parameters a link first, then others"),
        ({"positive": ["link2.mas"]}, "identify_inertias: unknown parameter 'link2.mas'; did you mean 'link2.mass' or 'link1.mass'?"),
        ({"positive": ["link2.mass"]}, "identify_inertias: 'link2.mass' belongs to a link. Name only other parameters as positive"),
    ],
)  # fmt: skip
def test_invalid_input(change, message):
    table = PLANAR.regressor(*swinging(2, 1, 30)[1:])
    given = {"prior": truth(PLANAR), "links": PLANAR.links, **change}
    with pytest.raises(InputError) as refused:
        identify_inertias(table, np.zeros((30, 2)), PLANAR.names, **given)
    assert str(refused.value) == message


def test_a_positive_parameter_needs_a_positive_prior():
    names = (*parameter_names(["a"]), "a.friction")
    prior = np.array([*bodies(1)[0], 0.0])
    message = "identify_inertias: the prior of 'a.friction' is 0; expected a positive number. Give an expected size"
    with pytest.raises(InputError) as refused:
        identify_inertias(np.ones((20, 1, 11)), np.ones((20, 1)), names, prior, links=["a"], positive=["a.friction"])
    assert str(refused.value) == message
