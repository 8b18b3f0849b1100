"""Bands: built from pairs of columns, cut, hashed, read from a file, and refused in whole sentences."""

import numpy as np
import pytest

from dalembert.data import Bands, read_bands
from dalembert.errors import DataError
from dalembert.forward import Coordinate
from support import says

TIMES = [0.0, 0.1, 0.2]
PAIRS = {"a.x": ([1.0, 2.0, 3.0], [2.0, 2.0, 7.0]), "a.y": ([0.0, 0.5, 1.0], [1.0, 1.0, 1.0])}


def test_pairs_of_columns_become_arrays_of_samples_and_channels():
    bands = Bands.of(TIMES, PAIRS)
    assert bands.channels == ("a.x", "a.y")
    assert bands.lower.tolist() == [[1.0, 0.0], [2.0, 0.5], [3.0, 1.0]]
    assert bands.upper.tolist() == [[2.0, 1.0], [2.0, 1.0], [7.0, 1.0]]
    assert (bands.coordinate.name, bands.coordinate.unit) == ("time", "s")


def test_middle_radius_and_width():
    bands = Bands.of(TIMES, PAIRS)
    assert bands.middle.tolist() == [[1.5, 0.5], [2.0, 0.75], [5.0, 1.0]]
    assert bands.radius.tolist() == [[0.5, 0.5], [0.0, 0.25], [2.0, 0.0]]
    assert bands.width.tolist() == [[1.0, 1.0], [0.0, 0.5], [4.0, 0.0]]


def test_the_first_samples_keep_their_coordinate():
    start = Bands.of(Coordinate("frequency", "Hz", np.array([1.0, 2.0, 4.0])), PAIRS).first(2)
    assert (start.coordinate.name, start.coordinate.values.tolist()) == ("frequency", [1.0, 2.0])
    assert start.upper.tolist() == [[2.0, 1.0], [2.0, 1.0]]


def test_the_fingerprint_follows_every_part():
    same = Bands.of(TIMES, PAIRS).fingerprint
    assert Bands.of(TIMES, PAIRS).fingerprint == same
    others = [
        Bands.of([0.0, 0.1, 0.3], PAIRS),
        Bands.of(TIMES, {"a.x": PAIRS["a.x"], "a.z": PAIRS["a.y"]}),
        Bands.of(TIMES, {**PAIRS, "a.y": ([0.0, 0.5, 0.9], [1.0, 1.0, 1.0])}),
        Bands.of(TIMES, {**PAIRS, "a.y": ([0.0, 0.5, 1.0], [1.0, 1.0, 1.1])}),
    ]
    assert len({same, *(other.fingerprint for other in others)}) == 5


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (
            lambda: Bands.of(TIMES, {"a.x": ([1.0, 3.0, 3.0], [2.0, 2.0, 7.0])}),
            "channel 'a.x', sample 1 (time 0.1 s): the lower bound 3 is larger than the upper bound 2; "
            "expected the lower one first; look whether the columns are exchanged",
        ),
        (
            lambda: Bands.of(TIMES, {"a.x": ([1.0, -np.inf, 3.0], [2.0, 2.0, 7.0])}),
            "channel 'a.x', sample 1 (time 0.1 s): the lower bound is -inf; expected a finite number",
        ),
        (
            lambda: Bands.of(Coordinate("turn", "", np.array([1.0])), {"a.x": ([1.0], [np.nan])}),
            "channel 'a.x', sample 0 (turn 1): the upper bound is nan; expected a finite number",
        ),
        (
            lambda: Bands.of(TIMES, {"a.x": ([1.0], [2.0, 2.0, 7.0])}),
            "channel 'a.x' has shape (1,); expected (3,), one value a time",
        ),
        (
            lambda: Bands.of(TIMES, {"a.x": [1.0, 2.0, 7.0]}),
            "channel 'a.x': 3 columns were given; expected two, (lower, upper)",
        ),
        (
            lambda: Bands.of(TIMES, {}),
            "the data hold 3 samples of 0 channels; expected at least one of each",
        ),
        (
            lambda: Bands(Coordinate("time", "s", np.arange(2.0)), ("x",), np.zeros((2, 1)), np.zeros(2)),
            "the upper bounds have shape (2,); expected (samples, channels) = (2, 1) for x",
        ),
        (
            lambda: Bands.of([0.0, 0.2, 0.1], PAIRS),
            "sample 2: time 0.1 comes after 0.2; expected values that grow; "
            "sort the samples or remove the repeated one",
        ),
    ],
)
def test_a_defect_is_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(DataError, match=says(sentence)):
        wrong()


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "bounds.csv"
    path.write_text("t,x_lower,x_upper,y_lower,y_upper\n0,1,2,-1,0\n0.5,2,3,-2,-1\n")
    return path


def test_columns_are_named_by_the_channels_that_they_bound(file):
    bands = read_bands(file, columns={"AB.end.y": ("y_lower", "y_upper"), "AB.end.x": ("x_lower", "x_upper")})
    assert bands.channels == ("AB.end.y", "AB.end.x")
    assert bands.coordinate.values.tolist() == [0.0, 0.5]
    assert bands.lower.tolist() == [[-1.0, 1.0], [-2.0, 2.0]]
    assert bands.upper.tolist() == [[0.0, 2.0], [-1.0, 3.0]]


def test_without_columns_every_pair_of_bounds_is_read(file):
    bands = read_bands(file)
    assert bands.channels == ("x", "y")
    assert bands.width.tolist() == [[1.0, 1.0], [1.0, 1.0]]


def test_a_value_known_exactly_has_one_column_for_both_bounds(file):
    assert read_bands(file, columns={"x": ("x_lower", "x_lower")}).radius.tolist() == [[0.0], [0.0]]
