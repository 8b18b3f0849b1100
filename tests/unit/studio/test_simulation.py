"""What the process of a study computes for its sliders."""

import shutil
from base64 import b64decode
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.studio.simulation.answers import Source, influences, simulated
from dalembert.studio.simulation.simulated_parts import parameters_of, part
from dalembert.studio.worker import Kept
from dalembert.study import load
from dalembert.study.tables.posing import posed
from dalembert.study.tasks.frequency_response import drawn_dofs
from dalembert.study.template import begin

STUDIES = Path(__file__).parents[3] / "studies"
OSCILLATOR = """
[parameters]
k = { lower = 3.0, upper = 5.0, unit = "N/m" }
[model]
mass = [{ name = "m", mass = 1.0 }]
spring = [{ first = "m", stiffness = "k", damping = 0.1 }]
force = [{ dof = "m", amplitude = 1.0 }]
[frequency_response]
frequencies = [0.2, 0.25, 0.3, 0.35, 0.4]
"""


@pytest.fixture(scope="module")
def identification(tmp_path_factory):
    return begin("identify", tmp_path_factory.mktemp("studies") / "pendulum")


def source(path: Path) -> Source:
    return Source.of(load(path), path, path.read_text())


def start(path: Path) -> dict[str, float]:
    parameters = load(path).parameters
    return parameters.mapping(parameters.start)


def test_curves_are_those_of_the_model_that_is_identified(identification):
    study = load(identification)
    model, data = posed(study)
    values = start(identification) | {"drag": 0.25}
    found = simulated(Kept(), source(identification), "", values, figures=True)
    expected = model.evaluate(np.array([[values[name] for name in model.parameters.names]])).only()[0]
    lines = [curves.lines for curves in found.curves]
    computed = [line[trace][1] for line in lines for trace in sorted(line)[::2]]
    residual = [line[trace][1] for line in lines for trace in sorted(line)[1::2]]
    assert pytest.approx(expected, abs=1e-6) == np.array(computed).T
    assert pytest.approx(expected - data.values, abs=1e-6) == np.array(residual).T
    assert found.misfit == pytest.approx(np.sum((expected - data.values) ** 2 / (data.deviations or 1.0) ** 2))
    for curves in found.curves:
        for trace, (_, y) in curves.lines.items():
            drawn = curves.figure["data"][trace]
            assert ("computed" in drawn["name"]) == (y in computed)
            assert "measured" not in drawn["name"]


def test_a_film_holds_the_positions_of_bodies_and_joints(identification):
    found = simulated(Kept(), source(identification), "", start(identification))
    film, study = found.film, load(identification)
    assert film is not None
    assert found.curves[0].figure == {}
    motion = study.motion(film["times"][-1], times=np.array(film["times"])).drawing()
    expected = motion.lines | {name: at[:, None] for name, at in motion.joints.items()}
    numbers, first = np.frombuffer(b64decode(film["positions"]), "<f4"), 0
    for shape in film["shapes"]:
        size = 2 * shape["count"] * (len(film["times"]) if shape["moves"] else 1)
        if shape["role"] != "measured":
            drawn = numbers[first : first + size].reshape(-1, shape["count"], 2)
            assert drawn == pytest.approx(expected.pop(shape["name"])[: len(drawn)], abs=1e-5)
        first += size
    assert (first, expected) == (len(numbers), {})


def test_effects_are_the_changes_of_the_channels_between_the_bounds(identification):
    study = load(identification)
    model, _ = posed(study)
    values, wanted = start(identification), {}
    found = influences(Kept(), source(identification), "", values)
    vector = np.array([values[name] for name in model.parameters.names])
    for place, item in enumerate(model.parameters):
        aside = np.zeros(len(vector))
        aside[place] = 1e-4 * (item.upper - item.lower)
        low, middle, high = model.evaluate(np.array([vector - aside, vector, vector + aside])).values
        wanted[item.name] = np.sqrt(np.mean((high - low) ** 2, axis=0)) / 2e-4 / ranges(middle, study.data().values)
    assert set(found.effects) == set(wanted)
    for name, effects in wanted.items():
        assert found.effects[name] == pytest.approx(effects, rel=1e-2)


def ranges(response, measured):
    return np.maximum(np.ptp(response, axis=0), np.ptp(measured, axis=0))


def test_effects_on_a_channel_at_rest_are_relative_to_the_largest_one(tmp_path):
    path = tmp_path / "identify.toml"
    shutil.copytree(STUDIES / "unknown-load", tmp_path, dirs_exist_ok=True)
    measured = influences(Kept(), source(path), "", {}).effects
    assert 0 < max(effect[0] for effect in measured.values()) < 10
    text = path.read_text()
    path.write_text(text[: text.index("[data]")] + '[simulate]\nend = "2 s"\nchannels = ["bar.end.x"]\n')
    alone = influences(Kept(), source(path), "", {}).effects
    assert max(effect[0] for effect in alone.values()) == pytest.approx(1.0)


def test_a_study_is_read_again_only_if_it_changed(identification, monkeypatch):
    kept, values = Kept(), start(identification)
    simulated(kept, source(identification), "", values)
    with monkeypatch.context() as changed:
        changed.setattr("dalembert.study.loader.load", None)
        simulated(kept, source(identification), "", values)
        with pytest.raises(TypeError):
            simulated(kept, Source(identification, identification.read_text() + "\n"), "", values)


def test_a_curve_over_frequency_is_drawn(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(OSCILLATOR)
    peaks = []
    for stiffness in (3.0, 5.0):
        (curves,) = simulated(Kept(), source(path), "", {"k": stiffness}).curves
        (line,) = curves.figure["data"]
        peaks.append(np.frombuffer(b64decode(line["y"]["bdata"]), line["y"]["dtype"]))
    assert len(peaks[0]) == 5
    assert not np.allclose(peaks[0], peaks[1])


def test_experiments_are_simulated_one_by_one():
    study = load(Path("studies/friction-from-curve/identify.toml"))
    assert tuple(parameters_of(study)) == ("low", "high")
    assert part(study, "high").study.file.constants != part(study, "low").study.file.constants
    with pytest.raises(InputError, match="unknown experiment 'middle'"):
        part(study, "middle")


def test_a_frequency_curve_has_residuals_a_misfit_and_effects():
    path = Path("studies/friction-from-curve/identify.toml")
    values, study = start(path), load(path)
    kept = Kept()
    found = simulated(kept, source(path), "low", values, figures=True)
    (experiment, _), _ = posed(study)
    computed = experiment.model.evaluate(np.array([[values[name] for name in study.parameters.names]])).only()[0]
    residual = computed - experiment.data.values
    assert found.residuals == pytest.approx({"block.x harmonic 1": np.sqrt(np.mean(residual**2))})
    assert found.misfit == pytest.approx(np.sum((residual / experiment.data.deviations) ** 2))
    names = [trace["name"] for trace in found.curves[0].figure["data"]]
    assert any("measured" in name for name in names)
    assert len(names) == 3  # measured, computed, residual
    effects = influences(kept, source(path), "low", values).effects
    assert set(effects) == {"mu", "N0", "k_t"}
    assert all(effect > 0 for (effect,) in effects.values())


def test_values_of_experiments_and_sensors_act(tmp_path):
    path = begin("identify", tmp_path / "mine")
    table = path.read_text().replace("[data]", '[[experiments]]\nname = "trial"\nlocal = ["angle"]')
    path.write_text(table + "[sensors.rod]\ndelay = [0, 0.1]\nat_rest = true\n")
    values = {"drag": 0.2, "angle": 0.0, "trial.angle": -0.7, "rod delay": 0.05}
    found, ((experiment,), _) = simulated(Kept(), source(path), "trial", values), posed(load(path))
    expected = experiment.model.evaluate(np.array([[0.2, -0.7, 0.05]])).only()[0] - experiment.data.values
    assert found.residuals == pytest.approx({
        name: np.sqrt(np.mean(expected[:, column] ** 2)) for column, name in enumerate(experiment.data.channels)
    })  # fmt: skip
    assert set(influences(Kept(), source(path), "trial", values).effects) == {"drag", "trial.angle", "rod delay"}
    shapes = found.film["shapes"]
    before = sum(2 * shape["count"] for shape in shapes[: next(k for k, one in enumerate(shapes) if one["moves"])])
    start = np.frombuffer(b64decode(found.film["positions"]), "<f4")[before + 2 : before + 4]  # the end of the rod
    assert start == pytest.approx([0.8 * np.cos(0.7), -0.8 * np.sin(0.7)], abs=1e-6)


def test_a_task_without_a_simulation_says_so():
    with pytest.raises(InputError, match=r"^There is nothing to simulate for \[backbone\]\. Run the study"):
        part(load(Path("studies/duffing/backbone.toml")), "")


def test_nothing_to_simulate_is_a_hint_and_no_error():
    found = simulated(Kept(), source(Path("studies/duffing/backbone.toml")), "", {})
    assert found.hint.startswith("There is nothing to simulate for [backbone].")
    assert (found.film, found.curves) == (None, ())


def test_all_observed_degrees_of_freedom_are_drawn_and_have_effects(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(OSCILLATOR)
    found = influences(Kept(), source(path), "", {"k": 3.0})
    assert len(found.channels) == 1
    ((effect,),) = found.effects.values()
    omega = 2 * np.pi * np.array([0.2, 0.25, 0.3, 0.35, 0.4])
    stiff, lost = 3.0 - omega**2, 0.1 * omega
    size, slope = 1 / np.hypot(stiff, lost), -stiff * np.hypot(stiff, lost) ** -3.0
    assert effect == pytest.approx(2.0 * np.sqrt(np.mean(slope**2)) / np.ptp(size), rel=0.01)
    result = SimpleNamespace(dofs=("a.x", "b.x"))
    table = SimpleNamespace(dof="b.x", observe=["a.x", "b.x"])
    assert drawn_dofs(table, result) == ("b.x", "a.x")


def test_points_of_a_motion_in_space_have_three_coordinates(tmp_path):
    path = begin("spatial", tmp_path / "spatial")
    text = path.read_text()
    begun = text.index("# [simulate]")
    path.write_text(text[:begun] + '[simulate]\nend = 0.1\npoints = ["plate.origin"]\n')
    model = part(load(path), "").model
    assert [channel.name for channel in model.channels] == [f"plate.origin.{axis}" for axis in "xyz"]
