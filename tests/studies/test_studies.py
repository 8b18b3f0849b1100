"""Each study in studies/ runs and gives the numbers that its expected.toml lists."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import BSpline

from dalembert.data import read_bands
from dalembert.study import Study, load, plan, run_study
from dalembert.study.tasks import TASKS, Outcome
from pages import read_page

STUDIES = Path(__file__).parents[2] / "studies"
EXPECTED = {
    path.parent / study: rows
    for path in sorted(STUDIES.glob("*/expected.toml"))
    for study, rows in tomllib.loads(path.read_text(encoding="utf-8")).items()
}
FILES = [
    path
    for path in sorted(STUDIES.glob("*/*.toml"))
    if TASKS.keys() & tomllib.loads(path.read_text(encoding="utf-8")).keys()
]


def name(path: Path) -> str:
    return path.relative_to(STUDIES).as_posix()


def found(study: Study, outcome: Outcome, row: dict[str, Any]) -> float:
    """The number that a row of expected.toml asks for."""
    quantity = row["quantity"]
    match study.task:
        case "identify" if "of" in row:
            population = getattr(outcome, "further_results")["population"]  # noqa: B009
            return float(getattr(population, quantity)[population.names.index(row["of"])])
        case "identify" if quantity.startswith("noise."):
            return getattr(outcome, "result").noise.estimates[quantity]  # noqa: B009
        case "identify" | "sample":
            values = outcome.best["values"]
            return outcome.best["misfit"] if quantity == "misfit" else values[quantity] / values.get(row.get("per"), 1)
        case "design" | "identify_inertias" | "exciting_trajectory" | "global_sensitivity" | "screening":
            return outcome.best["values"][quantity]
        case "identify_bands" if quantity == "simulations":
            return getattr(outcome, "result").simulations  # noqa: B009
        case "identify_bands" | "identify_set":
            return outcome.best[quantity] if quantity == "misfit" else outcome.best["values"][quantity]
        case "work_precision":
            runs: Any = getattr(outcome, "result").rows  # noqa: B009
            return next(run.error for run in runs if (run.method, run.settings) == (row["method"], row["settings"]))
        case "frequency_response" if quantity in ("fold", "torus", "branch point"):
            marked: Any = getattr(outcome, "result")  # noqa: B009
            places = [marked.frequencies[point] for kind, point in marked.markers if kind == quantity]
            return float(places[row["number"]])
        case "frequency_response" if "amplitude" in row:
            curve: Any = getattr(outcome, "result")  # noqa: B009
            point = int(np.argmin(np.abs(curve.frequencies - row["at"])))
            assert curve.frequencies[point] == pytest.approx(row["at"], abs=1e-9)
            return float(curve.amplitude(quantity, row["amplitude"])[point])
        case "frequency_response" if quantity == "largest difference in time":
            return float(np.abs(getattr(outcome, "further_results")["time_comparison"].differences).max())  # noqa: B009
        case "frequency_response" | "backbone" | "track_resonance" | "static_contact":
            return outcome.best["values"][quantity]
        case "regularise" if quantity == "rms of history":
            truth = np.loadtxt(study.path.parent / row["table"], delimiter=",", skiprows=1)
            return history_error(getattr(outcome, "result").values, truth)  # noqa: B009
        case "regularise":
            return outcome.best["values"][quantity]
        case "propagate":
            return bounded(study, getattr(outcome, "result"), row)  # noqa: B009
        case "simulate":
            trajectory: Any = outcome.result
            sample = int(np.argmin(np.abs(trajectory.times - row["at"])))
            assert trajectory.times[sample] == pytest.approx(row["at"], abs=1e-9)
            return float(trajectory.channels([quantity])[sample, 0])
        case "campbell" if "at" in row:
            diagram: Any = outcome.result
            return float(diagram.frequencies[np.argmin(np.abs(diagram.values - row["at"])), int(quantity[-1]) - 1])
        case "equilibrium_path" if "at" in row:
            path: Any = outcome.result
            number = list(outcome.best["values"]).index(row["at"])
            return float(path.critical_values[number, path.names.index(quantity)])
        case "campbell" | "equilibrium_path":
            return outcome.best["values"][quantity]
        case "sweep":
            curve = next(curve for curve in outcome.result.curves if curve.parameter == row["along"])
            sample = int(np.argmin(np.abs(curve.values - row["at"])))
            assert curve.values[sample] == pytest.approx(row["at"], abs=1e-9)
            return float(curve.responses[sample, curve.channels.index(quantity)])
    raise AssertionError(study.task)


def history_error(coefficients: np.ndarray, truth: np.ndarray) -> float:
    """Rms difference of a history from 0 to 2 s from a table of times and values, without its ends."""
    knots = (np.arange(len(coefficients) + 4) - 3) * 2.0 / (len(coefficients) - 3)
    error = BSpline(knots, coefficients, 3)(truth[:, 0]) - truth[:, 1]
    return float(np.sqrt(np.mean(error[10:-10] ** 2)))


def bounded(study: Study, result: Any, row: dict[str, Any]) -> float:
    """Rms difference of the bounds from a table, the number of runs, or the largest error of a compared method."""
    match row["quantity"]:
        case "rms":
            columns = {"AB.end.x": ("x_lower", "x_upper"), "AB.end.y": ("y_lower", "y_upper")}
            table = read_bands(study.path.parent / row["table"], columns=columns)
            return float(np.sqrt(np.mean([(result.lower - table.lower) ** 2, (result.upper - table.upper) ** 2])))
        case "runs":
            return result.runs
        case "lower" | "upper" as side:
            sample = int(np.argmin(np.abs(result.coordinate.values - row["at"])))
            assert result.coordinate.values[sample] == pytest.approx(row["at"], abs=1e-9)
            return float(getattr(result, side)[sample, 0])
        case "largest error":
            return next(line.largest for line in result.rows if line.method == row["method"])
    raise AssertionError(row)


@pytest.mark.parametrize(
    "path",
    [pytest.param(p, marks=pytest.mark.slow) if p.parent.name == "patched-plate" else p for p in FILES],  # a large mesh
    ids=name,
)
def test_study_is_in_order(path):
    assert "simulation" in plan(load(path))


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(p, marks=pytest.mark.slow) if any(r.get("slow") for r in rows) else p
        for p, rows in EXPECTED.items()
    ],
    ids=name,
)
def test_study_gives_what_is_expected(path, tmp_path):
    study = load(path)
    folder, outcome = run_study(study, tmp_path / "run")
    assert outcome.success, outcome.status
    assert folder.report.stat().st_size > 10_000
    for row in EXPECTED[path]:
        if "says" in row:
            page = read_page(folder.report).text
            assert all(sentence in outcome.summary and sentence in page for sentence in row["says"])
            continue
        assert found(study, outcome, row) == pytest.approx(row["value"], abs=row["tolerance"]), row


def test_every_study_has_expected_numbers_and_a_readme():
    assert set(FILES) == set(EXPECTED)
    assert all((path.parent / "README.md").is_file() for path in FILES)
