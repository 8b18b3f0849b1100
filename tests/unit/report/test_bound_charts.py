import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.report import charts
from dalembert.report.charts.identification.intervals import end_deviations
from dalembert.report.charts.identification.paving import planes, rectangles
from stand_ins import band_fit, box, comparison, parameter_set, propagation
from support import says


def _named(figure):
    return {trace.name: trace for trace in figure.data}


def test_bands_are_the_bounds_given_and_their_width():
    result = propagation()
    traces = _named(charts.bands(result))
    for column, name in enumerate(result.channels):
        np.testing.assert_array_equal(traces[f"{name}, lower"].y, result.lower[:, column])
        np.testing.assert_array_equal(traces[f"{name}, upper"].y, result.upper[:, column])
        np.testing.assert_array_equal(traces[f"{name}, width"].y, (result.upper - result.lower)[:, column])
        inside = np.concatenate([result.lower[:, column], result.upper[::-1, column], result.lower[:1, column]])
        np.testing.assert_array_equal(traces[name].y, inside)
        assert traces[name].fill == "toself"


def test_bands_have_names_and_units():
    figure = charts.bands(propagation(), ["AB.end.y"])
    assert figure.layout.yaxis.title.text == "position (m)"
    assert figure.layout.yaxis2.title.text == "width (m)"
    assert figure.layout.xaxis2.title.text == "time (s)"
    assert set(_named(figure)) == {"AB.end.y", "AB.end.y, lower", "AB.end.y, upper", "AB.end.y, width"}


@pytest.mark.parametrize("chart", ["bands", "residual_bands"])
def test_an_unknown_channel_is_named_with_the_nearest(chart):
    given = propagation() if chart == "bands" else band_fit()
    message = f"{chart}: unknown channel 'AB.end.z'; did you mean 'AB.end.y' or 'AB.end.x'?"
    with pytest.raises(InputError, match=says(message)):
        getattr(charts, chart)(given, ["AB.end.z"])


def test_residuals_are_those_of_the_true_runs():
    fit = band_fit()
    traces = _named(charts.residual_bands(fit))
    for column, name in enumerate(fit.bands.channels):
        np.testing.assert_array_equal(traces[f"{name} reproduced, lower"].y, fit.checked_lower[:, column])
        residual = fit.checked_upper[:, column] - fit.bands.upper[:, column]
        np.testing.assert_array_equal(traces[f"{name} residual, upper"].y, residual)
        np.testing.assert_array_equal(traces[f"{name}, lower"].y, fit.bands.lower[:, column])


def test_without_true_runs_residuals_are_those_of_the_surrogate():
    fit = band_fit()
    fit.checked_lower = fit.checked_upper = None
    traces = _named(charts.residual_bands(fit))
    np.testing.assert_array_equal(traces["AB.end.x residual, lower"].y, (fit.lower - fit.bands.lower)[:, 0])


def test_intervals_lie_between_the_search_bounds_beside_the_true_ones():
    traces = [trace for trace in charts.intervals(band_fit(), {"theta1": (0.75, 0.825)}).data if trace.name]
    bars = [trace for trace in traces if trace.name == "identified"]
    np.testing.assert_allclose(bars[0].x, [(0.7461 - 0.6) / 0.4, (0.7854 - 0.6) / 0.4, (0.8247 - 0.6) / 0.4])
    np.testing.assert_allclose(bars[1].x, [(0.52 - 0.4) / 0.25] * 3)
    assert [bar.text[1] for bar in bars] == ["[0.7461, 0.8247] rad", "0.52 rad"]
    np.testing.assert_allclose(traces[-1].x, [0.375, 0.5625])
    assert traces[-1].y == ("theta1", "theta1")


def test_truth_that_is_not_known_is_not_drawn():
    diamonds = charts.intervals(band_fit()).data[-1]
    assert len(diamonds.x) == 0
    assert diamonds.showlegend is False


def test_the_ends_of_an_interval_are_known_as_well_as_middle_and_radius_together():
    """Var(m ± r) = Var(m) + Var(r) ± 2 Cov(m, r)."""
    one, two = end_deviations(band_fit())
    np.testing.assert_allclose(one, np.sqrt([9e-8 + 16e-8 + 12e-8, 9e-8 + 16e-8 - 12e-8]))
    np.testing.assert_allclose(two, np.sqrt([5e-8, 5e-8]))


def test_a_fixed_parameter_is_known_as_well_as_its_middle():
    fit = band_fit()
    fit.unknowns = ("theta1 middle", "theta2 middle", "theta1 radius")
    fit.radius_deviations = np.array([4e-4, 0.0])
    np.testing.assert_allclose(end_deviations(fit)[1], [2e-4, 2e-4])


def test_methods_stand_at_their_error_and_their_runs():
    traces = _named(charts.methods(comparison()))
    np.testing.assert_array_equal(traces["inner bound"].x, [4, 441])
    np.testing.assert_allclose(traces["inner bound"].y, [3e-3, 4e-4])
    np.testing.assert_allclose(traces["enclosure of the surrogate"].y, [2e-5])
    assert traces["inner bound"].text == ("vertex", "scan")
    assert len(traces["estimate"].x) == 0


def test_bounds_like_the_reference_have_no_place_on_a_logarithmic_axis():
    like = comparison()
    like.rows[1].largest, like.results[1].lower, like.results[1].upper = (
        0.0,
        like.results[0].lower,
        like.results[0].upper,
    )
    assert np.isnan(_named(charts.methods(like))["inner bound"].y[0])
    assert np.isnan(_named(charts.differences(like))["vertex"].y).all()


def test_a_channel_whose_name_tells_no_unit_has_that_of_the_model():
    given = propagation()
    given.channels, given.units = ("gauge 1", "gauge 2"), ("V", "V")
    assert charts.bands(given).layout.yaxis.title.text == "response (V)"


def test_differences_are_the_largest_of_all_channels_at_each_sample():
    compared = comparison()
    compared.results[1].lower[7, 1] -= 0.5
    traces = _named(charts.differences(compared))
    assert set(traces) == {"vertex", "scan", "bernstein"}
    expected = np.full(41, 3e-3)
    expected[7] = 0.5 - 3e-3
    np.testing.assert_allclose(traces["vertex"].y, expected)


def test_the_paving_is_the_boxes_given():
    found = parameter_set()
    traces = _named(charts.paving(found, truth={"theta1": 0.7, "theta2": 0.8}))
    x, y = rectangles(found.inside)
    np.testing.assert_array_equal(traces["consistent boxes"].x, x)
    np.testing.assert_array_equal(traces["consistent boxes"].y, y)
    assert len(traces["undecided boxes"].x) == 6 * len(found.boundary)
    np.testing.assert_array_equal(traces["outer box"].x[:5], [0.6, 0.9, 0.9, 0.6, 0.6])
    assert (traces["true"].x, traces["true"].y) == ((0.7,), (0.8,))


def test_a_paving_of_three_parameters_is_projected_each_place_once():
    found = parameter_set(("a", "b", "c"))
    traces = _named(charts.paving(found, ("c", "a")))
    x = rectangles(found.inside[:, :, [2, 0]])[0]
    np.testing.assert_array_equal(traces["consistent, projected"].x, x)
    assert len(x) < 6 * len(found.inside)
    assert charts.paving(found, ("c", "a")).layout.yaxis.title.text == "a (rad)"


def test_one_parameter_is_a_strip():
    figure = charts.paving(parameter_set(("a",), 40), truth={"a": 0.7})
    assert figure.layout.yaxis.visible is False
    assert (_named(figure)["true"].x, _named(figure)["true"].y) == ((0.7,), (0.5,))


def test_an_empty_set_is_drawn_on_all_that_was_searched():
    found = parameter_set()
    found.inside, found.boundary, found.outer, found.inner = found.inside[:0], found.boundary[:0], None, None
    figure = charts.paving(found)
    np.testing.assert_allclose(figure.layout.xaxis.range, [0.5 - 0.04, 1.0 + 0.04])
    assert not any(trace.showlegend is not False for trace in figure.data)


def test_a_plane_of_an_unknown_parameter_is_refused():
    with pytest.raises(
        InputError, match=says("paving: unknown parameter 'theta3'; did you mean 'theta2' or 'theta1'?")
    ):
        charts.paving(parameter_set(), ("theta1", "theta3"))


def test_planes_are_not_too_many():
    assert len(planes("abcdefg")) == 6


def test_a_set_that_is_one_point_has_a_range():
    found = parameter_set()
    found.parameters = Parameters((Parameter("theta1", 0.5, 1.0), Parameter("theta2", 0.5, 1.0)))
    found.outer = box(theta1=(0.7, 0.7), theta2=(0.8, 0.8))
    low, high = charts.paving(found).layout.xaxis.range
    assert low < 0.7 < high
