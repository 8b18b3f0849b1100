"""Small identifications of inertial parameters that provoke the sentences of their reports."""

import numpy as np

from dalembert.inverse import inertial
from report_case import Case
from serial_arm import PLANAR, swinging, truth, wrong

TRUE = truth(PLANAR)


def _table(seed: int = 1) -> np.ndarray:
    return PLANAR.regressor(*swinging(2, seed, 60)[1:])


def _torques() -> np.ndarray:
    return _table() @ TRUE + 0.1 * np.random.default_rng(0).standard_normal((60, 2))


INERTIAL_CASES = {
    "consistent inertias": Case(
        lambda: inertial.identify_inertias(
            _table(), _torques(), PLANAR.names, wrong(TRUE, 2, 0.3, 1), links=PLANAR.links
        ),
        ("All links are physically consistent", "Base parameters: the combinations that torques determine"),
    ),
    "base estimate": Case(
        lambda: inertial.identify_base(_table(), _torques(), PLANAR.names),
        ("link1.first_x + 0.4 link2.mass", "Standard deviation of the noise of each joint"),
    ),
    "base parameters": Case(
        lambda: inertial.base_parameters(_table(), PLANAR.names), ("Combinations that torques depend on", "6 of 20")
    ),
    "an exciting trajectory": Case(
        lambda: inertial.exciting_trajectory(
            PLANAR.regressor,
            PLANAR.names,
            inertial.JointLimits([-1.0, -1.0], [1.0, 1.0], [3.0, 3.0], [20.0, 20.0]),
            period=5.0,
            random=2,
            evaluations=3,
        ),
        ("All limits hold at all times.", "One period; it can be repeated without a jump."),
        ("exciting-motion",),
    ),
    "a simulated recovery": Case(
        lambda: inertial.simulated_recovery(
            _table(), _table(2), PLANAR.names, TRUE, wrong(TRUE, 2, 0.3, 1), links=PLANAR.links, runs=2
        ),
        ("Share of intervals that contain the true value", "times the noise"),
    ),
}
