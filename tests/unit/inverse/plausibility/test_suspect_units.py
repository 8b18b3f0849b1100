"""Data in another unit than the response: wrong units are detected, right ones raise no alarm."""

from dataclasses import dataclass

import numpy as np
import pytest

import dalembert as da
from dalembert.data import Measurements
from dalembert.forward import Channel, PythonModel
from dalembert.inverse import Experiment, identify
from dalembert.parameter import Parameter

TIMES = np.linspace(0, 4, 81)
DEGREE = np.pi / 180


@dataclass(frozen=True)
class Motion:
    """A closed form with its channels' units and the ranges that its true parameters are drawn from."""

    function: object
    units: dict[str, str]
    ranges: dict[str, tuple[float, float]]


MOTIONS = (
    Motion(
        lambda size, rate, damping: size * np.exp(-damping * TIMES) * np.cos(rate * TIMES),
        {"x": "m"},
        {"size": (0.01, 10.0), "rate": (1.0, 6.0), "damping": (0.05, 0.5)},
    ),
    Motion(
        lambda radius, rate: np.stack([radius * np.sin(rate * TIMES), radius * (1 - np.cos(rate * TIMES))], 1),
        {"x": "m", "y": "m"},
        {"radius": (0.1, 2.0), "rate": (1.0, 5.0)},
    ),
    Motion(
        lambda size, stiffness: size * np.cos(np.sqrt(stiffness) * TIMES),
        {"angle": "rad"},
        {"size": (0.1, 1.5), "stiffness": (2.0, 20.0)},
    ),
    Motion(
        lambda load, stiffness, damping: load / stiffness * (1 - np.exp(-stiffness / damping * TIMES)),
        {"x": "m"},
        {"load": (1.0, 10.0), "stiffness": (50.0, 500.0), "damping": (50.0, 500.0)},
    ),
    Motion(
        lambda rate, damping: np.stack(
            [rate / damping * (1 - np.exp(-damping * TIMES)), rate * np.exp(-damping * TIMES)], 1
        ),
        {"angle": "rad", "speed": "rad/s"},
        {"rate": (0.5, 10.0), "damping": (0.2, 3.0)},
    ),
    Motion(
        lambda size, offset, rate: size * np.sin(rate * TIMES + 0.3 * TIMES**2) + offset,
        {"x": "m"},
        {"size": (0.05, 0.5), "offset": (0.1, 1.0), "rate": (1.0, 3.0)},
    ),
)


def suspects(fit):
    return {finding.values["channel"]: finding for finding in fit.findings if finding.code == "suspect-unit"}


def drawn(seed, wrong=3.0):
    """A model whose first guesses are wrong by a factor, either way, its values with noise, and their deviations."""
    rng = np.random.default_rng(seed)
    motion = MOTIONS[rng.integers(len(MOTIONS))]
    truth = {name: rng.uniform(*bounds) for name, bounds in motion.ranges.items()}
    starts = {name: value * wrong ** rng.uniform(-1, 1) for name, value in truth.items()}
    box = {
        name: Parameter(name, min(value, starts[name]) / 3, max(value, starts[name]) * 3, start=starts[name])
        for name, value in truth.items()
    }
    model = PythonModel(motion.function, box, [Channel(*pair) for pair in motion.units.items()], TIMES)
    values = motion.function(**truth).reshape(len(TIMES), -1)
    deviations = 10 ** rng.uniform(-4, -1.5) * np.ptp(values, axis=0)
    values = values + deviations * rng.standard_normal(values.shape)
    column = rng.integers(len(motion.units))
    factor = rng.choice([180 / np.pi, DEGREE] if "rad" in model.channels[column].unit else [1e3, 1e-3])
    return model, values, deviations if rng.integers(2) else None, column, factor


def fitted(model, values, deviations, seed):
    columns = {channel.name: column for channel, column in zip(model.channels, values.T, strict=True)}
    return identify(model, Measurements.of(TIMES, columns, deviations), seed=seed)


@pytest.mark.slow
def test_ninety_five_of_a_hundred_wrong_units_are_suspected_and_at_most_one_right_one():
    detected, alarms = 0, 0
    for seed in range(100):
        model, values, deviations, column, factor = drawn(seed)
        alarms += bool(suspects(fitted(model, values, deviations, seed)))
        values[:, column] *= factor
        detected += model.channels[column].name in suspects(fitted(model, values, deviations, seed))
    assert detected >= 95
    assert alarms <= 1


@pytest.mark.parametrize("seed", [4, 5, 8, 9, 10, 27, 28])
def test_first_guesses_that_are_far_off_are_no_wrong_unit(seed):
    """The fit explains the data, although a parameter changes by about the factor of a unit."""
    model, values, deviations, *_ = drawn(seed, 100.0)
    assert suspects(fitted(model, values, deviations, seed)) == {}


def test_a_shape_that_no_unit_explains_is_no_wrong_unit():
    """A ramp is 57.3 times as large as the response; no change of the unit makes a decay of it."""
    model = PythonModel(lambda rate: np.exp(-rate * TIMES), {"rate": (0.1, 5.0)}, [Channel("angle", "rad")], TIMES)
    ramp = 57.3 * TIMES / 4 + 1e-3 * np.random.default_rng(3).standard_normal(len(TIMES))
    fit = identify(model, Measurements.of(TIMES, {"angle": ramp}))
    assert suspects(fit) == {}
    decay = identify(model, Measurements.of(TIMES, {"angle": np.rad2deg(np.exp(-TIMES))}))
    assert suspects(decay)["angle"].values["factor"] == pytest.approx(180 / np.pi)


def pendulum(channel, unit_of_data, **own):
    """A pendulum of unknown length whose swing is measured."""
    times = np.linspace(0, 2, 41)

    def build(length):
        system = da.System(gravity=(0.0, -9.81))
        bar = system.add(da.RigidBar("bar", length=length, mass=1.0, angle=-1.2, **own))
        system.add(da.RevoluteJoint("pin", system.ground, bar.start))
        return system

    model = da.TimeResponse(build, {"length": (0.5, 2.0)}, [channel], times, da.GeneralizedAlpha(step=0.01))
    truth = model.evaluate(np.array([[0.8]])).values[0]
    noise = 1e-3 * np.ptp(truth) * np.random.default_rng(1).standard_normal(truth.shape)
    return model, Measurements.of(times, {channel: ((truth + noise) * unit_of_data)[:, 0]})


@pytest.mark.parametrize(
    ("channel", "factor", "question"),
    [
        ("bar.end.x", 1e3, "Is a metric prefix wrong, such as mm for m?"),
        ("bar.end.x", 1e-3, "Is a metric prefix wrong, such as mm for m?"),
        ("bar.end.angle", 180 / np.pi, "Are the data in degrees?"),
        ("bar.end.angle", DEGREE, "Were data in radians converted from degrees?"),
    ],
)
def test_a_mechanism_with_data_in_another_unit(channel, factor, question):
    model, data = pendulum(channel, factor)
    fit = identify(model, data, starts=1)
    finding = suspects(fit)[channel]
    assert finding.severity == "warning"
    assert finding.values["factor"] == pytest.approx(factor)
    assert question in finding.message
    assert str(finding) in fit.summary()
    assert suspects(identify(*pendulum(channel, 1.0), starts=1)) == {}


def test_a_parameter_that_makes_up_for_the_unit_is_named():
    model = PythonModel(
        lambda size: size * np.sin(TIMES), {"size": Parameter("size", 1e-3, 1e3, start=0.1)}, ["x"], TIMES
    )
    fit = identify(model, Measurements.of(TIMES, {"x": 120 * np.sin(TIMES)}))
    finding = suspects(fit)["x"]
    assert finding.values["parameter"] == "size"
    assert "The fit changes 'size' by such a factor to make up for it." in finding.message


def test_a_channel_of_one_experiment_is_named_with_it():
    right, data = pendulum("bar.end.x", 1.0)
    wrong, scaled = pendulum("bar.end.x", 1e3)
    fit = identify([Experiment("first", right, data), Experiment("second", wrong, scaled)], starts=1)
    assert list(suspects(fit)) == ["second.bar.end.x"]


def test_noise_around_rest_and_constant_channels_are_not_judged():
    model = PythonModel(
        lambda size: np.stack([size * np.sin(TIMES), 1e-6 * size * TIMES, np.full(len(TIMES), size)], 1),
        {"size": (0.5, 2.0)}, ["x", "rest", "constant"], TIMES,
    )  # fmt: skip
    noise = 1e-3 * np.random.default_rng(2).standard_normal((2, len(TIMES)))
    data = Measurements.of(TIMES, {"x": np.sin(TIMES), "rest": noise[0], "constant": 1 + noise[1]}, 1e-3)
    assert suspects(identify(model, data)) == {}


def test_a_wrapped_angle_is_judged_without_its_jumps():
    model = PythonModel(lambda rate: rate * TIMES, {"rate": (0.5, 50.0)}, [Channel("angle", "rad")], TIMES)
    data = Measurements.of(TIMES, {"angle": np.angle(np.exp(30j * TIMES))}, wraps=["angle"])
    assert suspects(identify(model, data, start=[28.0])) == {}
