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


def _predicted(factor: float) -> inertial.TorquePrediction:
    """The first 40 samples are fitted; torques of the others are multiplied by a factor."""
    table, torques = _table(), _torques()
    found = inertial.identify_inertias(
        table[:40], torques[:40], PLANAR.names, wrong(TRUE, 2, 0.3, 1), links=PLANAR.links, deviations=0.1
    )
    times, told = np.arange(60.0), found.torques(table)
    return inertial.TorquePrediction(
        found, times[:40], torques[:40], told[:40], times[40:], factor * torques[40:], told[40:]
    )


INERTIAL_CASES = {
    "predicted torques": Case(
        lambda: _predicted(1.0),
        ("are predicted as exactly as the noise allows", "Torques of the unseen motion", "noise alone exceeds"),
        ("fitted-torques-1", "unseen-torques-2"),
    ),
    "torques that are not predicted": Case(
        lambda: _predicted(1.5), ("The torques of the unseen motion are not predicted",)
    ),
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
