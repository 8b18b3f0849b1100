"""The widget of a mechanism with sliders: what it shares with the browser, and what it answers."""

import base64
import sys

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.multibody import RevoluteJoint, RigidBar, System
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.study.template import begin
from dalembert.widget import sliders
from support import says

LENGTH = Parameters((Parameter("length", 0.5, 2.0, "m"),))


def pendulum(length):
    system = System()
    rod = system.add(RigidBar("rod", length=length, mass=1.0))
    system.add(RevoluteJoint("pin", system.ground, rod.start))
    return system


def made(*arguments, **options):
    pytest.importorskip("anywidget")
    return sliders(*arguments, **options)


def rod(film):
    """Positions (frames, 2, 2) of the rod, the first of the shapes."""
    numbers = np.frombuffer(base64.b64decode(film["positions"]), dtype="<f4")
    return numbers[: 4 * len(film["times"])].reshape(-1, 2, 2)


def test_a_function_is_simulated_at_the_values_of_its_sliders():
    widget = made(pendulum, LENGTH, end=1.0, channels=["rod.end.x"])
    assert widget.parameters == [{"name": "length", "unit": "m", "value": 1.25, "lower": 0.5, "upper": 2.0}]
    assert widget.answered == 0
    drawn = [(shape["kind"], shape["name"], shape["count"], shape["moves"]) for shape in widget.film["shapes"]]
    assert drawn == [("line", "rod", 2, True), ("ground", "pin", 1, False)]
    widget.asked = {"number": 3, "values": {"length": 2.0}}
    assert widget.answered == 3
    assert widget.values == {"length": 2.0}
    assert np.allclose(np.linalg.norm(rod(widget.film)[:, 1], axis=1), 2.0, atol=1e-6)
    assert len(widget.curves["series"]["rod.end.x"]) == len(widget.film["times"])


def test_values_outside_their_bounds_and_unknown_names_are_not_taken():
    widget = made(pendulum, LENGTH, end=1.0)
    widget.asked = {"number": 1, "values": {"length": 99.0, "other": 1.0}}
    assert np.allclose(np.linalg.norm(rod(widget.film)[:, 1], axis=1), 2.0, atol=1e-6)
    assert set(widget.values) == {"length"}


def test_a_model_that_fails_says_so_and_keeps_the_motion():
    def fragile(length):
        if length > 1.5:
            raise InputError("The rod is too long. Choose a shorter one.")
        return pendulum(length)

    widget = made(fragile, LENGTH, end=1.0)
    before = widget.film
    widget.asked = {"number": 1, "values": {"length": 1.8}}
    assert (widget.message, widget.answered, widget.film) == ("The rod is too long. Choose a shorter one.", 1, before)
    widget.asked = {"number": 2, "values": {"length": 1.0}}
    assert widget.message == ""


def test_a_study_has_its_parameters_its_end_and_its_data(tmp_path):
    widget = made(begin("identify", tmp_path / "mine"))
    assert [item["name"] for item in widget.parameters] == ["drag", "angle"]
    assert widget.film["times"][-1] == 4.0
    assert set(widget.curves["measured"]) == {"rod.end.x", "rod.end.y"}


def test_a_mechanism_in_space_is_sent_in_three_dimensions(tmp_path):
    assert made(begin("spatial", tmp_path / "mine")).film["dimensions"] == 3


def test_what_no_widget_can_show_is_refused(tmp_path):
    with pytest.raises(
        InputError,
        match=says(
            "sliders: model is 3; expected a study, the path of a study file, or a function that returns a mechanism"
        ),
    ):
        sliders(3)
    with pytest.raises(
        InputError, match=says("sliders: parameters is None; expected Parameters, which a function needs")
    ):
        sliders(pendulum)
    with pytest.raises(InputError, match=says("sliders: end is None; expected a positive number of seconds")):
        sliders(pendulum, LENGTH)
    with pytest.raises(
        InputError, match=says("sliders: the model of mine.toml is no mechanism. Give a study of a mechanism")
    ):
        sliders(begin("response", tmp_path / "mine"))
    with pytest.raises(
        InputError, match=says("sliders: mine.toml has no table [solver]. Add one with at least its step")
    ):
        sliders(begin("robot", tmp_path / "robot" / "mine"))


def test_a_missing_package_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "dalembert.widget.frontend", raising=False)
    with pytest.raises(
        InputError,
        match=says("sliders needs anywidget, which is not installed; run: pip install 'dalembert[notebook]'"),
    ):
        sliders(pendulum, LENGTH, end=1.0)


@pytest.mark.slow
def test_a_notebook_shows_models_results_and_the_widget(tmp_path):
    nbformat, client = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    begin("identify", tmp_path / "mine")
    cells = [
        "from dalembert.study import load\nstudy = load('mine/mine.toml')\nstudy.system()",
        "study.motion(1.0)",
        "from dalembert.widget import sliders\nsliders(study)",
    ]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    resources = {"metadata": {"path": str(tmp_path)}}
    client.NotebookClient(notebook, timeout=300, kernel_name="python3", resources=resources).execute()
    system, motion, widget = (cell.outputs[-1].data for cell in notebook.cells)
    assert 'data-part="pin"' in system["text/html"]
    assert "Simulated motion" in motion["text/html"]
    assert "application/vnd.jupyter.widget-view+json" in widget
