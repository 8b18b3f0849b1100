"""The tasks on intervals: bounds forward, intervals from bands, sets; on a decay whose bounds are known."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from dalembert.errors import DalembertError
from dalembert.study import load, plan, report_run, run_study
from dalembert.study.run.events import read_events
from dalembert.study.run.listing import rows
from dalembert.study.run.runner import unknowns
from pages import read_page

TIMES = np.linspace(0, 1, 11)
DECAY = """
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 1, 11)

def decay(parameters):
    return PythonModel(response, parameters, ["x"], times)

def response(rate, height):
    return (height * np.exp(-rate * times))[:, None]
"""
HEAD = """
[study]
name = "decay"
title = "Decay"
[parameters]
rate = { lower = 0.5, upper = "2 1/s" }
height = { lower = "100 mm", upper = 1.0, start = 0.3 }
[model]
forward = "decay.py:decay"
"""
PROPAGATE = (
    HEAD
    + """
[propagate]
method = "vertex"
[propagate.intervals]
height = { middle = "200 mm", relative = 0.1 }
"""
)
BANDS = (
    HEAD
    + """
[bands]
file = "bands.csv"
columns = { x = ["low", "high"] }
[identify_bands]
truth = { rate = [0.9, 1.1], height = { middle = 0.5, radius = "50 mm" } }
"""
)
SET = (
    HEAD
    + """
[data]
file = "data.csv"
columns = { x = "x" }
[identify_set]
error = 0.01
scheme = { kind = "tensor", order = 8 }
truth = { rate = 1.0, height = 0.5 }
"""
)


def decayed(rate, height):
    return height * np.exp(-rate * TIMES)


@pytest.fixture
def write(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "decay.py").write_text(DECAY)
    columns = {"low": decayed(1.1, 0.45), "high": decayed(0.9, 0.55), "x": decayed(1.0, 0.5)}
    for name, chosen in (("bands.csv", ("low", "high")), ("data.csv", ("x",))):
        table = np.column_stack([TIMES, *(columns[column] for column in chosen)])
        np.savetxt(name, table, fmt="%.17g", delimiter=",", header=",".join(("t", *chosen)), comments="")

    def write(text: str) -> Path:
        path = tmp_path / "decay.toml"
        path.write_text(text)
        return path

    return write


def test_bounds_are_those_of_the_closed_form(write):
    study = load(write(PROPAGATE))
    assert plan(study) == "bounds x at 11 samples over rate [0.5, 2], height [0.18, 0.22] by vertex (4 simulations)"
    folder, outcome = run_study(study)
    assert outcome.success
    with xr.open_dataset(folder.result, engine="h5netcdf") as result:
        np.testing.assert_allclose(result["lower"].values[:, 0], decayed(2.0, 0.18), rtol=1e-14)
        np.testing.assert_allclose(result["upper"].values[:, 0], decayed(0.5, 0.22), rtol=1e-14)
    events = list(read_events(folder.events))
    assert [event["event"] for event in events] == ["run-started", "method-began", "ran", "method-ended", "run-ended"]
    settings = json.loads(folder.settings.read_text())["propagate"]
    assert settings["intervals"] == {"height": {"middle": 0.2, "relative": 0.1}}
    assert settings["method"] == {"kind": "vertex"}


def test_the_list_tells_widths_and_intervals(write):
    run_study(load(write(PROPAGATE)))
    width = np.max(decayed(0.5, 0.22) - decayed(2.0, 0.18))
    assert rows(Path("runs"))[0]["best"] == f"width of x = {width:.6g}"


@pytest.mark.parametrize(
    "text", [PROPAGATE, PROPAGATE.replace('"vertex"', '"vertex"\ncompare = ["taylor"]'), BANDS, SET]
)
def test_a_report_is_made_anew_from_the_result(write, text):
    folder, outcome = run_study(load(write(text)))
    assert outcome.success, outcome.status
    before = folder.report.read_text()
    assert "Decay" in before
    folder.report.unlink()
    report_run(folder)
    assert folder.report.read_text() == before


@pytest.mark.parametrize("text", [PROPAGATE, BANDS, SET])
def test_two_runs_give_the_same_numbers(write, text):
    first, second = (xr.load_dataset(run_study(load(write(text)))[0].result, engine="h5netcdf") for _ in range(2))
    xr.testing.assert_identical(first.drop_attrs(), second.drop_attrs())


def test_methods_are_compared(write):
    compare = PROPAGATE.replace(
        '"vertex"', '"vertex"\ncompare = ["taylor", "optimise", { kind = "scan", points_each = 3 }]'
    )
    study = load(write(compare))
    assert plan(study) == (
        "bounds x at 11 samples over rate [0.5, 2], height [0.18, 0.22] by vertex (4 simulations), "
        "taylor (7 simulations), scan (points_each=3) (9 simulations), optimise (as many simulations as it asks for)"
    )
    folder, outcome = run_study(study)
    rows = read_page(folder.report).table("methods")
    assert [row[0] for row in rows[1:]] == ["vertex", "taylor", "scan (points_each=3)", "optimise"]
    assert float(rows[1][3]) < 1e-12  # monotone, so the corners are exact
    assert float(rows[2][3]) > 1e-3
    assert outcome.status.endswith("The error is the distance to optimise.")


def test_another_reference(write):
    study = load(write(PROPAGATE.replace('"vertex"', '"taylor"\ncompare = ["vertex"]\nreference = "vertex"')))
    assert plan(study).endswith("by taylor (7 simulations), vertex (4 simulations)")


def test_intervals_are_identified_from_bands(write):
    study = load(write(BANDS))
    assert plan(study) == (
        "identifies intervals of rate, height from the bands of x at 11 samples by GlobalSurrogate: "
        "as many simulations as its surrogate needs"
    )
    folder, outcome = run_study(study)
    values = outcome.best["values"]
    expected = {"rate lower": 0.9, "rate upper": 1.1, "height lower": 0.45, "height upper": 0.55}
    assert values.keys() == expected.keys()
    for name, value in expected.items():
        assert values[name] == pytest.approx(value, abs=1e-4), name
    table = read_page(folder.report).table("intervals")
    assert [float(entry) for entry in table[1][3:5]] == [0.9, 1.1]
    assert {"iteration", "run-ended"} <= {event["event"] for event in read_events(folder.events)}


def test_a_parameter_that_is_a_number_is_identified_without_a_radius(write):
    study = load(
        write(BANDS.replace("[identify_bands]", '[identify_bands]\nintervals = ["height"]\nweights = { x = 2.0 }'))
    )
    assert plan(study).startswith("identifies intervals of height and the numbers rate from the bands of x")
    assert unknowns(study) == ("rate middle", "height middle", "height radius")
    _, outcome = run_study(study)
    values = outcome.best["values"]
    assert values["rate lower"] == values["rate upper"]
    assert values["height upper"] - values["height lower"] > 0.05


def test_the_nested_way_says_what_it_would_cost(write):
    nested = 'method = { kind = "nested", swarm = { kind = "improved-swarm", particles = 40, iterations = 100 } }'
    study = load(write(BANDS.replace("[identify_bands]", f"[identify_bands]\n{nested}")))
    assert plan(study).endswith("by Nested: 40 particles x 100 iterations x 12 runs = 48000 simulations")


def test_a_set_holds_the_parameters_of_the_data(write):
    study = load(write(SET))
    assert "paves the set of rate, height that explain 11 samples of x within their errors" in plan(study)
    folder, outcome = run_study(study)
    values = outcome.best["values"]
    assert values["height lower"] < 0.5 < values["height upper"]
    assert 0.49 - 2e-3 < values["height lower"] < 0.49 + 2e-3  # the sample at 0 tells it within the error
    assert values["rate lower"] < 1.0 < values["rate upper"]
    with xr.open_dataset(folder.result, engine="h5netcdf") as result:
        inside = result["inside"].values
    corners = [decayed(rate, height) for box in inside for rate in box[:, 0] for height in box[:, 1]]
    assert np.all(np.abs(corners - decayed(1.0, 0.5)) <= 0.01 + 1e-6)


def mistakes(path: Path) -> list[str]:
    with pytest.raises(DalembertError) as caught:
        plan(load(path))
    return str(caught.value).split("\n")


@pytest.mark.parametrize(
    ("text", "change", "messages"),
    [
        (PROPAGATE, ('"vertex"', '"vertices"'), [
            "decay.toml: [propagate], method: 'vertices' was given; expected 'vertex', 'scan', 'monte-carlo', "
            "'latin-hypercube', 'taylor', 'optimise' or 'chebyshev'; did you mean 'vertex'?"
        ]),
        (PROPAGATE, ('"vertex"', '{ kind = "scan", points = 3 }'), [
            "decay.toml: [propagate.method]: unknown key 'points'; did you mean 'points_each'?"
        ]),
        (PROPAGATE, ('"vertex"', '{ kind = "chebyshev", scheme = { kind = "tensor", order = 0 } }'), [
            "decay.toml: [propagate.method.scheme]: Tensor: order is 0; expected at least 1 in each direction"
        ]),
        (PROPAGATE, ('"vertex"', '"vertex"\nreference = "scan"'), [
            "decay.toml: [propagate], reference: nothing is compared; name methods in compare, or leave the key out"
        ]),
        (PROPAGATE, ('"vertex"', '"vertex"\nchannels = ["x"]'), [
            "decay.toml: [propagate], channels: a forward model has its own; leave the key out"
        ]),
        (PROPAGATE, ("height = { middle", "hight = { middle"), [
            "decay.toml: [propagate.intervals]: unknown parameter 'hight'; did you mean 'height'?"
        ]),
        (PROPAGATE, ("relative = 0.1", "lower = 0.1"), [
            "decay.toml: [propagate.intervals.height]: the keys lower, middle were given; expected [lower, upper], "
            "{ middle, radius }, { middle, relative } or one number"
        ]),
        (PROPAGATE, ('{ middle = "200 mm", relative = 0.1 }', "[0.3, 0.2]"), [
            "decay.toml: [propagate.intervals], height: an interval of (0.3, 0.2) was given; expected two finite "
            "numbers, the lower one first"
        ]),
        (PROPAGATE, ('{ middle = "200 mm", relative = 0.1 }', "[0.3]"), [
            "decay.toml: [propagate.intervals], height: [0.3] was given; expected [lower, upper], "
            "{ middle, radius }, { middle, relative } or one number"
        ]),
        (BANDS, ('["low", "high"]', '["low"]'), [
            "decay.toml: [bands.columns], x: ['low'] was given; expected at least 2 entries"
        ]),
        (BANDS, ('["low", "high"]', '["low", "hihg"]'), ["bands.csv: unknown column 'hihg'; did you mean 'high'?"]),
        (BANDS, ("[bands]", "[data]"), [
            "decay.toml: [data.columns], x: ['low', 'high'] was given; expected the name of a column in "
            "quotes, or its number from 1"
        ]),
        (BANDS, ("[identify_bands]", '[identify_bands]\nintervals = ["hate"]\nweights = { y = 1.0 }'), [
            "decay.toml: [identify_bands], intervals: unknown parameter 'hate'; did you mean 'rate'?",
            "decay.toml: [identify_bands], weights: no weight is given for channel 'x'",
            "decay.toml: [identify_bands], weights: unknown channel 'y'; known: x",
        ]),
        (SET, ("error = 0.01", "error = { y = 0.01 }"), [
            "decay.toml: [identify_set], error: no error is given for channel 'x'",
            "decay.toml: [identify_set], error: unknown channel 'y'; known: x",
        ]),
        (SET, ("error = 0.01", ""), ["decay.toml: [identify_set]: the key 'error' is missing"]),
        (SET, ("truth = { rate", "truth = { hate"), [
            "decay.toml: [identify_set.truth]: unknown parameter 'hate'; did you mean 'rate'?"
        ]),
    ],
)  # fmt: skip
def test_what_does_not_fit(write, text, change, messages):
    assert text.count(change[0]) == 1
    path = write(text.replace(*change))
    folder = f"{path.parent}/"
    assert [message.replace(folder, "") for message in mistakes(path)] == messages


def test_a_mechanism_needs_times_and_channels(write):
    path = write("""
[parameters]
theta = { lower = 0.1, upper = 0.2 }
[model]
[[model.body]]
kind = "RigidBar"
name = "rod"
length = 1.0
mass = 1.0
angle = "-theta"
[propagate]
""")
    assert mistakes(path) == [
        "decay.toml: [propagate]: the key 'times' is missing; a mechanism needs it",
        "decay.toml: [propagate]: the key 'channels' is missing; a mechanism needs it",
        "decay.toml: the table [solver] is missing; expected at least its step",
    ]
