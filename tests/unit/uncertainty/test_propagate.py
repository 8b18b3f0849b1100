"""What propagate asks of its intervals and methods, and what it tells on its way."""

import json

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.forward import Channel, Coordinate, PythonModel
from dalembert.intervals import Box, Interval
from dalembert.tables import shown
from dalembert.uncertainty import Began, Ended, MonteCarlo, Ran, Taylor, as_record, methods_by_name, propagate
from dalembert.uncertainty.methods import label, method_of
from small_models import DECAY, LINE, TIMES
from support import says

BOX = {"size": (1.0, 2.0), "rate": (0.5, 1.0)}


def test_intervals_are_put_in_the_order_of_the_model():
    bands = propagate(DECAY, {"rate": Interval(0.5, 1.0), "size": 2.0}, "vertex")
    assert bands.box.names == ("size", "rate")
    assert (bands.box.lower.tolist(), bands.box.upper.tolist()) == ([2.0, 0.5], [2.0, 1.0])
    assert bands.runs == 2
    same = propagate(DECAY, Box.of({"size": 2.0, "rate": (0.5, 1.0)}), "vertex")
    assert same.lower.tobytes() == bands.lower.tobytes()


def test_the_search_bounds_of_the_model_do_not_limit_the_box():
    bands = propagate(DECAY, {"size": (5.0, 6.0), "rate": 0.0}, "vertex")
    assert (bands.lower[0, 0], bands.upper[0, 0]) == (5.0, 6.0)


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (
            lambda: propagate(DECAY, {"size": 1.0}, "vertex"),
            "intervals: none is given for parameter 'rate'; expected an interval, or a number if it is known exactly, "
            "for each of size, rate",
        ),
        (
            lambda: propagate(DECAY, {**BOX, "rates": 1.0}, "vertex"),
            "intervals: unknown parameter 'rates'; did you mean 'rate'?",
        ),
        (
            lambda: propagate(DECAY, {**BOX, "rate": (1.0, 0.5)}, "vertex"),
            "interval of 'rate': (1.0, 0.5) was given; expected two finite numbers, the lower one first",
        ),
        (
            lambda: propagate(DECAY, BOX, "monte carlo"),
            "unknown method 'monte carlo'; did you mean 'monte-carlo'?",
        ),
        (
            lambda: propagate(DECAY, BOX, 7),
            f"method: 7 was given; expected one of {', '.join(methods_by_name())}, or settings such as MonteCarlo(runs=500)",
        ),
    ],
)
def test_what_cannot_be_meant_is_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        wrong()


@pytest.mark.parametrize("name", methods_by_name())
def test_every_method_bounds_a_linear_response(name):
    """Exact where corners are run, from inside by random points; labelled, counted, and within its own error."""
    bands = propagate(LINE, {"offset": (-1.0, 2.0), "slope": (1.0, 3.0)}, name)
    lower = np.stack([-1 + TIMES, TIMES**2 - 2], axis=1)
    upper = np.stack([2 + 3 * TIMES, 3 * TIMES**2 + 1], axis=1)
    loose = 0.2 if name in ("monte-carlo", "latin-hypercube") else 1e-9
    assert np.all(np.abs(bands.lower - lower) <= loose * (upper - lower) + 1e-9)
    assert np.all(np.abs(bands.upper - upper) <= loose * (upper - lower) + 1e-9)
    if bands.kind == "inner bound":
        assert np.all((bands.lower >= lower - 1e-12) & (bands.upper <= upper + 1e-12))
    assert bands.channels == ("x", "y")
    assert bands.coordinate is LINE.coordinate
    assert bands.kind in ("inner bound", "estimate", "enclosure of the surrogate")
    assert bands.success
    assert bands.failures == ()
    assert bands.runs > 0
    assert bands.method == name


@pytest.mark.parametrize("name", methods_by_name())
def test_every_method_answers_for_numbers_all_known_exactly(name):
    bands = propagate(DECAY, {"size": 2.0, "rate": 1.0}, name)
    np.testing.assert_allclose(bands.lower[:, 0], 2 * np.exp(-TIMES), rtol=1e-14)
    np.testing.assert_allclose(bands.upper[:, 0], 2 * np.exp(-TIMES), rtol=1e-14)


@pytest.mark.parametrize("name", methods_by_name())
def test_events_tell_the_beginning_the_runs_and_the_end(name):
    events = []
    bands = propagate(DECAY, BOX, name, on_event=events.append)
    began, *ran, ended = events
    assert isinstance(began, Began)
    assert all(isinstance(event, Ran) for event in ran)
    assert [event.runs for event in ran] == sorted(event.runs for event in ran)
    assert (ran[-1].runs, ran[-1].failed) == (bands.runs, 0)
    assert isinstance(ended, Ended)
    assert (ended.success, ended.status, ended.runs) == (bands.success, bands.status, bands.runs)
    if began.most is not None:
        assert bands.runs == began.most
    for event in events:
        assert json.loads(json.dumps(as_record(event)))["event"] == event.kind


def test_the_provenance_tells_model_method_settings_seed_and_intervals():
    told = propagate(DECAY, BOX, MonteCarlo(runs=50), seed=7).provenance
    assert told["model"] == DECAY.fingerprint
    assert told["method"] == {"name": "MonteCarlo", "settings": {"runs": 50}}
    assert told["seed"] == 7
    assert told["intervals"] == {"size": [1.0, 2.0], "rate": [0.5, 1.0]}


def test_units_and_the_coordinate_are_those_of_the_model():
    model = PythonModel(
        lambda k: np.array([k]), {"k": (0.0, 1.0)}, [Channel("x", "mm")], np.array([3.0]), coordinate="load", unit="N"
    )
    bands = propagate(model, {"k": (0.0, 1.0)}, "vertex")
    assert bands.units == ("mm",)
    assert (bands.coordinate.name, bands.coordinate.unit) == ("load", "N")
    assert isinstance(bands.first(1).coordinate, Coordinate)


def test_a_label_tells_the_settings_that_are_not_the_usual_ones():
    assert label(method_of("taylor")) == "taylor"
    assert label(Taylor(held_out=2)) == "taylor (held_out=2)"
    assert propagate(DECAY, BOX, MonteCarlo(runs=10)).method == "monte-carlo (runs=10)"


def test_the_summary_tells_widths_intervals_kind_runs_and_status():
    text = propagate(DECAY, BOX, "vertex").summary()
    lines = [line.split() for line in text.splitlines()]
    mean = np.mean(2 * np.exp(-TIMES / 2) - np.exp(-TIMES))
    assert next(line for line in lines if line[:1] == ["x"])[3:5] == [shown(mean), "unknown"]
    assert ["rate", "0.5", "1", "0.75", "0.25"] in lines
    assert ["the", "bounds", "are", "inner", "bound"] in lines
    assert ["runs", "of", "the", "model", "4"] in lines
    assert (
        "Use the method 'optimise', which also finds extremes inside the box.\nThe error of the bounds is unknown."
        in text
    )
