"""Blocks of sections, and whose sections a result has."""

from dataclasses import dataclass, replace
from pathlib import Path

import plotly.graph_objects as go
import pytest

from dalembert.multibody import Trajectory
from dalembert.report import ReportSection, Table, figures, report, sections_of
from dalembert.report.page import environment
from dalembert.report.registry import _SECTIONS
from dalembert.report.section import Download, Listed, Plot, Row, Section, Source
from pages import Page, read_page
from stand_ins import motion, stand_in

ROWS = Table.of("rows", "Rows", {"number": range(5), "square": [number**2 for number in range(5)]})


def rendered(*blocks):
    return Page(str(Section("Blocks", blocks).html(environment())))


def test_blocks_stand_in_their_order():
    page = rendered("First.", Plot("curve", go.Figure(), "A curve."), ROWS, Listed(["a", "b"]), Source("Text", "x < 1"))
    order = [page.text.index(word) for word in ("First.", "A curve.", "Rows", "a", "Text")]
    assert order[:3] == sorted(order[:3])
    assert page.table("rows")[-1] == ["4", "16"]
    assert "x < 1" in page.text


def test_empty_blocks_leave_nothing():
    page = rendered("", Row([]), Listed([]), Download(None, "Download"))
    assert [tag for tag, _ in page.tags] == ["section", "h2"]


@pytest.mark.parametrize(("count", "folded"), [(20, False), (21, True)])
def test_a_long_table_is_folded(count, folded):
    page = rendered(Table.of("rows", "Rows", {"number": range(count)}))
    assert (f"Rows: {count} rows" in page.text) is folded


def test_plots_are_those_of_all_blocks():
    one, two = Plot("one", go.Figure()), Plot("two", go.Figure())
    assert Section("Plots", ("Text.", one, ROWS, Row([two]))).plots == [one, two]


def test_sections_of_a_user_replace_those_of_the_package(tmp_path: Path, monkeypatch):
    trajectory = motion()
    assert "mechanism" in figures(trajectory)  # imports the sections before the registry is replaced
    monkeypatch.setattr("dalembert.report.registry._SECTIONS", dict(_SECTIONS))
    sections_of(Trajectory)(lambda result, asked: [ReportSection("Mine", ("As I like it.",))])
    assert "As I like it." in read_page(report(replace(trajectory), tmp_path / "a.html")).text
    assert figures(trajectory) == {}


def test_a_class_of_a_layer_above_is_known_by_its_name(monkeypatch):
    monkeypatch.setattr("dalembert.report.registry._SECTIONS", dict(_SECTIONS))

    @dataclass(frozen=True)
    class Tide:
        height: float = 2.0

    sections_of(f"{Tide.__module__}.{Tide.__qualname__}")(
        lambda result, asked: [ReportSection("Tide", (), {"How high.": go.Figure(go.Bar(y=[result.height]))})]
    )
    assert list(figures(Tide())) == list(figures(stand_in(Tide, height=3.0))) == ["tide-1"]
