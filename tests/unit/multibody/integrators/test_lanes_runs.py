"""Samples side by side: the bits of each alone, in any group; a lane that leaves the common path runs alone."""

from collections.abc import Callable
from importlib import import_module

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.multibody.integrators.generalized_alpha import generalized_alpha
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.model.lane_models import FEWEST, takes_lanes
from dalembert.multibody.model.lowering import lower

TIMES = np.linspace(0.0, 0.2, 9)


def beams(angle: float, stiffness: float) -> mb.System:
    """A double pendulum of beams: a band."""
    system = mb.System(gravity=(0.0, -9.81))
    section = {"poisson_ratio": 0.3, "density": 5540.0, "height": 0.04, "width": 0.02}
    first = system.add(mb.AncfBeam("first", 1.0, 2, stiffness, angle=angle, **section))
    second = system.add(mb.AncfBeam("second", 1.0, 3, stiffness, angle=-angle, start=first.end, **section))
    system.add(mb.RevoluteJoint("O", system.ground, first.start))
    system.add(mb.RevoluteJoint("A", first.end, second.start))
    return system


def loop(angle: float, stiffness: float) -> mb.System:
    """A four-bar mechanism with a spring and a torque that jumps: a dense matrix, multipliers, sines."""
    system = mb.System(gravity=(0.0, -9.81))
    crank = system.add(mb.RigidBar("crank", 0.5, 1.0, angle=angle))
    coupler = system.add(mb.RigidBar("coupler", 2.0, 2.0, angle=0.4, start=crank.end))
    rocker = system.add(mb.RigidBar("rocker", 1.2, 1.5, angle=1.3, start=(1.8, 0.0)))
    system.add(mb.RevoluteJoint("O", system.ground, crank.start))
    system.add(mb.RevoluteJoint("A", crank.end, coupler.start))
    system.add(mb.RevoluteJoint("B", coupler.end, rocker.end))
    system.add(mb.RevoluteJoint("C", rocker.start, system.ground.point(1.8, 0.0)))
    system.add(
        mb.Spring("spring", crank.end, system.ground.point(1.0, 1.5), stiffness=1e-6 * stiffness, free_length=1.0)
    )
    system.add(mb.Torque("motor", crank.start, mb.Step(5.0, 0.05)))
    return system


MODELS = {
    "beams": (beams, ("second.end.x", "second.end.y", "A.force_x"), {"angle": (-0.4, 0.9), "stiffness": (1e7, 1e8)}),
    "loop": (loop, ("rocker.end.x", "coupler.end.vy", "B.force_y"), {"angle": (0.3, 1.1), "stiffness": (1e7, 1e9)}),
}


METHODS = (mb.GeneralizedAlpha, mb.Variational, mb.EnergyMomentum)


def response(
    builder: Callable, channels: tuple[str, ...], ranges: dict, method: type[Integrator] = mb.GeneralizedAlpha
) -> mb.TimeResponse:
    return mb.TimeResponse(builder, ranges, channels, TIMES, method(1e-3), 1)


def vectors(ranges: dict, count: int) -> np.ndarray:
    chance = np.random.default_rng(4)
    return np.stack([chance.uniform(*limits, count) for limits in ranges.values()], axis=1)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", MODELS)
def test_a_sample_has_the_same_bits_in_any_group(name: str, method: type[Integrator]) -> None:
    builder, channels, ranges = MODELS[name]
    model, batch = response(builder, channels, ranges, method), vectors(ranges, 19)
    assert takes_lanes(lower(builder(*batch[0])))
    alone = np.stack([model.evaluate(row).only()[0] for row in batch])
    for seed, count in enumerate((FEWEST, 7, 8, 13, 19)):
        order = np.random.default_rng(seed).permutation(len(batch))[:count]
        np.testing.assert_array_equal(model.evaluate(batch[order]).only(), alone[order])


def test_lanes_are_used(monkeypatch: pytest.MonkeyPatch) -> None:
    groups = []
    run = generalized_alpha.run_in_lanes

    def watched(part, *given):
        out, alone = run(part, *given)
        groups.append((len(part.samples), int(alone.sum())))
        return out, alone

    monkeypatch.setattr(generalized_alpha, "run_in_lanes", watched)
    builder, channels, ranges = MODELS["beams"]
    response(builder, channels, ranges).evaluate(vectors(ranges, 21))
    assert groups == [(8, 0), (8, 0), (5, 0)]


@pytest.mark.parametrize("method", METHODS)
def test_a_lane_that_fails_runs_alone_with_its_reason(
    method: type[Integrator], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The spring of some samples pushes so hard that the step has to be halved, or that no step is short enough."""
    builder, channels, _ = MODELS["loop"]
    batch = vectors({"angle": (0.4, 0.6), "stiffness": (1e7, 1e9)}, 8)
    batch[[1, 6], 1] = -1e15, 3e13
    module, groups = import_module(method.__module__), []
    run = module.run_in_lanes

    def watched(part, *given):
        groups.append(run(part, *given))
        return groups[-1]

    monkeypatch.setattr(module, "run_in_lanes", watched)
    model = response(builder, channels, {"angle": (0.3, 1.1), "stiffness": (-1e16, 1e16)}, method)
    together, alone = model.evaluate(batch), [model.evaluate(row) for row in batch]
    assert [list(np.flatnonzero(left)) for _, left in groups] == [[1, 6]]
    assert together.failures == tuple(entry.failures[0] for entry in alone)
    for values, entry in zip(together.values, alone, strict=True):
        np.testing.assert_array_equal(values, entry.values[0])
    if method is mb.GeneralizedAlpha:
        assert sum(reason is not None for reason in together.failures) in (1, 2)
