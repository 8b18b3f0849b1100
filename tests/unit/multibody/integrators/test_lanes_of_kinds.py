"""Samples side by side for every kind of component: the bits of each alone, in shuffled groups of different sizes."""

from collections.abc import Callable

import numpy as np
import pytest

import dalembert.multibody as mb
import mechanisms
from dalembert.multibody.integrators.generalized_alpha import generalized_alpha
from dalembert.multibody.model.lane_models import takes_lanes
from dalembert.multibody.model.lowering import lower
from dalembert.parameter import Parameter
from spatial_scenes import SCENES, fields_of, numbers_of

TIMES = np.array([0.0, 0.013, 0.05])
STEPS = mb.GeneralizedAlpha(2e-3)
COMMON = ("plane: pin friction", "space: SphericalJoint", "space: angle limit")
"""Mechanisms of `make test`; the others need kernels that no other test needs."""


def planar(piece: str) -> mb.TimeResponse:
    """A mechanism in the plane that falls at different gravities."""

    def build(across: float, down: float) -> mb.System:
        system = mechanisms.mechanism(piece)
        system.gravity = (across, -down)
        return system

    channels = [
        f"{body.name}.{body.point_names[-1]}.{entry}" for body in build(0.7, 9.8).bodies for entry in ("x", "ay")
    ]
    return mb.TimeResponse(build, {"across": (-2.0, 2.0), "down": (5.0, 20.0)}, channels, TIMES, STEPS, 1)


def spatial(scene: str) -> mb.TimeResponse:
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
        for entry in ("x", "ay", *(("wz", "rotation_z") if body.turns else ()))
    ]
    return mb.TimeResponse(lambda **numbers: build(**fields_of(fields, numbers)), parameters, channels, TIMES, STEPS, 1)


MODELS: dict[str, Callable[[], mb.TimeResponse]] = {
    **{f"plane: {piece}": lambda piece=piece: planar(piece) for piece in mechanisms.PIECES},
    **{f"space: {scene}": lambda scene=scene: spatial(scene) for scene in SCENES},
}
CASES = [pytest.param(name, marks=() if name in COMMON else pytest.mark.slow) for name in MODELS]


@pytest.mark.parametrize("name", CASES)
def test_a_sample_has_the_same_bits_in_any_group(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    model = MODELS[name]()
    chance = np.random.default_rng(2)
    low, high = model.parameters.lower, model.parameters.upper
    batch = low + (high - low) * chance.uniform(size=(13, len(low)))
    alone = np.stack([model.evaluate(row).only()[0] for row in batch])
    lanes = []
    run = generalized_alpha.run_in_lanes

    def watched(part, *given):
        out, left = run(part, *given)
        lanes.append(1.0 - left.mean())
        return out, left

    monkeypatch.setattr(generalized_alpha, "run_in_lanes", watched)
    for count in (5, 13):
        order = chance.permutation(len(batch))[:count]
        np.testing.assert_array_equal(model.evaluate(batch[order]).only(), alone[order])
    if takes_lanes(lower(model.builder(**dict(zip(model.parameters.names, batch[0], strict=True))))):
        assert np.mean(lanes) > 0.5
    else:
        assert name.startswith(("plane: user force", "space: bushing"))
