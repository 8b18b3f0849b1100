"""Multiple shooting in space: the states between segments are rotation increments and angular velocities."""

import numpy as np
import pytest

import dalembert as da
from dalembert.inverse import MultipleShooting
from dalembert.multibody.spatial import Inertia, RevoluteJoint, RigidBody, SpatialSystem, SphericalJoint
from dalembert.report import figures

TIMES = np.linspace(0.0, 2.0, 41)
TRUE = np.array([0.4, 2.5, 2.0])
BOX = {"length": (0.2, 0.8), "wx": (0.0, 6.0), "wz": (0.0, 4.0)}


def chain(*joints):
    """Bodies below each other on the ground, on ball joints ``s`` or revolute joints ``r``."""

    def build(length, wx, wz):
        system = SpatialSystem(gravity=(0.0, 0.0, -9.81))
        above = system.ground.point((0.0, 0.0, 0.0))
        for number, joint in enumerate(joints):
            own = length if number == 0 else 0.35
            spin = (wx, 1.0, wz) if number == 0 else (0.7 * wz, 1.5, 0.3)
            body = system.add(
                RigidBody(
                    f"body {number}",
                    Inertia.box(1.0, (0.1, 0.06, 0.3)).moved((0.0, 0.0, -own / 2)),
                    position=above if number else (0.0, 0.0, 0.0),
                    points={"low": (0.0, 0.0, -own), "side": (0.1, 0.02, -own)},
                    angular_velocity=spin if joint == "s" else None,
                )
            )
            sides = f"joint {number}", above, body.point("origin")
            system.add(SphericalJoint(*sides) if joint == "s" else RevoluteJoint(*sides, axis=(0.0, 1.0, 0.0)))
            above = body.point("low")
        return system

    channels = [f"body {number}.{p}.{axis}" for number in range(len(joints)) for p in ("low", "side") for axis in "xyz"]
    return da.TimeResponse(build, BOX, channels, TIMES, da.GeneralizedAlpha(step=5e-3))


def noisy(model):
    exact = model.evaluate(TRUE).only()[0]
    values = exact + 1e-3 * np.random.default_rng(5).standard_normal(exact.shape)
    return da.Measurements.of(TIMES, dict(zip(model.channel_names, values.T, strict=True)))


@pytest.mark.slow
@pytest.mark.parametrize("start", [[0.42, 2.3, 2.2], [0.5, 4.0, 1.0]], ids=["near", "far"])
@pytest.mark.parametrize("joints", ["s", "sr", "ss", "sss"])
def test_it_finds_the_parameters(joints, start):
    model = chain(*joints)
    fit = da.identify(model, noisy(model), shooting=MultipleShooting(), starts=1, start=start)
    assert fit.success
    assert np.all(np.abs(fit.values - TRUE) < 4 * fit.deviations)
    assert np.all(fit.deviations < 2e-2)
    assert fit.nodes is not None
    assert fit.nodes.gap < 1e-8
    assert fit.nodes.segments == 1
    assert "body 0.rotation x" in fit.nodes.states
    assert "body 0.angular velocity x" in fit.nodes.states
    assert "gaps" in figures(fit)


def test_states_are_as_many_as_the_mechanism_has_freedoms():
    assert chain("s", "s").state_chart(TRUE).names == (
        *(f"body {number}.rotation {axis}" for number in (0, 1) for axis in "xyz"),
        *(f"body {number}.angular velocity {axis}" for number in (0, 1) for axis in "xyz"),
    )
    hinged = chain("s", "r").state_chart(TRUE)
    assert len(hinged.names) == 8  # four freedoms
    assert hinged.units == ("rad",) * 4 + ("rad/s",) * 4
    assert not np.any(hinged.values[:4])  # increments begin at zero


@pytest.mark.parametrize("joints", ["sr", "ss"])
def test_gaps_between_segments_have_exact_derivatives(joints):
    """End of a segment from a state far from the reference, by its parameters and by its state."""
    model = chain(*joints)
    start = model.state_chart(TRUE)
    numbers = start.values + np.random.default_rng(0).uniform(-0.5, 0.5, len(start.values))
    after = model.restarted(0.1, [0.2], start, model.state_chart(TRUE, whole=True))
    state = after.evaluate(np.concatenate([TRUE, numbers])).only()[0, -1, len(model.channels) :]
    segment = model.restarted(0.1, [0.0, 0.2], start, model.state_chart(TRUE, state, like=start))
    at = np.concatenate([TRUE, numbers])
    values, jacobian = segment.linearise(at)
    again = segment.model.restarted(0.1, [0.0, 0.2], start, start).evaluate(at).only()[0]
    np.testing.assert_allclose(again[0, len(model.channels) :], numbers, atol=1e-12)  # where it begins
    np.testing.assert_allclose(values[-1, len(model.channels) :], segment.ends.values, atol=1e-9)
    step = 1e-4
    for column, unit in enumerate(np.eye(len(at))):
        runs = [segment.evaluate(at + k * step * unit).only()[0, -1] for k in (-2, -1, 1, 2)]
        differences = (runs[0] - 8 * runs[1] + 8 * runs[2] - runs[3]) / (12 * step)
        assert np.abs(jacobian[-1, :, column] - differences).max() < 1e-7 * max(1.0, np.abs(differences).max())
