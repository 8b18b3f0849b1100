"""Inertial parameters of arms: closed forms, an independent minimisation, and known parameters recovered."""

import numpy as np
import pytest
from scipy.optimize import minimize

from dalembert.inverse.inertial import (
    base_parameters,
    bregman_distances,
    from_log_cholesky,
    identify_inertias,
    log_cholesky,
    simulated_recovery,
)
from serial_arm import PLANAR, SIX, THREE, SerialArm, swinging, truth, wrong

TOPIC = "Inertial parameters"


def test_base_parameters_of_two_links(record_evidence):
    """First moment and inertia of the first link contain l m2 and l² m2."""
    found = base_parameters(PLANAR.regressor(*swinging(2, 1, 120)[1:]), PLANAR.names)
    expected = np.zeros((6, 20))
    for row, name in enumerate(("first_x", "first_y", "second_zz")):
        expected[row, PLANAR.names.index(f"link1.{name}")] = 1.0
        expected[3 + row, PLANAR.names.index(f"link2.{name}")] = 1.0
    expected[0, PLANAR.names.index("link2.mass")], expected[2, PLANAR.names.index("link2.mass")] = 0.4, 0.16
    record_evidence(
        "combinations of parameters of two links in a vertical plane",
        expected,
        found.combinations,
        tolerance=1e-9,
        topic=TOPIC,
        kind="closed form",
        source="m1 c1 + l m2, I1 + l² m2",
        noisy=True,
    )


@pytest.mark.parametrize(
    ("gravity", "count", "words"),
    [((0.0, 0.0, -9.81), 36, "vertical"), ((-3.0, 2.0, -9.0), 38, "oblique")],
    ids=["vertical", "oblique"],
)
def test_number_of_base_parameters_of_six_links(gravity, count, words, record_evidence):
    """Seven a link; of the first link one where its axis is vertical, else three."""
    arm = SerialArm(SIX.frames, gravity)
    found = base_parameters(arm.regressor(*swinging(6, 1, 120)[1:]), arm.names)
    record_evidence(
        f"number of base parameters of six links, first axis {words}",
        count,
        found.rank,
        tolerance=0,
        topic=TOPIC,
        kind="closed form",
        source="three of ten parameters of a link regroup over its revolute joint; of the first, 1 or 3 have an effect",
    )


def test_torques_of_a_pendulum_move_it(record_evidence):
    """The independent Newton-Euler of the tests against Lagrange's equations of two links in a plane."""
    ten = truth(PLANAR).reshape(2, 10)
    (_, q, v, a), (m2, h1, h2) = swinging(2, 5, 50), (ten[1, 0], ten[0, 1:3], ten[1, 1:3])

    def potential(angles):
        one, two = angles
        height = lambda h, angle: h[0] * np.sin(angle) + h[1] * np.cos(angle)  # noqa: E731
        return 9.81 * (height(h1, one) + m2 * 0.4 * np.sin(one) + height(h2, one + two))

    def mass(two):
        coupling = 0.4 * (h2[0] * np.cos(two) - h2[1] * np.sin(two))
        both = ten[1, 6] + coupling
        return np.array([[ten[0, 6] + m2 * 0.16 + ten[1, 6] + 2 * coupling, both], [both, ten[1, 6]]])

    expected = []
    for angles, rates, second in zip(q, v, a, strict=True):
        step = 1e-30j
        by_two = np.imag(mass(angles[1] + step)) / 1e-30
        weight = [np.imag(potential(angles + step * unit)) / 1e-30 for unit in np.eye(2)]
        gyration = by_two * rates[1] @ rates - np.array([0.0, 0.5 * rates @ by_two @ rates])
        expected.append(mass(angles[1]) @ second + gyration + weight)
    record_evidence(
        "torques of two links in a vertical plane",
        np.array(expected),
        PLANAR.torques(ten, q, v, a),
        unit="N m",
        tolerance=1e-12,
        relative=True,
        noisy=True,
        topic=TOPIC,
        kind="closed form",
        source="Lagrange's equations; the regressor of the tests is made of these torques",
    )


@pytest.mark.slow
def test_consistent_estimate_is_the_minimum(record_evidence):
    """Against BFGS over the parameters of Rucker and Wensing, from the definition of the objective."""
    table = PLANAR.regressor(*swinging(2, 1, 60)[1:])
    true = truth(PLANAR)
    torques = table @ true
    noise = 0.02 * np.sqrt(np.mean(torques**2, axis=0))
    torques = torques + noise * np.random.default_rng(0).standard_normal(torques.shape)
    prior = wrong(true, 2, 0.3, 1)
    found = identify_inertias(
        table, torques, PLANAR.names, prior, links=PLANAR.links, deviations=noise, regularisation=100.0
    )

    def objective(logs):
        inertial = from_log_cholesky(logs.reshape(2, 10))
        misfit = np.sum(((table @ inertial.ravel() - torques) / noise) ** 2)
        return misfit + 100.0 * bregman_distances(inertial, prior.reshape(2, 10)).sum()

    other = minimize(objective, log_cholesky(prior.reshape(2, 10)).ravel(), method="BFGS", options={"maxiter": 2000})
    record_evidence(
        "misfit and distance at the physically consistent estimate",
        other.fun,
        objective(found.log_cholesky.ravel()),
        tolerance=1e-7,
        relative=True,
        noisy=True,
        topic=TOPIC,
        kind="other method",
        source="BFGS over log-Cholesky parameters, differences of the definition",
    )
    record_evidence(
        "largest derivative of half the objective by a log-Cholesky parameter",
        0.0,
        np.abs(found.gradient).max(),
        tolerance=1e-6,
        noisy=True,
        topic=TOPIC,
        kind="closed form",
        source="the gradient is zero at a minimum",
    )


@pytest.mark.slow
def test_known_parameters_are_recovered(record_evidence):
    """100 seeds with 2 % noise of the torques; priors that are wrong by up to 30 % of their factors."""
    fitted, unseen = (THREE.regressor(*swinging(3, seed, 300)[1:]) for seed in (1, 2))
    true = truth(THREE)
    found = simulated_recovery(
        fitted, unseen, THREE.names, true, wrong(true, 3, 0.3, 5), links=THREE.links, positive=THREE.others
    )
    source = "100 simulated records of three links with friction, noise 2 % of the rms torque"
    rows = [
        ("share of 95 % intervals of base parameters that contain the true value", 0.95, found.covered.mean(), 0.02),
        ("smallest share of a single base parameter", 0.945, found.coverage.min(), 0.045),
        ("largest share of a single base parameter", 0.945, found.coverage.max(), 0.045),
        ("rms error of predicted torques of an unseen motion, all records, relative to the noise", 1.0, np.sqrt(np.mean(found.prediction**2)), 0.1),
        ("the same, worst record, relative to the rms noise in this record", 1.0, (found.prediction / found.unseen_noise).max(), 0.1),
        ("the same, worst record, relative to the standard deviation of the noise", 1.0, found.prediction.max(), None),
        ("share of links that are physically consistent", 1.0, found.consistent.mean(), 0.0),
    ]  # fmt: skip
    for quantity, reference, ours, tolerance in rows:
        record_evidence(quantity, reference, ours, tolerance=tolerance, topic=TOPIC, kind="known truth", source=source)
    assert found.gradients.max() < 1e-6
