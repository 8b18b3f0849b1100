"""A block that a spring drags over a floor with Stribeck's friction, against SciPy's Radau on the same smoothed law.

The block sticks until the spring pulls with the largest friction, slips, and sticks again. The right moment of slip depends on
the creep of the smoothed law, so the reference integrates the law itself in plain NumPy.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import dalembert as da

TOPIC = "Stick and slip"
MASS, STIFFNESS, SPEED = 10.0, 4000.0, 0.01
STATIC, KINETIC = 0.3 * MASS * 9.81, 0.2 * MASS * 9.81
STRIBECK = 1e-4
END = 1.3
TIMES = np.linspace(0.0, END, 1301)
SOURCE = "SciPy's Radau on the same smoothed law"


def dragged(slip: float) -> da.System:
    """The block, and a hand that draws the free end of the spring at a constant speed."""
    system = da.System(gravity=(0.0, -9.81))
    ground = system.ground.point(0.0, 0.0)
    block = system.add(da.RigidBody("block", mass=MASS, inertia=1.0))
    hand = system.add(da.RigidBody("hand", mass=1.0, inertia=1.0, position=(1.0, 0.0), velocity=(SPEED, 0.0)))
    friction = {"coulomb": KINETIC, "stribeck": STATIC - KINETIC, "stribeck_velocity": STRIBECK, "slip_velocity": slip}
    system.add(da.PrismaticJoint("floor", ground, block.centre, **friction))
    system.add(da.PrismaticJoint("rail", ground, hand.centre))
    course = da.signals.Polynomial([1.0, SPEED])
    system.add(da.PrescribedMotion("pull", ground, hand.centre, coordinate="x", motion=course))
    system.add(da.Spring("spring", block.centre, hand.centre, stiffness=STIFFNESS, free_length=1.0))
    return system


def reference(slip: float) -> np.ndarray:
    """Position of the block, m."""

    def rates(t: float, state: np.ndarray) -> list[float]:
        x, v = state
        friction = (KINETIC + (STATIC - KINETIC) * np.exp(-((v / STRIBECK) ** 2))) * np.tanh(v / slip)
        return [v, (STIFFNESS * (SPEED * t - x) - friction) / MASS]

    return solve_ivp(rates, (0.0, END), [0.0, 0.0], "Radau", TIMES, rtol=1e-9, atol=1e-14, max_step=2e-3).y[0]


@pytest.mark.parametrize("slip", [1e-5, 1e-6, 1e-7])
def test_the_block_slips_at_the_right_time_in_few_steps(slip: float, record_evidence) -> None:
    motion = da.simulate(dragged(slip), END, "auto", times=TIMES)
    assert motion.findings == ()
    assert motion.run.counts[0] < 300
    record_evidence(
        f"block dragged over a floor, slip rate {slip:g} m/s: position",
        reference(slip),
        motion.channels(["block.centre.x"])[:, 0],
        tolerance=1e-5,
        topic=TOPIC,
        kind="other code",
        source=SOURCE,
        unit="m",
    )


@pytest.mark.parametrize("slip", [1e-6, 1e-7])
@pytest.mark.parametrize(
    "solver",
    [da.GeneralizedAlpha(step=1e-3, adaptive=True), da.GeneralizedAlpha(step=1e-3)],
    ids=["adaptive", "fixed"],
)
def test_a_stick_phase_that_oscillates_is_named(slip: float, solver: da.GeneralizedAlpha) -> None:
    (found,) = (item for item in da.simulate(dragged(slip), END, solver).findings if item.code == "stick-chatter")
    assert (found.severity, found.values["joint"], found.values["slip_velocity"]) == ("warning", "floor", slip)
    assert found.values["reversals"] >= 20


@pytest.mark.parametrize(
    "solver", [da.GeneralizedAlpha(step=1e-3, adaptive=True), da.GeneralizedAlpha(step=1e-3)], ids=str
)
def test_a_stick_phase_that_is_resolved_is_not_named(solver: da.GeneralizedAlpha) -> None:
    assert "stick-chatter" not in [item.code for item in da.simulate(dragged(1e-5), END, solver).findings]
