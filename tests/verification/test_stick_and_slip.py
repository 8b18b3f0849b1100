"""A block that a spring drags over a floor with Stribeck's friction, against SciPy's Radau on the same smoothed law.

The block sticks until the spring pulls with the largest friction, slips, and sticks again. The right moment of slip depends on
the creep of the smoothed law, so the reference integrates the law itself in plain NumPy.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import dalembert as da

TOPIC = "Stick and slip"
SOURCE = "SciPy's Radau on the same smoothed law"


@dataclass(frozen=True)
class Block:
    """A block on a floor, and a hand that draws the free end of its spring at a constant speed; SI units."""

    slip: float
    mass: float = 10.0
    stiffness: float = 4000.0
    speed: float = 0.01
    static: float = 0.3
    kinetic: float = 0.2
    stribeck: float = 1e-4

    @property
    def limits(self) -> tuple[float, float]:
        """Static and kinetic friction, N."""
        return self.static * self.mass * 9.81, self.kinetic * self.mass * 9.81

    @property
    def times(self) -> np.ndarray:
        """Until 1.7 times the first slip, s."""
        return np.linspace(0.0, 1.7 * self.limits[0] / self.stiffness / self.speed, 1301)


def random_block(seed: int) -> Block:
    random = np.random.default_rng(seed)
    mass, stiffness = 10 ** random.uniform(-1.0, 1.5), 10 ** random.uniform(2.0, 4.5)
    speed, static = 10 ** random.uniform(-2.5, -1.0), random.uniform(0.2, 0.6)
    kinetic, slip = static * random.uniform(0.5, 0.95), 100 * speed * 10 ** random.uniform(-7.0, -4.0)
    return Block(slip, mass, stiffness, speed, static, kinetic, slip * 10 ** random.uniform(1.0, 3.0))


def moved(block: Block, solver) -> da.Trajectory:
    system = da.System(gravity=(0.0, -9.81))
    ground, (static, kinetic) = system.ground.point(0.0, 0.0), block.limits
    body = system.add(da.RigidBody("block", mass=block.mass, inertia=1.0))
    hand = system.add(da.RigidBody("hand", mass=1.0, inertia=1.0, position=(1.0, 0.0), velocity=(block.speed, 0.0)))
    friction = {"coulomb": kinetic, "stribeck": static - kinetic, "stribeck_velocity": block.stribeck}
    system.add(da.PrismaticJoint("floor", ground, body.centre, **friction, slip_velocity=block.slip))
    system.add(da.PrismaticJoint("rail", ground, hand.centre))
    course = da.signals.Polynomial([1.0, block.speed])
    system.add(da.PrescribedMotion("pull", ground, hand.centre, coordinate="x", motion=course))
    system.add(da.Spring("spring", body.centre, hand.centre, stiffness=block.stiffness, free_length=1.0))
    return da.simulate(system, block.times[-1], solver, times=block.times)


@cache
def reference(block: Block) -> np.ndarray:
    """Position of the block, m."""
    static, kinetic = block.limits

    def rates(t: float, state: np.ndarray) -> list[float]:
        x, v = state
        friction = (kinetic + (static - kinetic) * np.exp(-((v / block.stribeck) ** 2))) * np.tanh(v / block.slip)
        return [v, (block.stiffness * (block.speed * t - x) - friction) / block.mass]

    times = block.times
    exact = {"rtol": 1e-9, "atol": 1e-14, "max_step": times[-1] / 600}
    return solve_ivp(rates, (0.0, times[-1]), [0.0, 0.0], "Radau", times, **exact).y[0]


@pytest.mark.parametrize("slip", [1e-5, 1e-6, 1e-7])
def test_the_block_slips_at_the_right_time_in_few_steps(slip: float, record_evidence) -> None:
    motion = moved(Block(slip), "auto")
    assert motion.findings == ()
    assert motion.run.counts[0] < 300
    record_evidence(
        f"block dragged over a floor, slip rate {slip:g} m/s: position",
        reference(Block(slip)),
        motion.channels(["block.centre.x"])[:, 0],
        tolerance=1e-5,
        topic=TOPIC,
        kind="other code",
        source=SOURCE,
        unit="m",
    )


ADAPTIVE = {
    da.GeneralizedAlpha(step=1e-3, adaptive=True): 3e-5,
    da.GeneralizedAlpha(step=1e-3, adaptive=True, tolerance=1e-8): 3e-5,
    da.RadauIIA(tolerance=1e-8): 1e-6,
    da.RadauIIA(tolerance=1e-9): 1e-6,
    da.RadauIIA(tolerance=1e-10, stages=3): 1e-6,
    da.RadauIIA(tolerance=1e-8, stages=7): 1e-6,
}
"""Solvers with adaptive steps, and how far from the reference they may be, m. A step that ends without balance of the
forces sticks too long: the block is then up to 1.8e-3 m off."""
FIXED = {
    da.GeneralizedAlpha(step=1e-3): 1e-4,
    da.RadauIIA(step=1e-3): 1e-5,
    da.EnergyMomentum(step=1e-3): 1e-4,
    da.Variational(step=1e-3): 1e-4,
}


@pytest.mark.parametrize("slip", [1e-6, 1e-7])
@pytest.mark.parametrize(("solver", "tolerance"), [*ADAPTIVE.items(), *FIXED.items()], ids=str)
def test_every_solver_slips_at_the_right_time(slip: float, solver, tolerance: float, record_evidence) -> None:
    motion = moved(Block(slip), solver)
    assert "stick-chatter" not in [finding.code for finding in motion.findings]
    assert motion.run.counts[0] < 3000
    record_evidence(
        f"block dragged over a floor by {solver}, slip rate {slip:g} m/s: position",
        reference(Block(slip)),
        motion.channels(["block.centre.x"])[:, 0],
        tolerance=tolerance,
        topic=TOPIC,
        kind="other code",
        source=SOURCE,
        unit="m",
    )


@pytest.mark.parametrize(
    ("solver", "tolerance"),
    [
        (da.RadauIIA(), 2e-4),
        (da.RadauIIA(tolerance=1e-9), 2e-4),
        (da.GeneralizedAlpha(step=1e-3, adaptive=True, tolerance=1e-8, most_steps=20_000), 1e-2),
    ],
    ids=["Radau", "finer Radau", "generalized-alpha"],
)
@pytest.mark.parametrize("seed", [8, 16, 20, 25, 35])
def test_random_blocks_slip_at_the_right_time(seed: int, solver, tolerance: float, record_evidence) -> None:
    """Blocks that stick too long, by up to 20 % of the motion, where a step may end without balance of its forces."""
    block = random_block(seed)
    exact = reference(block)
    record_evidence(
        f"random block {seed} by {type(solver).__name__}, tolerance {solver.tolerance:g}: position as a part of its range",
        exact / np.ptp(exact),
        moved(block, solver).channels(["block.centre.x"])[:, 0] / np.ptp(exact),
        tolerance=tolerance,
        topic=TOPIC,
        kind="other code",
        source=SOURCE,
    )
