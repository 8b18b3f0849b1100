"""Measurements: built from columns, cut, hashed, and refused in whole sentences."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.errors import DataError
from dalembert.forward import Coordinate

TIMES = [0.0, 0.1, 0.2]
COLUMNS = {"a.x": [1.0, 2.0, 3.0], "a.y": [0.0, 0.5, 1.0]}


def test_columns_become_an_array_of_samples_and_channels():
    data = Measurements.of(TIMES, COLUMNS)
    assert data.channels == ("a.x", "a.y")
    assert data.values.tolist() == [[1.0, 0.0], [2.0, 0.5], [3.0, 1.0]]
    assert (data.coordinate.name, data.coordinate.unit) == ("time", "s")
    assert data.deviations is None


@pytest.mark.parametrize("given", [0.1, {"a.y": 0.1, "a.x": 0.1}, [0.1, 0.1]])
def test_deviations_are_one_number_or_one_a_channel(given):
    assert Measurements.of(TIMES, COLUMNS, given).deviations.tolist() == [0.1, 0.1]


def test_another_coordinate_than_time_is_kept():
    data = Measurements.of(Coordinate("frequency", "Hz", np.array([1.0, 2.0, 4.0])), COLUMNS)
    assert data.first(2).coordinate.name == "frequency"
    assert data.first(2).coordinate.values.tolist() == [1.0, 2.0]
    assert data.first(2).values.tolist() == [[1.0, 0.0], [2.0, 0.5]]


def test_the_fingerprint_follows_every_part():
    same = Measurements.of(TIMES, COLUMNS).fingerprint
    assert Measurements.of(TIMES, COLUMNS).fingerprint == same
    others = [
        Measurements.of([0.0, 0.1, 0.3], COLUMNS),
        Measurements.of(TIMES, {"a.x": [1.0, 2.0, 3.0], "a.z": [0.0, 0.5, 1.0]}),
        Measurements.of(TIMES, {**COLUMNS, "a.y": [0.0, 0.5, 1.1]}),
        Measurements.of(TIMES, COLUMNS, 0.1),
    ]
    assert len({same, *(other.fingerprint for other in others)}) == 5


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (
            lambda: Measurements.of([0.0, 0.2, 0.1], COLUMNS),
            "sample 2: time 0.1 comes after 0.2; expected values that grow; "
            "sort the samples or remove the repeated one",
        ),
        (
            lambda: Measurements.of([0.0, 0.1, np.nan], COLUMNS),
            "sample 2: time is nan; expected a finite number",
        ),
        (
            lambda: Measurements.of(TIMES, {"a.x": [1.0, 2.0]}),
            "channel 'a.x' has shape (2,); expected (3,), one value a time",
        ),
        (
            lambda: Measurements.of(TIMES, {}),
            "the data hold 3 samples of 0 channels; expected at least one of each",
        ),
        (
            lambda: Measurements(Coordinate("time", "s", np.arange(2.0)), ("x", "x"), np.zeros((2, 2))),
            "channel names must differ; repeated: x",
        ),
        (
            lambda: Measurements(Coordinate("time", "s", np.arange(2.0)), ("x", "y"), np.zeros((2, 3))),
            "the values have shape (2, 3); expected (samples, channels) = (2, 2) for x, y",
        ),
        (
            lambda: Measurements.of(TIMES, COLUMNS, {"a.x": 0.1}),
            "no deviation given for channel 'a.y'; give one for each of a.x, a.y",
        ),
        (
            lambda: Measurements.of(TIMES, COLUMNS, {"a.x": 0.1, "a.yy": 0.1}),
            "deviations: unknown channel 'a.yy'; did you mean 'a.y'?",
        ),
        (
            lambda: Measurements.of(TIMES, COLUMNS, [0.1, 0.1, 0.1]),
            "deviations of shape (3,) were given; expected (2,), one a channel: a.x, a.y",
        ),
        (
            lambda: Measurements.of(TIMES, COLUMNS, [0.1, 0.0]),
            "channel 'a.y': its deviation is 0.0; expected a positive number",
        ),
    ],
)
def test_a_defect_is_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(DataError) as error:
        wrong()
    assert str(error.value) == sentence


def test_text_that_only_python_takes_for_a_number_is_refused():
    with pytest.raises(DataError, match="channel 'x', sample 1: '1_0'; expected a number"):
        Measurements.of([0.0, 1.0], {"x": ["1.5", "1_0"]})
