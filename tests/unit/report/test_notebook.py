"""What notebooks show of results and models: HTML without scripts, made only when it is asked for."""

import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import dataclass

import numpy as np
import plotly.graph_objects as go
import pytest

from dalembert.data import Measurements
from dalembert.findings import Finding
from dalembert.forward import PythonModel
from dalembert.inverse import identify
from dalembert.multibody import RevoluteJoint, RigidBar, System, simulate
from dalembert.notebook_display import Displayed
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.report.look import themed
from dalembert.report.notebook import Summary, shown_in_notebook
from dalembert.report.notebook.figure import figure_svg
from dalembert.structure import Material, lumped, plate
from dalembert.study import load
from dalembert.study.template import begin
from dalembert.uncertainty import propagate
from dalembert.vibration import FrictionContact, HarmonicBalance, HarmonicForce, VibrationSystem, frequency_response

TIMES = np.linspace(0.0, 2.0, 40)
SVG = "{http://www.w3.org/2000/svg}"


def decay():
    rate = Parameters((Parameter("rate", 0.5, 2.0, "1/s"),))
    return PythonModel(lambda rate: np.exp(-rate * TIMES), rate, ["x"], TIMES)


def pendulum():
    system = System()
    rod = system.add(RigidBar("rod", length=1.0, mass=1.0))
    system.add(RevoluteJoint("pin", system.ground, rod.start))
    return system


def rubbing():
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("foot", "m", friction=0.5, preload=1.0))
    return system


def fitted():
    return identify(decay(), Measurements(TIMES, ("x",), np.exp(-1.2 * TIMES)[:, None]))


SHOWN = {
    "a mechanism": (pendulum, ["Mechanism", "rod (RigidBar)", "pin (RevoluteJoint)", 'data-part="rod"']),
    "a motion": (lambda: simulate(pendulum(), end=0.2), ["Simulated motion", "largest energy error", "Energies"]),
    "a structure": (rubbing, ["Structure with forces and contacts", "foot (FrictionContact)", 'data-part="foot"']),
    "a mesh": (
        lambda: plate((0.4, 0.4), 2e-3, Material(210e9, 0.3, 7800.0), (4, 4)),
        ["Structure", "degrees of freedom", 'data-part="structure"'],
    ),
    "a curve": (
        lambda: frequency_response(rubbing(), np.array([0.1, 0.15, 0.2]), HarmonicBalance(harmonics=3)),
        ["Forced response", "computed", "frequency (Hz)"],
    ),
    "bounds": (lambda: propagate(decay(), {"rate": (0.9, 1.1)}), ["Bounds of the response", "runs of the model"]),
    "a fit": (fitted, ["Identified parameters", "rate (1/s)", "misfit", "x measured", "x computed"]),
}


@pytest.mark.parametrize("name", SHOWN)
def test_notebooks_show_verdict_key_values_and_a_figure(name):
    make, words = SHOWN[name]
    html = make()._repr_html_()
    assert [word for word in words if word not in html] == []
    assert ET.fromstring(html).tag == "div"
    assert html.count("<svg ") >= 1
    assert "<script" not in html
    assert len(html) < 80_000


def test_a_study_shows_its_picture_and_what_it_does(tmp_path):
    html = load(begin("identify", tmp_path / "mine"))._repr_html_()
    assert "Parameters from a measured motion" in html
    assert "it does" in html
    assert 'data-part="pin"' in html


def test_what_cannot_be_drawn_is_shown_as_plain_text():
    assert System()._repr_html_() is None


def test_texts_of_users_are_escaped():
    html = Summary("<b>", "<i>", "good", ["<u>"], {"<a>": "<c>"}).html()
    assert all(f"&lt;{letter}&gt;" in html for letter in "biuac")
    ET.fromstring(html)


def test_a_type_of_the_users_is_registered():
    @dataclass
    class Weather(Displayed):
        rain: float

    @shown_in_notebook.register
    def _(result: Weather) -> Summary:
        return Summary("Weather", facts={"rain": f"{result.rain} mm"})

    assert "2.0 mm" in Weather(2.0)._repr_html_()


def test_the_same_result_gives_the_same_html():
    assert fitted()._repr_html_() == fitted()._repr_html_()


def test_the_packages_of_reports_are_not_imported_before_something_is_shown():
    code = (
        "import sys; from dalembert.multibody import System, RigidBar; s = System(); s.add(RigidBar('a', 1.0, 1.0));"
        "assert not {'plotly', 'jinja2', 'nicegui', 'anywidget', 'IPython'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def lines(svg):
    """Points of all strokes within the axes."""
    paths = [one.get("d") for group in ET.fromstring(svg).iter(f"{SVG}g") for one in group.iter(f"{SVG}path")]
    return [np.array(re.findall(r"[ML]([-\d.e]+) ([-\d.e]+)", path), dtype=float) for path in paths]


def test_a_figure_has_its_lines_to_scale():
    figure = themed(
        go.Figure(go.Scatter(x=[0.0, 1.0, 2.0], y=[0.0, 2.0, 0.0])), "Title & more", x="time (s)", y="x (m)"
    )
    svg = figure_svg(figure)
    (points,) = lines(svg)
    assert points[1, 0] - points[0, 0] == pytest.approx(points[2, 0] - points[1, 0], abs=0.15)
    assert points[0, 1] == points[2, 1]
    assert points[1, 1] < points[0, 1]
    texts = [text.text for text in ET.fromstring(svg).iter(f"{SVG}text")]
    assert {"Title & more", "time (s)", "x (m)"} <= set(texts)


def test_logarithmic_axes_bands_gaps_and_markers_are_drawn():
    x = np.array([1.0, 10.0, 100.0])
    figure = go.Figure([
        go.Scatter(x=x, y=x, name="low", mode="lines"),
        go.Scatter(x=x, y=2 * x, name="high", fill="tonexty", mode="lines"),
        go.Scatter(x=x, y=[3.0, np.nan, 300.0], name="points", mode="markers"),
    ])  # fmt: skip
    svg = figure_svg(themed(figure, x={"type": "log"}, y={"type": "log"}))
    low, fill, high = lines(svg)[:3]
    assert low[1, 0] - low[0, 0] == pytest.approx(low[2, 0] - low[1, 0], abs=0.15)
    assert len(fill) == 6
    assert np.allclose(fill[:3], high)
    assert svg.count("<circle") == 2 + 1  # two points, and one in the legend


def test_long_records_are_thinned_without_losing_a_peak():
    y = np.zeros(100_000)
    y[54_321] = 1.0
    svg = figure_svg(themed(go.Figure(go.Scatter(x=np.arange(100_000), y=y))))
    assert len(svg) < 40_000
    (points,) = lines(svg)
    assert np.ptp(points[:, 1]) > 200


def test_figures_in_space_are_left_to_the_report():
    assert figure_svg(go.Figure(go.Scatter3d(x=[0.0], y=[0.0], z=[0.0]))) is None
    assert figure_svg(go.Figure()) is None


def test_findings_are_shown():
    class Doubtful(Displayed):
        pass

    @shown_in_notebook.register
    def _(result: Doubtful) -> Summary:
        return Summary("Doubtful", sentences=[str(Finding("x", "warning", {}, "A is wrong.", "Do B."))])

    assert "A is wrong. Do B." in Doubtful()._repr_html_()
