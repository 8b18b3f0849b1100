"""Sections of the user's: beside a result of the package, and for a kind of result of their own."""

from dataclasses import dataclass, field
from pathlib import Path

import plotly.graph_objects as go
import pytest
from inline_snapshot import snapshot

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.report import ReportSection, Table, cell, figures, report, sections_of
from dalembert.results import Result
from pages import read_page
from refusals import refused
from stand_ins import fit, motion


@dataclass(frozen=True)
class Weather:
    """A result that the package does not know."""

    rain: float
    findings: tuple[Finding, ...] = ()
    provenance: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Storm(Weather):
    """A kind of it, which has the same sections."""


@sections_of(Weather)
def weather(result, asked):
    rows = [(cell("rain"), cell(result.rain))]
    table = Table("rain", "Rain", ("quantity", "mm"), rows)
    figure = go.Figure(go.Scatter(y=[0.0, result.rain]), layout={"title": {"text": "Rain over time"}})
    return [ReportSection("Weather", (f"{result.rain} mm of rain.",), {"Each point is an hour.": figure}, (table,))]


def test_a_section_of_the_users_stands_in_the_report_of_a_fit(tmp_path: Path) -> None:
    own = ReportSection(
        "Temperatures", ("The laboratory had 21 °C.",), {"By a thermometer.": go.Figure(go.Scatter(y=[21, 22]))}
    )
    page = read_page(report(fit(), tmp_path / "fit.html", motion(), own))
    assert "The laboratory had 21 °C." in page.text
    assert "By a thermometer." in page.text
    assert list(figures(fit(), own))[-1] == "temperatures-1"


@pytest.mark.parametrize("kind", [Weather, Storm])
def test_a_kind_of_result_of_the_users_has_its_sections(kind: type[Weather], tmp_path: Path) -> None:
    doubt = Finding("wet", "warning", {"rain": 3.5}, "It was wet.", "Wait for the sun.")
    path = report(kind(3.5, (doubt,), {"station": "Berlin"}), tmp_path / "weather.html", title="Rain in Berlin")
    page = read_page(path)
    assert "Rain in Berlin" in page.text
    assert "3.5 mm of rain." in page.text
    assert "It was wet." in page.text
    assert list(figures(kind(3.5))) == ["weather-1"]


def test_what_no_section_shows_is_refused(tmp_path: Path) -> None:
    with refused(
        InputError,
        snapshot(
            "report: a object was given; expected a result, such as identify(), simulate() or propagate() return. For a class of your own, register its sections first by dalembert.report.sections_of"
        ),
    ):
        report(object(), tmp_path / "a.html")
    with refused(
        InputError,
        snapshot(
            "report: 3 was given beside the result; expected a trajectory, profiles, a population, a prediction, a comparison in time, a backbone, a deformation, reduction errors, or a section"
        ),
    ):
        report(fit(), tmp_path / "a.html", 3)
    with refused(InputError, snapshot("report: unknown option 'tittle'; did you mean 'title'?")):
        report(fit(), tmp_path / "a.html", tittle="Pendulum")
    assert not list(tmp_path.iterdir())


class Rain(Result):
    """A result that defines its facts and tables alone."""

    FORMAT = "rain 1"
    TITLE = "Rain"
    VERDICTS = ("measured", "not measured")
    status = "It rained on one day of two."

    def facts(self) -> dict[str, str]:
        return {"days": "2"}

    def tables(self) -> tuple[Table, ...]:
        return (Table.of("days", "Rain of the days", {"day": ["Monday", "Tuesday"], "rain (mm)": [0.0, 3.5]}),)


def test_a_result_with_facts_and_tables_has_a_report_a_summary_and_a_picture_in_notebooks(tmp_path: Path) -> None:
    page = read_page(report(Rain(), tmp_path / "rain.html"))
    assert page.table("days") == [["day", "rain (mm)"], ["Monday", "0.0"], ["Tuesday", "3.5"]]
    for text in ("Rain", "measured", "It rained on one day of two.", "days", "Rain of the days"):
        assert text in page.text
    assert Rain().summary() == snapshot("""\
day      rain (mm)
──────────────────
Monday   0
Tuesday  3.5

days  2

It rained on one day of two.\
""")
    shown = Rain()._repr_html_()
    assert shown is not None
    assert "It rained on one day of two." in shown
