from dataclasses import replace

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.motion.equilibria import runs
from report_cases import CASES
from stand_ins import motion, sweep


def _named(figure):
    return {trace.name: trace for trace in figure.data}


def test_energies_are_the_numbers_given():
    trajectory = motion()
    traces = _named(charts.energies(trajectory))
    for name in ("kinetic", "potential", "total", "balance"):
        np.testing.assert_array_equal(traces[name].y, trajectory.energies[name])
        np.testing.assert_array_equal(traces[name].x, trajectory.times)
    np.testing.assert_array_equal(traces["work done on it"].y, trajectory.energies["work"])
    assert traces["balance"].yaxis == "y2"


def test_a_long_run_keeps_its_largest_violation():
    trajectory = motion(samples=100_001)
    trajectory.violations["position"][54_321] = 1e-5
    figure = charts.violations(trajectory)
    traces = _named(figure)
    assert figure.layout.yaxis.type == "log"
    assert np.nanmax(traces["position (m)"].y) == 1e-5
    assert len(traces["position (m)"].y) <= 200  # a point is the largest of 500 samples: noise does not fill it
    assert set(traces) == {"position (m)", "velocity (m/s)", "acceleration (m/s²)"}


def test_newton_iterations_of_each_step():
    counts = np.array([3, 2, 7, 2])
    figure = charts.newton(replace(motion(), newton_iterations=counts))
    assert list(figure.data[0].x) == [1, 2, 3, 4]
    assert list(figure.data[0].y) == [3, 2, 7, 2]


def test_newton_iterations_of_a_long_run_keep_the_most():
    counts = np.full(40_000, 3)
    counts[12_345] = 9
    traces = _named(charts.newton(replace(motion(), newton_iterations=counts)))
    most = np.array(traces["most in 100 steps"].y)
    assert len(most) == 400
    assert most.max() == 9
    assert traces["most in 100 steps"].x[int(most.argmax())] == 12_301
    assert max(traces["mean"].y) == 3.06


def test_a_sweep_draws_responses_and_slopes():
    first, second = sweep().curves
    figure = charts.sweep(first, "time 0.5 s")
    np.testing.assert_array_equal(figure.data[0].y, first.responses[:, 0])
    np.testing.assert_array_equal(figure.data[1].y, first.sensitivities[:, 0])
    assert figure.layout.title.text == "Response along theta1 at time 0.5 s"
    assert figure.layout.xaxis2.title.text == "theta1 (rad)"
    assert figure.layout.yaxis2.title.text == "derivative (m/rad)"
    assert len(charts.sweep(second).data) == 2


def test_the_unit_of_a_channel_is_given_where_its_name_does_not_tell_it():
    curve = sweep().curves[0]
    curve.channels, curve.units = ("gauge 1", "gauge 2"), ("V", "V")
    figure = charts.sweep(curve)
    assert figure.layout.yaxis.title.text == "response (V)"
    assert figure.layout.yaxis2.title.text == "derivative (V/rad)"


def test_a_path_has_solid_and_dashed_lines_and_its_critical_points():
    path = CASES["a path of equilibria"].make()
    figure = charts.equilibrium_path(path)
    *lines, points = figure.data
    assert [trace.line.dash for trace in lines] == ["solid", "dash", "solid"]
    assert [trace.showlegend for trace in lines] == [True, False, False]
    assert (points.name, points.mode) == ("limit point", "markers")
    np.testing.assert_allclose(points.x, [point.load for point in path.critical])
    np.testing.assert_allclose(points.y, path.critical_values[:, 0])
    assert lines[0].x[-1] == lines[1].x[0] == points.x[0]
    assert figure.layout.xaxis.title.text == "push (N)"
    assert figure.layout.yaxis.title.text == "position (m)"


def test_the_film_of_a_path_stops_at_its_critical_points():
    scene = charts.equilibria(CASES["a path of equilibria"].make()).scene
    assert scene.film.labels[0] == "0 N, stable"
    assert scene.film.labels[-1] == "8 N, stable"
    assert "3.82988 N, limit point" in scene.film.labels
    assert any(label.endswith("unstable") for label in scene.film.labels)
    assert len(scene.film.labels) == len(scene.times)


def test_runs_of_stable_and_unstable_segments():
    assert runs(np.array([False])) == [(0, 1)]
    assert runs(np.array([True, False, False])) == [(0, 1), (1, 3)]
