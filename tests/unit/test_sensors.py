"""What sensors read of a response: delays, gains and offsets against closed forms, their derivatives, and refusals."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.errors import InputError
from dalembert.forward import Channel, ForwardModel, PythonModel, Sensor, Sensors
from dalembert.inverse import identify
from dalembert.parameter import Parameter
from support import says

FINE = np.linspace(0, 4, 401)
STAMPS = np.array([0.5, 0.83, 1.7, 2.0, 3.14])
POINT = np.array([3.0, 0.07, 1.5, -0.2])


def swing(rate):
    if np.real(rate) > 8:
        raise RuntimeError("too fast")
    return np.stack([np.cos(rate * FINE), np.sin(rate * FINE)], axis=1)


SWING = PythonModel(swing, {"rate": (1.0, 9.0)}, ["x", "y"], FINE)
SEEN = Sensors(SWING, {"x": Sensor(delay=(-0.1, 0.2), gain=(0.5, 2.0), offset=(-1, 1))}, STAMPS)


def exact(rate, delay, gain, offset):
    return np.stack([gain * np.cos(rate * (STAMPS - delay)) + offset, np.sin(rate * STAMPS)], axis=1)


def test_readings_are_the_response_delayed_scaled_and_shifted():
    assert isinstance(SEEN, ForwardModel)
    np.testing.assert_allclose(SEEN.evaluate(POINT[None]).only()[0], exact(*POINT), atol=1e-9)
    np.testing.assert_allclose(SEEN.linearise(POINT)[0], exact(*POINT), atol=1e-9)


def test_unknowns_are_named_by_their_channel_and_begin_where_a_sensor_is_perfect():
    assert SEEN.parameters.names == ("rate", "x delay", "x gain", "x offset")
    assert [item.unit for item in SEEN.parameters] == ["", "s", "", ""]
    assert SEEN.parameters.start.tolist() == [5.0, 0.0, 1.0, 0.0]
    late = Sensors(SWING, {"y": Sensor(delay=(0.1, 0.3), gain=Parameter("any", 0.5, 2, start=1.1))}, STAMPS)
    assert late.parameters.start.tolist() == [5.0, 0.2, 1.1]


def test_derivatives_are_those_of_the_closed_form():
    step = 1e-6
    moved = [exact(*(POINT + step * way)) - exact(*(POINT - step * way)) for way in np.eye(4)]
    np.testing.assert_allclose(SEEN.jacobian(POINT), np.stack(moved, axis=2) / (2 * step), atol=2e-8)


def test_stamps_that_are_samples_are_read_without_interpolation():
    stamps = FINE[[50, 83, 170]]
    seen = Sensors(SWING, {"x": Sensor(gain=(0.5, 2.0))}, stamps)
    assert seen.evaluate(np.array([[3.0, 1.0]])).only()[0].tobytes() == swing(3.0)[[50, 83, 170]].tobytes()


def test_a_run_that_fails_is_marked_and_the_others_return():
    responses = SEEN.evaluate(np.array([POINT, [8.5, 0, 1, 0]]))
    assert responses.failures == (None, "RuntimeError: too fast (test_sensors.py, line 20)")
    np.testing.assert_allclose(responses.values[0], exact(*POINT), atol=1e-9)


def test_the_first_readings_need_only_the_beginning_of_the_model():
    part = SEEN.first(2)
    assert part.coordinate.values.tolist() == [0.5, 0.83]
    assert part.model.coordinate.values[-1] == pytest.approx(0.98)  # 0.1 s early, and room for the spline
    np.testing.assert_allclose(part.evaluate(POINT[None]).only()[0], exact(*POINT)[:2], atol=1e-6)
    whole = SEEN.first(5)
    assert whole.coordinate.values.tolist() == STAMPS.tolist()
    assert part.fingerprint != SEEN.fingerprint


def test_at_rest_readings_from_before_the_first_sample_are_the_first_state():
    stamps = np.array([0.0, 0.05, 0.2])
    seen = Sensors(SWING, {"x": Sensor(delay=(0.0, 0.1), at_rest=True)}, stamps)
    response, slopes = seen.linearise(np.array([3.0, 0.1]))
    np.testing.assert_allclose(response[:, 0], [1.0, 1.0, np.cos(0.3)], atol=1e-9)
    np.testing.assert_allclose(slopes[:2, 0], 0.0, atol=1e-12)


def lagging(rate, lag, times):
    """Sine behind a first-order lag that begins at rest."""
    gain, phase = 1 / np.sqrt(1 + (rate * lag) ** 2), np.arctan(rate * lag)
    start = gain * np.sin(phase) * np.exp(-times / lag) if lag else 0.0
    return gain * np.sin(rate * times - phase) + start


@pytest.mark.parametrize("lag", [0.0, 1e-5, 0.003, 0.0099, 0.0101, 0.2, 3.0, 1e3])
def test_a_lagged_sine_has_the_gain_and_the_phase_of_a_low_pass(lag):
    seen = Sensors(SWING, {"y": Sensor(lag=(0.0, 2e3))}, STAMPS)
    read = seen.evaluate(np.array([[5.0, lag]])).values[0, :, 1]
    np.testing.assert_allclose(read, lagging(5.0, lag, STAMPS), atol=1e-9)
    np.testing.assert_allclose(seen.linearise(np.array([5.0, lag]))[0][:, 1], read, rtol=1e-12)


@pytest.mark.parametrize("lag", [1e-4, 0.0095, 0.0105, 0.2, 3.0])
def test_derivatives_of_a_lagged_reading_are_exact(lag):
    sensor = Sensor(lag=(0.0, 5.0), delay=(0.0, 0.2), gain=(0.5, 2.0), at_rest=True)
    seen = Sensors(SWING, {"y": sensor}, np.array([0.01, 0.3, 0.333, 2.0, 3.7]))
    point = np.array([4.0, 0.043, lag, 1.3])
    slopes = seen.jacobian(point)
    for column, step in enumerate((1e-6, 1e-6, 1e-4 * lag, 1e-6)):
        way = step * np.eye(4)[column]
        moved = seen.evaluate(np.array([point + way, point - way])).values
        differences = (moved[0] - moved[1]) / (2 * step)
        np.testing.assert_allclose(slopes[:, :, column], differences, atol=2e-7 * max(1.0, np.abs(differences).max()))


def test_the_derivative_at_no_lag_is_that_of_a_small_one():
    seen = Sensors(SWING, {"y": Sensor(lag=(0.0, 5.0))}, STAMPS)
    np.testing.assert_allclose(seen.jacobian(np.array([4.0, 0.0]))[:, 1, 1], -4 * np.cos(4 * STAMPS), atol=1e-6)
    np.testing.assert_allclose(seen.jacobian(np.array([4.0, 1e-7]))[:, 1, 1], -4 * np.cos(4 * STAMPS), atol=1e-5)


def test_a_lag_is_exact_between_uneven_samples_of_a_polynomial():
    """Of degree 3, which the spline has, so that the closed form holds to rounding."""
    own, stamps, lag = np.cumsum(np.r_[0.0, np.tile([0.01, 0.2, 0.05], 12)]), np.array([0.0, 0.07, 1.234, 3.1]), 0.15
    cubic = PythonModel(lambda a: a * own**3, {"a": (0.5, 2.0)}, ["x"], own)
    read = Sensors(cubic, {"x": Sensor(lag=(lag, lag))}, stamps).evaluate(np.array([[1.0]])).values[0, :, 0]
    settled = stamps**3 - 3 * lag * stamps**2 + 6 * lag**2 * stamps - 6 * lag**3
    np.testing.assert_allclose(read, settled + 6 * lag**3 * np.exp(-stamps / lag), atol=1e-12)


def test_a_lag_is_not_confused_with_a_delay():
    """A swept sine shows both, and the fit separates them."""
    fine = np.linspace(0.0, 4.0, 2001)
    sweep = PythonModel(lambda rate: np.sin(rate * fine + fine**3), {"rate": (1.0, 9.0)}, ["x"], fine)
    seen = Sensors(sweep, {"x": Sensor(lag=(0.0, 0.1), delay=(0.0, 0.05), at_rest=True)}, np.linspace(0.0, 4.0, 401))
    measured = seen.evaluate(np.array([[3.0, 0.012, 0.03]])).values[0]
    fit = identify(seen, Measurements.of(seen.coordinate.values, {"x": measured[:, 0]}))
    np.testing.assert_allclose(fit.values, [3.0, 0.012, 0.03], rtol=1e-6)


@pytest.mark.parametrize(
    ("sensors", "times", "sentence"),
    [
        ({"z": Sensor(gain=(0, 2))}, STAMPS, "Sensors: unknown channel 'z'; known: x, y"),
        (
            {"x": Sensor()},
            STAMPS,
            "Sensors: the sensor of 'x' has no delay, lag, gain or offset; give bounds of at least one of them, or remove the sensor",
        ),
        (
            {"x": Sensor(delay=(0.0, 0.6))},
            STAMPS,
            "Sensors: the first reading of 'x', at time 0.5 s, may show the motion at -0.1 s, and the model begins at "
            "0 s; leave out the first readings, lower the delay's upper bound, or give at_rest=True if nothing moves "
            "before",
        ),
        (
            {"x": Sensor(delay=(-1.0, 0.0))},
            STAMPS,
            "Sensors: the last reading of 'x', at time 3.14 s, may show the motion at 4.14 s, and the model ends at "
            "4 s; build the model with samples until then",
        ),
        (
            {"x": Sensor(gain=(0, 2))},
            np.array([1.0, 4.5]),
            "Sensors: the last reading of 'x', at time 4.5 s, may show the motion at 4.5 s, and the model ends at 4 s; "
            "build the model with samples until then",
        ),
        (
            {"x": Sensor(lag=(-0.1, 0.1))},
            STAMPS,
            "Sensors: the lag of 'x' may be -0.1; expected bounds of zero or more",
        ),
        (
            {"x": Sensor(gain=(2, 1))},
            STAMPS,
            "parameter 'x gain': bounds are (2.0, 1.0); expected two finite numbers, the lower one first",
        ),
    ],
)
def test_what_sensors_cannot_read_is_told(sensors, times, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        Sensors(SWING, sensors, times)


def pair(rate):
    return np.stack([np.cos(rate * FINE), np.sin(rate * FINE)], axis=1)


BOTH = PythonModel(pair, {"rate": (1.0, 9.0)}, [Channel("imu.x", "m"), Channel("imu.y", "rad")], FINE)


def test_channels_of_a_component_share_a_delay():
    seen = Sensors(BOTH, {"imu": Sensor(delay=(0.0, 0.2)), "imu.y": Sensor(gain=(0.5, 2.0))}, STAMPS)
    assert seen.parameters.names == ("rate", "imu delay", "imu.y gain")
    point = np.array([3.0, 0.07, 1.5])
    phase = 3.0 * (STAMPS - 0.07)
    values, jacobian = seen.linearise(point)
    np.testing.assert_allclose(values, np.stack([np.cos(phase), 1.5 * np.sin(phase)], axis=1), atol=1e-9)
    by_delay = np.stack([3.0 * np.sin(phase), -4.5 * np.cos(phase)], axis=1)
    np.testing.assert_allclose(jacobian[:, :, 1], by_delay, atol=2e-7)
    np.testing.assert_allclose(jacobian[:, :, 2], np.stack([0 * phase, np.sin(phase)], axis=1), atol=1e-9)


@pytest.mark.parametrize(
    ("sensors", "sentence"),
    [
        (
            {"imu": Sensor(delay=(0.0, 0.1)), "imu.x": Sensor(delay=(0.0, 0.1))},
            "Sensors: the delay of 'imu.x' is given by 'imu' and by 'imu.x'; expected one",
        ),
        (
            {"imu": Sensor(offset=(0.0, 0.1))},
            "Sensors: the channels of 'imu' have the units 'm', 'rad', and no offset in common; give the offsets by "
            "channel",
        ),
        ({"im": Sensor(delay=(0.0, 0.1))}, "Sensors: unknown channel 'im'; known: imu.x, imu.y"),
    ],
)
def test_what_a_component_cannot_share_is_told(sensors, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        Sensors(BOTH, sensors, STAMPS)
