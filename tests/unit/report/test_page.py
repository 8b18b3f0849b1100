import base64
import gzip
import hashlib
import json
import re

import numpy as np
import pytest
from inline_snapshot import snapshot
from plotly.offline import get_plotlyjs

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.inverse import Identifiability
from dalembert.report import figures, report
from dalembert.tables import Table, cell
from pages import Page, read_page
from refusals import refused
from stand_ins import fit, motion, sweep
from support import says

NASTY = "<script>alert(1)</script>"


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Report of a fit with all that it can hold."""
    result = fit()
    path = tmp_path_factory.mktemp("report") / "new" / "fit.html"
    return report(result, path, motion(), title="Pendulum", notes="A note.", study="[model]\nlength = 1")


def test_sections_stand_in_reading_order(whole):
    page = read_page(whole)
    anchors = [attrs["id"] for tag, attrs in page.tags if tag in ("section", "header")]
    assert anchors == [
        "result",
        "parameters",
        "response-and-data",
        "mechanism",
        "search",
        "identifiability",
        "diagnostics-of-the-simulation",
        "provenance",
    ]
    linked = [attrs["href"] for tag, attrs in page.tags if tag == "a" and attrs["href"].startswith("#")]
    assert {f"#{anchor}" for anchor in anchors} == set(linked)


def test_the_page_says_the_numbers_and_the_advice(whole):
    text = read_page(whole).text
    for words in (
        "Pendulum",
        "identified",
        "0.78531 ± 0.00021",
        "Widen the bounds of theta2.",
        "A note.",
        "5 of 6",
        "least squares, 6 starts",
        "length = 1",
        "played in real time",
    ):
        assert words in text


def test_tables_download_with_all_their_digits(whole):
    page = read_page(whole)
    rows = page.table("parameters")
    assert rows[1] == ["theta1", "0.785312", "0.00021", "rad", "0.6", "1.0", ""]
    assert rows[2][-1] == "on its bound"
    samples = np.array(page.table("responses")[1:], dtype=float)
    result = fit()
    np.testing.assert_array_equal(samples[:, 1::2], result.data.values)
    np.testing.assert_array_equal(samples[:, 2::2], result.response)
    assert ["seed", "0"] in page.table("provenance")
    assert ["method.starts", "6"] in page.table("provenance")
    assert page.table("starts")[3][:4] == ["5", "0.0019", "9", "not converged"]
    assert float(page.table("diagnostics")[1][1]) == np.abs(motion().energies["balance"]).max()


def test_the_page_loads_nothing_from_elsewhere(whole):
    page = read_page(whole)
    assert page.addresses
    assert all(address.startswith(("#", "data:text/csv")) for address in page.addresses)
    assert not {tag for tag, _ in page.tags} & {"link", "iframe", "img", "object", "embed", "base", "form"}
    own = whole.read_text().replace("http://www.w3.org/2000/svg", "")  # a name
    assert not re.search(r"https?://|@import|url\(|\bfetch\(|XMLHttpRequest|\bimport\(|WebSocket", own)


def test_the_library_is_packed_and_every_script_is_allowed_by_its_hash(whole):
    page = Page(whole.read_text())
    (packed,) = (data for attrs, data in page.scripts if attrs.get("id") == "plotly")
    library = gzip.decompress(base64.b64decode(packed)).decode()
    assert library == get_plotlyjs()
    policy = next(attrs["content"] for tag, attrs in page.tags if attrs.get("http-equiv") == "Content-Security-Policy")
    assert policy.startswith("default-src 'none';")
    (script,) = (data for attrs, data in page.scripts if attrs.get("type") == "module")
    run = [library, script]
    hashes = [base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in run]
    assert re.findall(r"'sha256-([^']+)'", policy) == hashes
    assert "unsafe-inline" not in policy.partition("script-src")[2].partition(";")[0]


def test_every_figure_is_in_the_page_with_its_numbers(whole):
    page = read_page(whole)
    drawn = {attrs["data-name"]: json.loads(data) for attrs, data in page.scripts if "data-name" in attrs}
    assert list(drawn) == [
        "parameters",
        "responses-1",
        "mechanism",
        "convergence",
        "starts",
        "correlation",
        "singular-values",
        "energies",
        "violations",
        "newton",
    ]
    assert set(drawn) == set(figures(fit(), motion()))
    places = {attrs["id"] for tag, attrs in page.tags if attrs.get("class") in ("canvas", "dalembert-film")}
    assert places == {f"figure-{name}" for name in drawn}
    packed = next(trace["y"] for trace in drawn["responses-1"]["data"] if trace["name"] == "AB.end.x computed")
    values = np.frombuffer(base64.b64decode(packed["bdata"]), dtype=packed["dtype"])
    np.testing.assert_array_equal(values, fit().response[:, 0])
    assert "updatemenus" not in drawn["energies"]["layout"]
    assert drawn["mechanism"]["seconds"] == 2.0


def test_the_page_stays_small(whole):
    assert whole.stat().st_size < 2_500_000


def test_names_with_markup_are_shown_as_they_stand(tmp_path):
    result = fit(names=(NASTY, "b"), channels=(f"{NASTY}.x", f"{NASTY}.y"))
    result.status = result.method = NASTY
    result.provenance = {NASTY: NASTY}
    result.starts[0].message = NASTY
    finding = Finding("unidentifiable", "warning", {}, NASTY)
    result.identifiability = lambda: Identifiability(np.ones(2), np.eye(2), (finding,))
    trajectory = motion()
    trajectory.extra[NASTY] = trajectory.drawing().lines["AB"]
    path = report(result, tmp_path / "a.html", trajectory, title=NASTY, notes=[NASTY], study=NASTY, points=["AB.end"])
    text = path.read_text()
    assert "<script>alert" not in text
    page = Page(text)
    assert page.text.count(NASTY) >= 10
    for attrs, data in page.scripts:
        if attrs.get("class") == "figure":
            assert "<script" not in json.dumps(json.loads(data))


def test_a_spreadsheet_does_not_run_a_name_as_a_formula():
    table = Table("t", "", ("a", "b"), [(cell("=1+1"), cell(-1.5))])
    assert table.csv == "a,b\n'=1+1,-1.5\n"


def test_a_trajectory_alone_has_its_report(tmp_path):
    path = report(motion(), tmp_path / "motion.html")
    text = read_page(path).text
    assert "Simulated motion" in text
    assert "The energy balance is kept to" in text
    names = list(figures(motion()))
    assert names == ["mechanism", "energies", "violations", "newton"]
    paths = [shape.name for shape in figures(motion())["mechanism"].scene.primitives if shape.role == "path"]
    assert paths == ["AB's end"]
    assert "Path: AB's end." in text


def test_a_fit_without_motion_and_history(tmp_path):
    result = fit()
    result.history, result.starts = (), result.starts[:1]
    names = figures(result)
    assert list(names) == ["parameters", "responses-1", "correlation", "singular-values"]
    assert report(result, tmp_path / "a.html").exists()


def test_a_fit_that_failed_says_so(tmp_path):
    result = fit()
    result.success, result.status = False, "No start converged; give more iterations."
    page = read_page(report(result, tmp_path / "a.html"))
    assert "! not identified" in page.text
    assert any(attrs.get("class") == "verdict bad" for _, attrs in page.tags)


def test_a_fit_that_ended_well_without_doubts_is_identified(tmp_path):
    page = read_page(report(fit(), tmp_path / "a.html"))
    assert "✓ identified" in page.text
    assert "with doubts" not in page.text
    assert any(attrs.get("class") == "verdict good" for _, attrs in page.tags)


def test_doubts_stand_beside_the_verdict(tmp_path):
    result = fit()
    messages = ("'theta2' is at its upper bound 0.65.", "The residuals are <correlated>.")
    result.doubts = tuple(Finding("doubt", "warning", {}, message) for message in messages)
    page = read_page(report(result, tmp_path / "a.html"))
    assert "? identified, with doubts" in page.text
    assert all(doubt.message in page.text for doubt in result.doubts)
    assert any(attrs.get("class") == "verdict doubtful" for _, attrs in page.tags)
    result.success = False
    page = read_page(report(result, tmp_path / "a.html"))
    assert "! not identified" in page.text
    assert not any(attrs.get("class") == "doubts" for _, attrs in page.tags)


def test_residuals_have_the_units_of_their_channels_where_names_tell_them(tmp_path):
    rows = read_page(report(fit(), tmp_path / "a.html")).table("residuals")
    assert [row[-1] for row in rows] == ["unit", "m", "m"]
    rows = read_page(report(fit(channels=("gauge 1", "gauge 2")), tmp_path / "a.html")).table("residuals")
    assert rows[0][-1] == "deviation of the data"


def test_a_sweep_has_its_report(tmp_path):
    page = read_page(report(sweep(), tmp_path / "sweep.html", title="Sensitivity"))
    assert page.table("sweep-1")[0] == [
        "theta1 (rad)",
        "AB.end.x",
        "AB.end.y",
        "d AB.end.x / d theta1",
        "d AB.end.y / d theta1",
    ]
    assert len(page.table("sweep-2")) == 22
    assert list(figures(sweep())) == ["sweep-1", "sweep-2"]


def test_a_sweep_with_gaps_says_so(tmp_path):
    gaps = sweep()
    gaps.success, gaps.status = False, "42 points; 1 of them failed."
    gaps.curves[0].responses[3] = np.nan
    text = read_page(report(gaps, tmp_path / "sweep.html")).text
    assert "! incomplete" in text
    assert "1 of them failed." in text


def test_a_start_that_failed_and_a_swarm_that_scattered_itself_have_their_rows(tmp_path):
    result = fit()
    result.starts[2].misfit, result.starts[2].success = float("inf"), False
    result.starts[2].start = np.full(2, np.nan)
    rows = read_page(report(result, tmp_path / "a.html")).table("starts")
    assert rows[-1][:4] == ["3", "inf", "9", "not converged"]


def test_notes_in_one_text_are_parted_by_empty_lines(tmp_path):
    text = report(motion(), tmp_path / "a.html", notes="One.\n\nTwo & three.").read_text()
    assert re.findall(r'<p class="note">(.*)</p>', text) == ["One.", "Two &amp; three."]
    assert 'class="note"' not in report(motion(), tmp_path / "b.html", notes="").read_text()


def test_something_else_is_refused(tmp_path):
    with refused(
        InputError,
        snapshot(
            "report: a dict was given; expected a result, such as identify(), simulate() or propagate() return. For a "
            "class of your own, register its sections first by dalembert.report.sections_of"
        ),
    ):
        report({}, tmp_path / "a.html")


def test_a_report_that_cannot_be_written_leaves_the_old_one(tmp_path, monkeypatch):
    path = report(motion(), tmp_path / "a.html")
    before = path.read_bytes()

    def full(*_):
        raise OSError("the disk is full")

    monkeypatch.setattr("pathlib.Path.replace", full)
    with pytest.raises(OSError, match=says("the disk is full")):
        report(sweep(), path)
    assert path.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.html"]


def test_the_same_result_gives_the_same_bytes(tmp_path):
    pages = [report(fit(), tmp_path / name, motion()).read_bytes() for name in ("a.html", "b.html")]
    assert pages[0] == pages[1]
