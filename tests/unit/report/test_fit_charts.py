from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.inverse import SearchIteration, StartEnd
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.report import charts
from dalembert.report.charts.identification.identifiability import combination
from dalembert.report.look import LIGHT
from stand_ins import fit
from support import says


def _named(figure):
    return {trace.name: trace for trace in figure.data}


def test_responses_data_and_residuals_are_the_numbers_given():
    result = fit()
    traces = _named(charts.responses(result))
    for column, name in enumerate(result.data.channels):
        np.testing.assert_array_equal(traces[f"{name} computed"].y, result.response[:, column])
        np.testing.assert_array_equal(traces[f"{name} measured"].y, result.data.values[:, column])
        np.testing.assert_array_equal(
            traces[f"{name} residual"].y, result.response[:, column] - result.data.values[:, column]
        )
        np.testing.assert_array_equal(traces[f"{name} measured"].x, result.data.coordinate.values)


def test_responses_have_units_and_two_deviations():
    figure = charts.responses(fit(), ["AB.end.y"])
    assert figure.layout.yaxis.title.text == "position (m)"
    assert figure.layout.yaxis2.title.text == "residual (m)"
    assert figure.layout.xaxis2.title.text == "time (s)"
    assert sorted(shape.y0 for shape in figure.layout.shapes) == [-0.01, 0.01]
    assert set(_named(figure)) == {"AB.end.y computed", "AB.end.y measured", "AB.end.y residual"}


def test_data_without_deviations_have_no_band():
    result = fit()
    result.data.deviations = None
    assert not charts.responses(result).layout.shapes


def test_an_unknown_channel_is_named_with_the_nearest():
    with pytest.raises(
        InputError, match=says("responses: unknown channel 'AB.end.z'; did you mean 'AB.end.y' or 'AB.end.x'?")
    ):
        charts.responses(fit(), ["AB.end.z"])


def test_convergence_draws_every_start_and_the_winner_last_in_colour():
    result = fit()
    figure = charts.convergence(result)
    assert figure.layout.yaxis.type == "log"
    drawn = [trace for trace in figure.data if trace.name.startswith("start")]
    assert len(drawn) == 6
    assert drawn[-1].name == "start 2, the best"
    assert drawn[-1].line.color == LIGHT.series[0]
    own = [step for step in result.history if step.start == 1]
    assert list(drawn[-1].x) == [step.iteration for step in own]
    assert list(drawn[-1].customdata) == [step.simulations for step in own]
    assert list(drawn[-1].y) == [step.best for step in own]


def test_a_misfit_of_zero_is_a_gap_and_not_an_error():
    result = fit(starts=1)
    for step in result.history:
        step.best = 0.0
    assert np.isnan(charts.convergence(result).data[-1].y).all()


def test_starts_are_sorted_by_where_they_end():
    result = fit()
    result.starts[5].misfit = float("nan")
    traces = _named(charts.starts(result))
    assert list(traces["converged"].x) == [1, 2, 4, 5, 6]
    assert list(traces["not converged"].x) == [3]
    assert list(traces["not converged"].y) == [1.9e-3]
    assert traces["not converged"].text == ("start 5: too many iterations",)
    first = next(step.best for step in result.history if step.start == 1)
    assert traces["at its start"].y[0] == first


def test_a_parameter_on_its_bound_is_marked():
    values = charts.parameters(fit()).data[-1]
    np.testing.assert_allclose(values.x, [(0.785312 - 0.6) / 0.4, 1.0])
    assert values.marker.symbol == ("circle", "diamond")
    assert values.text == ("0.78531 rad", "0.65000 rad")
    np.testing.assert_allclose(values.error_x.arrayminus, [2 * 2.1e-4 / 0.4, 2 * 3.3e-4 / 0.25])
    np.testing.assert_allclose(values.error_x.array, [2 * 2.1e-4 / 0.4, 0.0])


def test_a_parameter_whose_logarithm_is_searched_is_placed_by_it():
    result = fit()
    result.parameters = Parameters((Parameter("E", 1e6, 1e10), Parameter("d", 1e-12, 1.0)))
    result.values, result.deviations = np.array([1e8, 1e-9]), np.array([np.nan, 1.0])
    values = charts.parameters(result).data[-1]
    np.testing.assert_allclose(values.x, [0.5, 0.25])
    np.testing.assert_allclose(values.error_x.arrayminus, [0.0, 0.25])
    np.testing.assert_allclose(values.error_x.array, [0.0, 0.75])
    assert values.marker.symbol == ("circle", "circle")


def test_unknown_deviations_draw_no_bar():
    result = fit()
    result.deviations = np.array([np.nan, np.inf])
    values = charts.parameters(result).data[-1]
    assert list(values.error_x.array) == [0, 0]


def test_correlation_is_the_matrix_given():
    figure = charts.correlation(fit())
    np.testing.assert_array_equal(figure.data[0].z, [[1, -0.83], [-0.83, 1]])
    assert (figure.data[0].zmin, figure.data[0].zmax) == (-1, 1)
    assert [note.text for note in figure.layout.annotations] == ["1.00", "−0.83", "−0.83", "1.00"]


def test_an_unknown_correlation_is_a_dash():
    result = fit()
    result.correlation = np.full((2, 2), np.nan)
    assert {note.text for note in charts.correlation(result).layout.annotations} == {"–"}


def test_singular_values_stand_beside_their_combinations():
    figure = charts.singular_values(np.array([120.0, 0.0]), np.array([[0.8, 0.6], [-0.6, 0.8]]), ["a", "<b>"])
    assert figure.data[0].y == ("0.80 a + 0.60 &lt;b&gt;", "0.80 &lt;b&gt; − 0.60 a")
    assert figure.data[0].x[0] == 120
    assert np.isnan(figure.data[0].x[1])
    assert figure.data[0].text == ("120", "0")


def test_small_parts_of_a_combination_are_left_out():
    assert combination(np.array([0.01, 1.0]), ["a", "b"]) == "1.00 b"


def test_gaps_of_the_best_start_stand_over_its_misfit():
    step = partial(SearchIteration, values=np.zeros(2), samples=9)
    ends = [StartEnd(np.zeros(2), np.zeros(2), misfit, True, "", 9) for misfit in (5.0, 1.0)]
    history = [
        step(0, 0, 3, 9.0, gap=0.5),
        step(1, 0, 6, 8.0, gap=0.1),
        step(1, 1, 9, 2.0, gap=0.0),
        step(1, 2, 12, 1.0),
    ]
    figure = charts.gaps(SimpleNamespace(history=history, starts=ends))
    drawn = {trace.name: trace for trace in figure.data}
    np.testing.assert_array_equal(drawn["largest gap"].y, [0.1, np.nan])
    np.testing.assert_array_equal(drawn["misfit"].y, [8.0, 2.0])
    assert figure.layout.yaxis.title.text == "gap (part of the range)"
