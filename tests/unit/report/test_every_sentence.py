"""Each figure and each sentence of reports and summaries is provoked by a small study: what none provokes is dead."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import fields
from inspect import signature
from pathlib import Path
from typing import Any

import pytest

import dalembert
from dalembert.inverse import Identifiability
from dalembert.report import report
from dalembert.report.options import ReportOptions
from pages import read_page
from report_cases import CASES

SOURCE = Path(dalembert.__file__).parent
SECTIONS = sorted(path.relative_to(SOURCE).as_posix() for path in (SOURCE / "report" / "sections").rglob("*.py"))
CHECKS = (
    "integrator_bias",
    "model_misfit",
    "noise_estimate",
    "parameter_drift",
    "record_mistakes",
    "residual_correlation",
    "search_end",
    "too_few_values",
    "unexplained_validation",
)
SOURCES = [
    "inverse/least_squares/descent.py",
    "inverse/least_squares/estimate.py",
    "inverse/problem/prior.py",
    "inverse/least_squares/identifiable.py",
    "inverse/diagnostics/findings.py",
    "inverse/fit/integration.py",
    "inverse/problem/search_findings.py",
    "inverse/plausibility/suspect_units.py",
    *(f"inverse/checks/{name}.py" for name in CHECKS),
    *(f"inverse/validation/{name}.py" for name in ("explained", "validation")),
    *(f"inverse/mistakes/{path.name}" for path in sorted((SOURCE / "inverse" / "mistakes").glob("*.py"))),
    *(f"inverse/misfit/{name}.py" for name in ("delays", "halves")),
    *(f"inverse/bands/{name}.py" for name in ("band_findings", "band_fit")),
    *(f"inverse/posterior/{name}.py" for name in ("convergence", "posterior_findings")),
    "inverse/sets/set_findings.py",
    "inverse/specimens/estimate_population.py",
    *(f"inverse/assessment/{name}.py" for name in ("coverage", "designs", "prediction", "profiles", "walk")),
    *(f"optimize/{name}.py" for name in ("least_squares", "response_sensitivity", "swarm")),
    *(
        f"uncertainty/{name}.py"
        for name in ("chebyshev", "comparison", "morris", "optimise", "propagate", "sobol", "taylor")
    ),
    *SECTIONS,
    "study/tasks/assessments.py",
]
GAP = ".{0,200}?"
#: Sentences that tests of these results provoke by the codes of their findings, or as texts.
ELSEWHERE = defaultdict(tuple)
ELSEWHERE["inverse/bands/band_fit.py"] = ("a single number (given)",)
ELSEWHERE["inverse/sets/set_findings.py"] = (
    "2 consistent runs lie outside of the set: the surrogate misses a component.",
    "Give a scheme with a smaller tolerance, or bounds close around the component.",
    " along 'p0', as at a kink or a step",
    "The coefficients do not decay along 'p0'.",
)
NO_SENTENCE = re.compile(r"dalembert \w+ \d+")  # the name of a file's format


def _pieces(node: ast.AST) -> str | None:
    """A text in the source as a pattern, anything in its gaps; None for something else."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return re.escape(node.value)
    if isinstance(node, ast.JoinedStr):
        return "".join(re.escape(part.value) if isinstance(part, ast.Constant) else GAP for part in node.values)
    return None


def _texts(node: ast.AST) -> Iterator[str]:
    """Patterns of the texts of some words below a node: no docstrings, and nothing of errors."""
    if isinstance(node, ast.Raise) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
        return
    if (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id.startswith(("expect", "require"))
    ):
        return
    pattern = _pieces(node)
    if pattern is None:
        for child in ast.iter_child_nodes(node):
            yield from _texts(child)
    elif pattern.count("\\ ") >= 2 and not NO_SENTENCE.fullmatch(pattern.replace("\\", "")):
        yield pattern


def _sentences() -> list[tuple[str, str]]:
    parsed = [(name, ast.parse((SOURCE / name).read_text(encoding="utf-8"))) for name in SOURCES]
    return [(name, pattern) for name, tree in parsed for pattern in _texts(tree)]


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    """Text and figures of a case by its name, each made once."""
    known: dict[str, tuple[str, set[str]]] = {}

    def of(name: str) -> tuple[str, set[str]]:
        if name not in known:
            known[name] = _told(CASES[name], tmp_path_factory.mktemp("case"))
        return known[name]

    return of


def _told(case: Any, folder: Path) -> tuple[str, set[str]]:
    made = case.make(folder) if "folder" in signature(case.make).parameters else case.make()
    result, options = made if isinstance(made, tuple) else (made, {})
    options = {**case.options, **options}
    if isinstance(result, str | Identifiability):
        return str(result), set()
    summaries = [getattr(one, "summary", "") for one in (result, *options.values())]
    named = {name: value for name, value in options.items() if name in {one.name for one in fields(ReportOptions)}}
    beside = [value for name, value in options.items() if name not in named]
    page = read_page(report(result, folder / "report.html", *beside, **named))
    tables = [value for tag, entries in page.tags if tag == "a" and (value := entries.get("download"))]
    cells = " ".join(cell for name in tables for row in page.table(name.removesuffix(".csv")) for cell in row)
    words = " ".join([*(one() if callable(one) else one for one in summaries), page.text, cells])
    drawn = {str(entries["data-name"]) for tag, entries in page.tags if tag == "script" and "data-name" in entries}
    return " ".join(words.split()), drawn


@pytest.mark.parametrize("name", CASES)
def test_a_study_provokes_its_sentences_and_figures(name, told):
    text, shown = told(name)
    for sentence in CASES[name].says:
        assert sentence in text
    assert set(CASES[name].shows) <= shown


def test_no_sentence_is_left_that_nothing_provokes(told):
    everything = "\n".join(told(name)[0] for name in CASES)
    dead = {(file, text) for file, text in _sentences() if not re.search(text.removeprefix(GAP), everything)}
    assert {(file, text) for file, text in dead if not any(re.search(text, said) for said in ELSEWHERE[file])} == set()


def test_no_figure_is_left_that_nothing_provokes(told):
    shown = {re.sub(r"(-\d+)+$", "", name) for case in CASES for name in told(case)[1]}
    drawn = {pattern.partition(GAP)[0].rstrip("-") for pattern in _plots()}
    assert drawn - {""} - shown == set()
    assert len(drawn) > 15


def _plots() -> Iterator[str]:
    """Patterns of the names of all figures of the report: the first argument of Plot(...), up to its first gap."""
    for path in sorted((SOURCE / "report").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Plot":
                yield (_pieces(node.args[0]) or "").replace("\\", "")
