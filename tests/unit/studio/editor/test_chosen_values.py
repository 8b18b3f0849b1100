"""Values of sliders in the text of a study: of its parameters, of sensors, and of single experiments."""

import math
import re
import tomllib

import pytest
import tomlkit

from dalembert.errors import InputError
from dalembert.studio.editor.chosen_values import unit_in, use_as_start, use_as_value
from dalembert.studio.simulation.simulated_parts import parameters_of
from dalembert.study import load
from dalembert.study.template import begin
from support import says

EXPERIMENTS = """
[[experiments]]
name = "first"
start = { lower = "-10 ms", upper = 0.1 } # of the record
local = ["angle"]
[[experiments]]
name = "second"
local = { angle = { lower = -1.0 } }
[[experiments]]
name = "third"
[sensors.rod]
delay = [0, "50 ms"] # late
"""


@pytest.fixture
def path(tmp_path):
    """A study of three records with a sensor; the first two have parameters of their own."""
    path = begin("identify", tmp_path / "mine")
    before, data = path.read_text().split("[data]\n")
    own, _, after = data.partition("\n\n")
    experiments = re.sub('(name = "[a-z]+"\n)', rf"\1{own}\n", EXPERIMENTS)
    path.write_text(f"{before}{experiments}\n{after}")
    return path


def changed(path, change, *arguments):
    document = tomlkit.parse(path.read_text())
    change(document, *arguments)
    path.write_text(tomlkit.dumps(document))
    return parameters_of(load(path))


def test_every_parameter_of_a_fit_is_one_of_an_experiment(path):
    found = {name: [item.name for item in items] for name, items in parameters_of(load(path)).items()}
    assert found == {
        "first": ["drag", "first.angle", "rod delay", "first.start time"],
        "second": ["drag", "second.angle", "rod delay"],
        "third": ["drag", "angle", "rod delay"],
    }


def test_first_guesses_of_single_experiments_are_written(path):
    values = {"drag": 0.2, "first.angle": -0.3, "second.angle": -0.9, "first.start time": 0.05}
    found = changed(path, use_as_start, values)
    starts = {item.name: item.start for items in found.values() for item in items}
    assert {name: starts[name] for name in values} == pytest.approx(values, rel=1e-5)
    assert starts["angle"] == pytest.approx(-0.349066)
    assert "# of the record" in path.read_text()


def test_a_parameter_of_one_experiment_or_of_a_sensor_is_fixed(path):
    for name, value in {
        "first.angle": -0.3,
        "second.angle": -0.9,
        "rod delay": 0.0125,
        "first.start time": 0.05,
    }.items():
        found = changed(path, use_as_value, name, value)
        assert name not in {item.name for items in found.values() for item in items}
    assert 'delay = ["12.5 ms", "12.5 ms"] # late' in path.read_text()
    assert 'start = "50 ms"' in path.read_text()
    assert {name: [item.name for item in items] for name, items in found.items()} == {
        "first": ["drag"], "second": ["drag"], "third": ["drag", "angle"]
    }  # fmt: skip


def test_bounds_of_a_fixed_parameter_are_equal_whatever_their_units(tmp_path):
    path = begin("identify", tmp_path / "mine")
    path.write_text(path.read_text().replace('angle = { lower = "-60 deg"', "angle = { lower = -1.0"))
    assert 'lower = -1.0, upper = "' in path.read_text()
    found = changed(path, use_as_value, "angle", -0.5)
    assert [item.name for item in found[""]] == ["drag"]


def test_values_are_shown_in_the_units_of_the_study(path):
    document = tomllib.loads(path.read_text())
    names = ("drag", "angle", "first.angle", "second.angle", "rod delay", "first.start time", "mass")
    units = {name: unit_in(document, name)[0] for name in names}
    assert units == {
        "drag": "", "angle": "deg", "first.angle": "deg", "second.angle": "deg", "rod delay": "ms",
        "first.start time": "ms", "mass": "",
    }  # fmt: skip
    assert unit_in(document, "second.angle")[1] == pytest.approx(math.pi / 180)


def test_what_has_no_place_in_the_study_says_so(path):
    document = tomlkit.parse(path.read_text())
    with pytest.raises(
        InputError,
        match=says("rod delay has no first guess: [sensors] gives bounds only. Choose 'Use as value', or reset it."),
    ):
        use_as_start(document, {"rod delay": 0.01})
    with pytest.raises(
        InputError,
        match=says("'mass' is not described by a table of the study. Change the text where its value comes from."),
    ):
        use_as_start(document, {"mass": 1.0})
