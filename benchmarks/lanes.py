"""Batches of samples side by side, beside the same samples one by one: samples a second on one core."""

from dataclasses import replace
from unittest.mock import patch

import numba
import numpy as np

import dalembert as da
from benchmarks import cases, ours, timing
from benchmarks.peers import exudyn_models as peers
from benchmarks.sensitivities import BEAM, CABLE
from dalembert.multibody import EnergyMomentum, Integrator, Polynomial, Variational
from dalembert.multibody.spatial import Inertia, Orientation, Pose, RigidBody, SpatialSystem, SphericalJoint
from dalembert.multibody.trees import dynamics
from dalembert.multibody.trees.dynamics import inverse_dynamics, mass_matrix, regressor
from dalembert.multibody.trees.tree import Link, Tree, TreeJoint

SAMPLES, MOTIONS = 32, 10_000
CHAIN = cases.chain(100)
ARM, TIP = {"first": 0.8, "second": 0.5, "mass": 2.0}, ("AB.end.x", "AB.end.y")


def main() -> list[dict[str, object]]:
    numba.set_num_threads(1)
    rows = [
        _row("flexible pendulum, 2 + 4 beams", ours.beam_pendulum, BEAM, ours.JOINT_AND_TIP),
        _row(
            "flexible pendulum, 2 + 4 cables",
            ours.cable_pendulum,
            CABLE,
            ours.JOINT_AND_TIP,
            peer=peers.flexible_pendulum(cases.PENDULUM),
        ),
        _row("two-link arm of rigid bars", arm, ARM, TIP),
        _row("the same by Variational", arm, ARM, TIP, solver=Variational(1e-3)),
        _row("the same by EnergyMomentum", arm, ARM, TIP, solver=EnergyMomentum(1e-3)),
        _row(
            "slider-crank", slider_crank, {"mass": 2.0, "speed": 6.0, "length": 0.6}, ("slider.centre.x", "pin.force_y")
        ),
        _row("top on a ball joint", top, {"mass": 2.0, "spin": 60.0, "length": 0.4}, ("top.centre.x", "top.centre.y")),
        _row(
            "chain of 100 cables, 200 steps", rope, {"stiffness": 2e7, "angle": 1.0}, ("C.end.x", "C.end.y"), CHAIN[1]
        ),
        *_dynamics(),
    ]
    timing.report("lanes", f"Batch of {SAMPLES}: eight samples side by side, and one by one (one core)", rows)
    return rows


def arm(first: float, second: float, mass: float) -> da.System:
    """Two rigid bars on pins."""
    system = da.System(gravity=(0.0, -9.81))
    upper = system.add(da.RigidBar("OA", 1.0, mass, angle=-first))
    lower = system.add(da.RigidBar("AB", 1.0, mass, angle=-second, start=upper.end))
    system.add(da.RevoluteJoint("O", system.ground, upper.start))
    system.add(da.RevoluteJoint("A", upper.end, lower.start))
    return system


def slider_crank(mass: float, speed: float, length: float) -> da.System:
    """A crank that turns at a speed drives a slider."""
    system = da.System(gravity=(0.0, -9.81))
    crank = system.add(da.RigidBar("crank", 0.2, 1.0, angle=0.3))
    rod = system.add(da.RigidBar("rod", length, mass, angle=-0.1, start=crank.end))
    slider = system.add(da.RigidBody("slider", 1.5, 0.01, position=rod.end))
    system.add(da.RevoluteJoint("crank pin", system.ground, crank.start))
    system.add(da.RevoluteJoint("pin", crank.end, rod.start))
    system.add(da.RevoluteJoint("wrist", rod.end, slider.centre))
    system.add(da.PrismaticJoint("guide", system.ground, slider.centre))
    system.add(da.PrescribedMotion("drive", system.ground, crank.start, motion=Polynomial([0.3, speed])))
    return system


def top(mass: float, spin: float, length: float) -> SpatialSystem:
    """A fast top that falls aside."""
    system = SpatialSystem()
    body = RigidBody(
        "top",
        Inertia(mass, (0.02, 0.02, 0.03), centre=(0.0, 0.0, length)),
        orientation=Orientation.by_angles("x", [0.5]),
        angular_velocity=(0.0, -spin * np.sin(0.5), spin * np.cos(0.5)),
    )
    system.add(SphericalJoint("tip", system.ground, system.add(body).point("origin")))
    return system


def rope(stiffness: float, angle: float) -> da.System:
    """A slender cable that hangs on a pin."""
    return ours.chain(replace(CHAIN[0], youngs_modulus=stiffness, angle=-angle))


def _row(
    name: str, builder, values: dict[str, float], channels: tuple[str, ...],
    integration: cases.Integration = cases.PENDULUM.integration, solver: Integrator | None = None,
    peer: peers.Peer | None = None,
) -> dict[str, object]:  # fmt: skip
    chosen = dict(list(values.items())[:4])
    model = da.TimeResponse(
        builder,
        parameters={key: (0.9 * value, 1.1 * value) for key, value in chosen.items()},
        channels=channels,
        times=integration.times,
        solver=solver or ours.solver(integration),
        workers=1,
    )
    chance = np.random.default_rng(0)
    batch = np.array(list(chosen.values())) * chance.uniform(0.95, 1.05, (SAMPLES, len(chosen)))
    together, alone = (
        lambda: model.evaluate(batch).only(),
        lambda: np.stack([model.evaluate(vector).only()[0] for vector in batch]),
    )
    return _compared(name, SAMPLES, together, alone, peer)


def _dynamics() -> list[dict[str, object]]:
    """Torques, regressors and mass matrices of a chain of seven links, beside the same in calls of a few samples."""
    turned = Pose((0.1, 0.0, 0.3), Orientation.by_angles("xz", [1.2, 0.4]))
    rod = Inertia.box(2.0, (0.1, 0.1, 0.3)).moved((0.02, 0.01, 0.15))
    links = (Link(f"link{k + 1}", f"link{k}", TreeJoint(f"joint{k + 1}", pose=turned), rod) for k in range(7))
    tree = Tree("arm", "link0", tuple(links))
    motion = np.random.default_rng(0).normal(size=(3, MOTIONS, 7))
    cases = {"inverse dynamics": (inverse_dynamics, 3), "regressors": (regressor, 3), "mass matrices": (mass_matrix, 1)}
    return [
        _compared(f"{name} of seven joints", MOTIONS, *_both(function, tree, motion[:count]))
        for name, (function, count) in cases.items()
    ]


def _both(function, tree: Tree, motion: np.ndarray):
    def alone() -> np.ndarray:
        with patch.object(dynamics, "FEWEST_IN_LANES", MOTIONS + 1):
            return function(tree, *motion)

    return lambda: function(tree, *motion), alone


def _compared(name: str, samples: int, together, alone, peer: peers.Peer | None = None) -> dict[str, object]:
    runs = {"together": together, "alone": alone} | ({"peer": peer.run} if peer else {})
    times = timing.interleaved(runs, repeats=7)
    return {
        "model": name,
        "samples a second, side by side": samples / times["together"],
        "one by one": samples / times["alone"],
        "times faster": times["alone"] / times["together"],
        "same bits": np.array_equal(together(), alone()),
        "times Exudyn, which takes one sample": samples * times["peer"] / times["together"] if peer else "",
    }


if __name__ == "__main__":
    main()
