"""Reports on mechanisms in space."""

import numpy as np
import pytest
from dalembert.report.charts.motion.playback import Playback

import dalembert as da
from dalembert.errors import InputError
from dalembert.multibody.spatial import Shape
from dalembert.report import charts, figures, report
from dalembert.report.section import Plot
from spatial_pendulum import SOLVER, TRUE, build, motion, records, response


@pytest.fixture(scope="module")
def trajectory():
    return motion(samples=2001)


def _traces(figure):
    return {trace.name: trace for trace in figure.data}


def test_each_frame_holds_the_drawing_at_its_time(trajectory):
    drawing = trajectory.drawing()
    figure = charts.mechanism(drawing)
    names = [trace.name for trace in figure.data]
    assert _traces(figure)["one"].type == "mesh3d"
    assert _traces(figure)["two"].type == "scatter3d"
    for frame, at in zip(figure.frames, Playback.of(drawing.times).frames, strict=True):
        drawn = dict(zip((names[place] for place in frame.traces), frame.data, strict=True))
        corners = drawing.axes["one"][at, 0] + drawing.surfaces["one"].corners @ drawing.axes["one"][at, 1:]
        np.testing.assert_allclose(np.column_stack([drawn["one"][axis] for axis in "xyz"]), corners, atol=1e-6)
        tip = trajectory.channels(["two.tip.x", "two.tip.y", "two.tip.z"])[at]
        np.testing.assert_allclose([drawn["two"][axis][-1] for axis in "xyz"], tip, atol=1e-6)
        np.testing.assert_allclose([drawn["joints"][axis][0] for axis in "xyz"], drawing.joints["hinge"][at], atol=1e-6)
        begin, end = (np.array([drawn["z axis"][axis][k] for axis in "xyz"]) for k in (0, 1))
        np.testing.assert_allclose((end - begin) / np.linalg.norm(end - begin), drawing.axes["one"][at, 3], atol=1e-5)


def test_axes_are_equal_and_hold_the_whole_motion(trajectory):
    path = np.array([[-5.0, 0.0, 1.0], [0.0, 4.0, 3.0]])
    scene = charts.mechanism(trajectory.drawing(), paths={"P": path}).layout.scene
    lengths = [np.ptp(scene[f"{axis}axis"].range) / scene.aspectratio[axis] for axis in "xyz"]
    np.testing.assert_allclose(lengths, lengths[0], rtol=1e-12)
    assert scene.aspectmode == "manual"
    for axis, values in zip("xyz", path.T, strict=True):
        low, high = scene[f"{axis}axis"].range
        assert low < values.min()
        assert values.max() < high


def test_ground_and_moving_joints_differ(trajectory):
    traces = _traces(charts.mechanism(trajectory.drawing()))
    assert traces["fixed to ground"].text == ("ball",)
    assert traces["joints"].text == ("hinge",)


def test_a_report_on_a_motion_draws_the_path_of_the_last_point(trajectory, tmp_path):
    made = figures(trajectory)
    assert list(made) == ["mechanism", "energies", "violations", "newton"]
    path = _traces(made["mechanism"])["path of two.tip"]
    np.testing.assert_allclose(path.z, trajectory.channels(["two.tip.z"])[:, 0][: len(path.z)], atol=1e-6)
    named = _traces(figures(trajectory, points=["one.low"])["mechanism"])["path of one.low"]
    np.testing.assert_allclose(named.y, trajectory.channels(["one.low.y"])[:, 0], atol=1e-6)
    page = report(trajectory, tmp_path / "motion.html").read_text()
    assert "Drag to turn" in page
    with pytest.raises(InputError, match=r"unknown channel 'two\.top\.x'; did you mean 'two\.tip\.x'"):
        figures(trajectory, points=["two.top"])


def test_a_report_on_an_identification_draws_what_was_measured(tmp_path):
    data = records()
    fit = da.identify(response(), data, starts=1, start=TRUE * 1.05)
    found = da.simulate(build(*fit.values), 1.0, SOLVER)
    made = figures(fit, found)
    traces = _traces(made["mechanism"])
    crosses = np.column_stack([traces["two.tip measured"][axis] for axis in "xyz"])
    np.testing.assert_array_equal(crosses, data.values[:, :3].astype(np.float32))
    assert {"path of two.tip", "path of one.low", "one.low measured"} <= set(traces)
    labels = [made[name].layout.yaxis.title.text for name in made if name.startswith("responses")]
    assert set(labels) == {"position (m)"}
    report(fit, tmp_path / "fit.html", found)


def test_a_large_mechanism_makes_a_bounded_file(trajectory):
    drawing = trajectory.drawing()
    for number in range(300):
        drawing.lines[f"body {number}"] = drawing.lines["two"] + 0.01 * number
        drawing.axes[f"body {number}"] = drawing.axes["two"]
    figure = charts.mechanism(drawing)
    assert "301 bodies" in _traces(figure)
    assert len(Plot("mechanism", figure).json) < 3_000_000
    for number in range(300):
        drawing.surfaces[f"body {number}"] = drawing.surfaces["one"]
    figure = charts.mechanism(drawing)  # too many corners: lines
    assert {trace.type for trace in figure.data} == {"scatter3d"}
    assert len(Plot("mechanism", figure).json) < 3_000_000
    drawing.surfaces.clear()
    drawing.surfaces.update({f"body {number}": Shape.box((0.1, 0.1, 0.1)).surface for number in range(8)})
    traces = _traces(charts.mechanism(drawing))
    assert traces["8 bodies with shapes"].type == "mesh3d"
    assert len(traces["8 bodies with shapes"].x) == 64
    assert "294 bodies" in traces


def test_a_motionless_mechanism_is_drawn():
    drawing = da.equilibrium(build(2.0, 0.4, 0.0)).drawing()
    figure = charts.mechanism(drawing)
    assert len(figure.frames) == 1
