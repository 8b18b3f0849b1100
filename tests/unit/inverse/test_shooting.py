"""Multiple shooting: segments and their gaps against closed forms, merging, refusals."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.errors import DataError, InputError
from dalembert.forward import ForwardModel, PythonModel
from dalembert.inverse import State, shooting
from dalembert.inverse.segments import Segments
from support import says

TIMES = np.linspace(0, 4, 41)


def swing(place, speed, stiffness):
    own = np.sqrt(stiffness)
    x = place * np.cos(own * TIMES) + speed / own * np.sin(own * TIMES)
    v = speed * np.cos(own * TIMES) - place * own * np.sin(own * TIMES)
    return np.stack([x, v], axis=1)


SWING = PythonModel(swing, {"place": (-2.0, 2.0), "speed": (-3.0, 3.0), "stiffness": (2.0, 30.0)}, ["x", "v"], TIMES)
STATES = {"place": State("x", -2.0, 2.0), "speed": State("v", -9.0, 9.0)}
TRUE = np.array([1.0, -0.5, 9.0])
PIECES = Segments(SWING, STATES, ("x",), np.array([0, 10, 21, 41 - 1]))


def measured(noise=0.0, **options):
    exact = swing(*TRUE)[:, 0]
    return Measurements.of(TIMES, {"x": exact + noise * np.random.default_rng(0).standard_normal(41)}, **options)


def together():
    """The parameters with which all segments are of one motion."""
    motion = swing(*TRUE)
    return np.concatenate([TRUE, motion[10], motion[21]])


def test_segments_of_one_motion_are_that_motion_and_meet():
    assert isinstance(PIECES, ForwardModel)
    assert PIECES.parameters.names[3:] == ("place at 10", "speed at 10", "place at 21", "speed at 21")
    assert [channel.name for channel in PIECES.channels] == [
        "x from 0",
        "x from 10",
        "x from 21",
        "place gap at 10",
        "speed gap at 10",
        "place gap at 21",
        "speed gap at 21",
    ]
    response = PIECES.evaluate(together()[None]).only()[0]
    x = swing(*TRUE)[:, 0]
    np.testing.assert_allclose(response[:11, 0], x[:11], atol=1e-12)
    np.testing.assert_allclose(response[:12, 1], x[10:22], atol=1e-12)
    np.testing.assert_allclose(response[:, 2], x[21:], atol=1e-12)
    np.testing.assert_allclose(response[:, 3:], 0, atol=1e-12)
    np.testing.assert_array_equal(response[11:, 0], 0)
    data = PIECES.data(measured(deviations=0.1), tightness=0.01)
    assert np.nanmax(np.abs(data.difference(response))) < 1e-12
    assert np.count_nonzero(data.present) == 11 + 12 + 20 + 4
    assert data.deviations.tolist() == [0.1] * 3 + [0.04, 0.18] * 2


def test_a_gap_is_the_end_of_a_segment_less_the_beginning_of_the_next():
    apart = together()
    apart[3] += 0.25
    response = PIECES.evaluate(apart[None]).only()[0]
    assert response[10, 3] == pytest.approx(-0.25)


def test_derivatives_are_those_of_differences():
    vector, step = together() + 0.1, 1e-6
    moved = [PIECES.evaluate(np.stack([vector + step * way, vector - step * way])).only() for way in np.eye(7)]
    differences = np.stack([(up - down) / (2 * step) for up, down in moved], axis=2)
    response, jacobian = PIECES.linearise(vector)
    np.testing.assert_allclose(jacobian, differences, atol=1e-7)
    np.testing.assert_allclose(response, PIECES.evaluate(vector[None]).only()[0], atol=1e-14)


def test_merged_segments_end_as_one_run():
    fit = shooting(SWING, measured(0.01, deviations=0.01), STATES, segments=4, start=[0.5, 0.5, 5.0])
    assert fit.parameters.names == ("place", "speed", "stiffness")
    assert fit.success
    assert np.all(np.abs(fit.values - TRUE) < 4 * fit.deviations)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"segments": 6}, "shooting: segments is 6; expected a power of 2, such as 8, so that they can merge"),
        ({"segments": 32}, "shooting: 41 samples are too few for 32 segments; expected more than two each"),
        (
            {"data": measured()},
            "shooting: the data have no deviations, which say how closely segments must meet; give them",
        ),
        (
            {"states": {"plac": State("x", -2, 2)}},
            "shooting, states: unknown parameter 'plac'; did you mean 'place'?",
        ),
        ({"states": {"place": State("y", -2, 2)}}, "shooting, state 'place': unknown channel 'y'; known: v, x"),
    ],
)
def test_what_cannot_be_cut_is_told(change, sentence):
    given = {"data": measured(deviations=0.1), "states": STATES} | change
    with pytest.raises((InputError, DataError), match=says(sentence)):
        shooting(SWING, **given)


def test_uneven_samples_are_told():
    times = TIMES.copy()
    times[-1] = 4.1
    model = PythonModel(swing, SWING.parameters, ["x", "v"], times)
    data = Measurements.of(times, {"x": np.ones(41)}, 0.1)
    sentence = (
        "shooting: the samples are between 0.1 and 0.2 s apart; expected even ones, so that each segment is like the "
        "beginning; resample the data"
    )
    with pytest.raises(InputError, match=says(sentence)):
        shooting(model, data, STATES)
