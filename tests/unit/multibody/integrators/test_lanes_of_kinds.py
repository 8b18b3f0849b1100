"""Samples side by side for every kind of component: the bits of each alone, in shuffled groups of different sizes."""

from collections.abc import Callable

import numpy as np
import pytest

import dalembert.multibody as mb
import mechanisms
from dalembert.multibody.integrators.generalized_alpha import generalized_alpha
from dalembert.multibody.integrators.midpoint import energy_momentum, variational
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.model.lowering import lower
from dalembert.parameter import Parameter
from spatial_scenes import SCENES, fields_of, numbers_of

TIMES = np.array([0.0, 0.013, 0.05])
METHODS = {
    "GeneralizedAlpha": mb.GeneralizedAlpha(2e-3),
    "Variational": mb.Variational(2e-3),
    "EnergyMomentum": mb.EnergyMomentum(2e-3),
}
HELD = (
    "revolute", "fixed", "prismatic", "distance", "prescribed x", "prescribed y", "prescribed angle", "gear",
    "pin friction", "pin friction, Stribeck", "slide friction", "slide friction, Stribeck",
)  # fmt: skip
"""Pieces whose joints cannot all be closed."""
ALONE = ("plane: torsion spring",)
"""Iterations that end where forces balance: that is decided where a sample runs alone."""
COMMON = ("plane: joints", "space: SphericalJoint", "space: angle limit")
"""Mechanisms of `make test`; the others need kernels that no other test needs."""


def joints(across: float, down: float) -> mb.System:
    """A crank that a motion turns drives a slider with friction; a pendulum on a rod; two wheels with teeth."""
    system = mb.System(gravity=(across, -down))
    crank = system.add(mb.RigidBar("crank", 0.2, 1.0, angle=0.3))
    rod = system.add(mb.RigidBar("rod", 0.6, 1.0, angle=-0.1, start=crank.end))
    slider = system.add(mb.RigidBody("slider", 1.5, 0.01, position=rod.end))
    weight = system.add(mb.PointMass("weight", 0.7, (0.7, -0.4)))
    wheel = system.add(mb.RigidBody("wheel", 1.0, 0.1, position=(2.0, 0.0)))
    other = system.add(mb.RigidBody("other", 1.0, 0.1, position=(3.0, 0.0)))
    friction = {"viscous": 0.1, "coulomb": 0.3, "friction_coefficient": 0.2, "stribeck": 0.1}
    system.add(mb.RevoluteJoint("O", system.ground, crank.start))
    system.add(
        mb.RevoluteJoint("A", crank.end, rod.start, pin_radius=0.1, slip_rate=0.8, stribeck_rate=0.9, **friction)
    )
    system.add(mb.RevoluteJoint("B", rod.end, slider.centre))
    system.add(
        mb.PrismaticJoint("guide", system.ground, slider.centre, slip_velocity=0.7, stribeck_velocity=0.9, **friction)
    )
    system.add(mb.PrescribedMotion("drive", system.ground, crank.start, motion=mechanisms.RAMP))
    system.add(mb.DistanceJoint("string", slider.centre, weight.centre))
    system.add(mb.RevoluteJoint("C", system.ground.point(2.0, 0.0), wheel.centre))
    system.add(mb.RevoluteJoint("D", system.ground.point(3.0, 0.0), other.centre))
    system.add(mb.GearJoint("teeth", wheel.centre, other.centre, -0.4))
    system.add(mb.Torque("push", wheel.centre, 2.0))
    return system


def falling(piece: str) -> Callable[[float, float], mb.System]:
    """Bodies with loads between them, which fall."""

    def build(across: float, down: float) -> mb.System:
        system = mechanisms.mechanism(piece)
        system.gravity = (across, -down)
        return system

    return build


def planar(build: Callable[[float, float], mb.System], method: Integrator) -> mb.TimeResponse:
    """A mechanism in the plane at different gravities."""
    bodies = build(0.7, 9.8).bodies
    channels = [f"{body.name}.{body.point_names[-1]}.{entry}" for body in bodies for entry in ("x", "ay")]
    return mb.TimeResponse(build, {"across": (-2.0, 2.0), "down": (5.0, 20.0)}, channels, TIMES, method, 1)


def spatial(scene: str, method: Integrator) -> mb.TimeResponse:
    """A mechanism in space as a function of all of its numbers, with an angle whose turns are counted."""
    build, fields = SCENES[scene]
    parameters = {
        name: Parameter(name, value - abs(value) / 20, value + abs(value) / 20)
        for name, value in numbers_of(fields).items()
    }
    bodies = build(**fields).bodies
    channels = [
        f"{body.name}.{body.point_names[-1]}.{entry}"
        for body in bodies
        for entry in ("x", "ay", *(("wz", "rotation_z") if body.has_axes else ()))
    ]
    return mb.TimeResponse(
        lambda **numbers: build(**fields_of(fields, numbers)), parameters, channels, TIMES, method, 1
    )


MODELS: dict[str, Callable[[Integrator], mb.TimeResponse]] = {
    "plane: joints": lambda method: planar(joints, method),
    **{
        f"plane: {piece}": lambda method, piece=piece: planar(falling(piece), method)
        for piece in mechanisms.PIECES
        if piece not in HELD
    },
    **{f"space: {scene}": lambda method, scene=scene: spatial(scene, method) for scene in SCENES},
}
#: Masses of reduced bodies change with the coordinates, which these methods refuse.
REFUSED = {("space: reduced body", "Variational"), ("space: reduced body", "EnergyMomentum")}
CASES = [
    pytest.param(name, method, marks=() if name in COMMON and method == "GeneralizedAlpha" else pytest.mark.slow)
    for name in MODELS
    for method in METHODS
    if (name, method) not in REFUSED
]


@pytest.mark.parametrize(("name", "method"), CASES)
def test_a_sample_has_the_same_bits_in_any_group(name: str, method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    model = MODELS[name](METHODS[method])
    chance = np.random.default_rng(2)
    low, high = model.parameters.lower, model.parameters.upper
    batch = low + (high - low) * chance.uniform(size=(13, len(low)))
    alone = np.stack([model.evaluate(row).only()[0] for row in batch])
    lanes = []
    module = {"GeneralizedAlpha": generalized_alpha, "Variational": variational, "EnergyMomentum": energy_momentum}
    run = module[method].run_in_lanes

    def watched(part, *given):
        out, left = run(part, *given)
        lanes.append(1.0 - left.mean())
        return out, left

    monkeypatch.setattr(module[method], "run_in_lanes", watched)
    for count in (5, 13):
        order = chance.permutation(len(batch))[:count]
        np.testing.assert_array_equal(model.evaluate(batch[order]).only(), alone[order])
    lowered = lower(model.builder(**dict(zip(model.parameters.names, batch[0], strict=True))))
    declined = {kind.name for kind in lowered.data if not kind.takes_lanes}
    assert declined <= {"user_force", "bushing_in_space"}
    assert declined or name in ALONE or np.mean(lanes) > 0.5
