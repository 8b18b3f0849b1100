"""Reports on intervals: bounds, methods compared, intervals from bands, consistent sets."""

import numpy as np
import pytest
from markupsafe import escape

from dalembert.forward import PythonModel
from dalembert.parameter import Parameter
from dalembert.report import figures, report
from dalembert.uncertainty import Propagation, global_sensitivity, propagate
from pages import read_page
from stand_ins import band_fit, comparison, parameter_set, propagation


def _anchors(page):
    return [attrs["id"] for tag, attrs in page.tags if tag in ("section", "header")]


def test_bounds_have_their_report(tmp_path):
    result = propagation()
    page = read_page(report(result, tmp_path / "a.html", title="Pendulum", study="[propagate]"))
    assert _anchors(page) == ["result", "bounds", "provenance"]
    for words in ("Pendulum", "✓ bounded", "the surrogate is wrong by 2.5e-06 at most", "estimate", "2.5 × 10⁻⁶", "81"):
        assert words in page.text
    assert page.table("box")[1:] == [
        ["theta1", "0.746", "0.825", "0.7855", repr((0.825 - 0.746) / 2)],
        ["theta2", "0.497", "0.55", repr((0.497 + 0.55) / 2), repr((0.55 - 0.497) / 2)],
    ]
    x = page.table("widths")[1]
    assert float(x[1]) == np.max(result.upper - result.lower)
    assert (float(x[2]), float(x[4])) == (2.0, 2.5e-6)
    assert float(x[5]) == 20 / 41  # of the samples, at both bounds
    assert x[6] == "m"
    samples = np.array(page.table("bounds")[1:], dtype=float)
    np.testing.assert_array_equal(samples[:, 1::2], result.lower)
    np.testing.assert_array_equal(samples[:, 2::2], result.upper)
    assert list(figures(result)) == ["bands-1"]


def test_intervals_have_the_units_of_their_parameters(tmp_path):
    angle = Parameter("angle", -1.0, 2.0, unit="rad")
    model = PythonModel(lambda angle, ratio: np.array([angle * ratio]), [angle, Parameter("ratio", 0, 1)], ["y"], [0.0])
    result = propagate(model, {"angle": (-1.0, 2.0), "ratio": (0.0, 1.0)}, "vertex")
    result.save(tmp_path / "a.nc")
    for one in (result, Propagation.load(tmp_path / "a.nc")):
        table = read_page(report(one, tmp_path / "a.html")).table("box")
        assert [row[table[0].index("unit")] for row in table[1:]] == ["rad", ""]
    indices = global_sensitivity(model)
    table = read_page(report(indices, tmp_path / "a.html")).table("box")
    assert [row[table[0].index("unit")] for row in table[1:]] == ["rad", ""]


def test_bounds_of_a_method_that_knows_no_places_have_none(tmp_path):
    result = propagation("scan", "inner bound")
    result.at_lower = result.at_upper = None
    page = read_page(report(result, tmp_path / "a.html"))
    assert page.table("widths")[0][3:] == ["mean width", "estimated error", "unit"]


def test_an_unknown_error_is_shown_with_its_reason(tmp_path):
    model = PythonModel(lambda x: np.array([x**2]), {"x": (-1.0, 2.0)}, ["y"], [0.0])
    result = propagate(model, {"x": (-1.0, 2.0)}, method="scan")
    assert result.error is None
    page = read_page(report(result, tmp_path / "a.html"))
    widths = page.table("widths")
    assert widths[1][widths[0].index("estimated error")] == "unknown"
    assert "largest estimated error unknown" in " ".join(page.text.split())
    reason = next(item.message for item in result.findings if item.code == "unknown-error")
    bounds = (tmp_path / "a.html").read_text(encoding="utf-8").split('id="bounds"')[1]
    assert str(escape(reason)) in bounds


def test_bounds_that_could_not_be_found_say_so(tmp_path):
    result = propagation()
    result.success, result.status = False, "3 of 81 runs failed; look at the first."
    page = read_page(report(result, tmp_path / "a.html"))
    assert "! not bounded" in page.text
    assert "3 of 81 runs failed; look at the first." in page.text


def test_methods_compared_have_their_report(tmp_path):
    page = read_page(report(comparison(), tmp_path / "a.html"))
    assert _anchors(page) == ["result", "methods", "bounds"]
    rows = page.table("methods")
    assert [row[0] for row in rows[1:]] == ["optimise", "vertex", "scan", "bernstein"]
    assert rows[1][3:] == ["nan", "nan", "81", "2.25", "the reference"]
    np.testing.assert_allclose([float(entry) for entry in rows[3][3:5]], [4e-4, 4e-4])
    assert rows[3][1] == "inner bound"
    assert "Each is measured by its distance from optimise." in page.text
    assert list(figures(comparison())) == ["methods", "differences", "bands-1"]


def test_a_method_that_failed_is_marked(tmp_path):
    compared = comparison()
    compared.success, compared.status = False, "vertex did not succeed."
    compared.results[1].success, compared.results[1].status = False, "One corner failed."
    page = read_page(report(compared, tmp_path / "a.html"))
    assert "! incomplete" in page.text
    assert "vertex did not succeed." in page.text
    assert page.table("methods")[2][-1] == "One corner failed."


def test_a_method_that_gave_no_bounds_says_why(tmp_path):
    compared = comparison()
    compared.refused = (("taylor", "The model gives no sensitivities."),)
    page = read_page(report(compared, tmp_path / "a.html"))
    assert page.table("methods")[-1] == ["taylor", "none", *["nan"] * 5, "The model gives no sensitivities."]


@pytest.fixture(scope="module")
def intervals(tmp_path_factory):
    result = band_fit()
    truth = {"theta1": (0.746, 0.825)}
    return read_page(report(result, tmp_path_factory.mktemp("report") / "a.html", truth=truth))


def test_intervals_from_bands_have_their_report(intervals):
    sections = ["result", "parameters", "bands", "search", "identifiability", "provenance"]
    assert _anchors(intervals) == sections
    for words in ("✓ identified", "[0.7461, 0.8247]", "3.4 × 10⁻⁵", "global surrogate", "0.78540", "93"):
        assert words in intervals.text
    rows = intervals.table("intervals")
    assert rows[1] == [
        "theta1",
        "0.7461",
        "0.8247",
        "0.746",
        "0.825",
        "0.7854",
        "0.0003",
        "0.0393",
        "0.0004",
        "rad",
        "0.6",
        "1.0",
        "",
    ]
    assert rows[2][-1] == "a single number"
    assert rows[2][3:5] == ["nan", "nan"]
    assert intervals.table("starts")[0][5:] == [
        f"{name} {part} at end" for part in ("middle", "radius") for name in ("theta1", "theta2")
    ]


def test_a_radius_within_its_deviation_is_marked(tmp_path):
    result = band_fit()
    result.radius, result.radius_deviations = np.array([0.0393, 3e-5]), np.array([4e-4, 2e-5])
    rows = read_page(report(result, tmp_path / "a.html")).table("intervals")
    assert [row[-1] for row in rows[1:]] == ["", "possibly a single number"]


def test_residuals_of_the_bands_are_those_of_the_true_runs(intervals):
    fit = band_fit()
    rows = intervals.table("band-residuals")
    residual = (fit.checked_lower - fit.bands.lower)[:, 0]
    assert rows[1][:2] == ["AB.end.x", "lower"]
    assert (rows[0][-1], rows[1][-1]) == ("unit", "m")
    np.testing.assert_allclose(float(rows[1][2]), np.sqrt(np.mean(residual**2)))
    np.testing.assert_allclose(float(rows[1][3]), np.abs(residual).max())
    samples = np.array(intervals.table("bands")[1:], dtype=float)
    np.testing.assert_array_equal(samples[:, 1::4], fit.bands.lower)
    np.testing.assert_array_equal(samples[:, 4::4], fit.checked_upper)


def test_figures_of_intervals():
    names = ["intervals", "residual-bands-1", "convergence", "starts", "correlation", "singular-values"]
    assert list(figures(band_fit())) == names
    heat = figures(band_fit())["correlation"].data[0]
    assert heat.x == ("theta1 middle", "theta2 middle", "theta1 radius", "theta2 radius")


def test_intervals_without_true_ones_true_runs_and_history(tmp_path):
    result = band_fit()
    result.history, result.checked_misfit = (), None
    page = read_page(report(result, tmp_path / "a.html"))
    assert "true lower" not in page.table("intervals")[0]
    assert "misfit by true runs" not in page.text
    assert "search" not in _anchors(page)


def test_a_consistent_set_has_its_report(tmp_path):
    page = read_page(report(parameter_set(), tmp_path / "a.html", truth={"theta1": 0.7, "theta2": 0.8}))
    assert _anchors(page) == ["result", "consistent-set", "provenance"]
    assert "✓ found" in page.text
    assert "in [0.6, 0.9]" in page.text
    assert page.table("outer-box")[1][:3] == ["theta1", "0.6", "0.9"]
    assert page.table("inner-box")[2][:3] == ["theta2", "0.66", "0.84"]
    assert list(figures(parameter_set(("a", "b", "c")))) == ["paving-1", "paving-2", "paving-3"]


def test_the_part_that_the_set_is_of_what_was_searched(tmp_path):
    found = parameter_set()
    found.volume = (0.25 * 0.1, 0.25 * 0.2)
    assert "part of what was searched 10 to 20 %" in read_page(report(found, tmp_path / "a.html")).text


def test_an_empty_set_says_so(tmp_path):
    found = parameter_set()
    found.inside, found.boundary, found.outer, found.inner = found.inside[:0], found.boundary[:0], None, None
    found.volume, found.status = (0.0, 0.0), "No parameters explain all data."
    page = read_page(report(found, tmp_path / "a.html"))
    assert "! empty" in page.text
    assert "No parameters explain all data." in page.text


def test_a_long_value_of_the_provenance_is_whole_in_the_csv(tmp_path):
    found = parameter_set()
    found.provenance = {"error": [0.002] * 100}
    page = read_page(report(found, tmp_path / "a.html"))
    whole = ", ".join(["0.002"] * 100)
    assert whole not in page.text
    assert whole[:200] + " …" in page.text
    assert page.table("provenance")[1] == ["error", whole]


@pytest.mark.parametrize("make", [propagation, comparison, band_fit, parameter_set])
def test_the_same_result_gives_the_same_bytes(make, tmp_path):
    pages = [report(make(), tmp_path / name).read_bytes() for name in ("a.html", "b.html")]
    assert pages[0] == pages[1]


def test_names_with_markup_are_shown_as_they_stand(tmp_path):
    nasty = "<script>alert(1)</script>"
    for result in (band_fit((nasty, "b")), parameter_set((nasty, "b"))):
        path = report(result, tmp_path / "a.html")
        assert nasty not in path.read_text()
        assert nasty in read_page(path).text
