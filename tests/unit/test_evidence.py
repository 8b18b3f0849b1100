"""The evidence fixture and the pages made from it: a difference beyond the tolerance fails, and pages are repeatable."""

import json
import runpy
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]
ROOT = Path(__file__).parents[2]
pages = runpy.run_path(str(ROOT / "docs" / "validation.py"))["pages"]

TEST = """
def test_rate(record_evidence):
    record_evidence("rate", 2.0, {ours}, tolerance=0.05, topic="Convergence", kind="published", source="theory")
    table = dict(topic="Convergence", source="table", kind="published")
    record_evidence("curve", [1.0, 4.0], [1.0, 4.0 + 3e-6], tolerance=1e-5, relative=True, **table)
    record_evidence("load", 80.0, 75.0, tolerance=10.0, unit="N", **table)
    record_evidence("|gap|", 0.0, 2e-6, tolerance=1e-4, **table)
    record_evidence("drift", 0.0, 3e-16, tolerance=1e-12, noisy=True, **table)
    record_evidence("depth", 0.754, 0.6913, tolerance=None, topic="Structures", kind="closed form", source="closed form")
"""


def run(pytester: pytest.Pytester, ours: str) -> tuple[pytest.RunResult, list[dict]]:
    pytester.makeconftest((ROOT / "tests" / "conftest.py").read_text())
    pytester.makepyfile(TEST.format(ours=ours))
    result = pytester.runpytest("--evidence=out/evidence.json")
    return result, json.loads((pytester.path / "out" / "evidence.json").read_text())


def test_a_value_within_the_tolerance_becomes_a_row(pytester: pytest.Pytester) -> None:
    result, rows = run(pytester, "2.0123456")
    result.assert_outcomes(passed=1)
    written = pages(rows)
    integrators = written["validation/integrators.md"]
    assert "| rate | 2 | 2.01 | ≤ 0.02 | 0.05 | published: theory |" in integrators
    assert "| curve | 4 (largest of 2) | 4 | ≤ 1e-6 relative | 1e-5 relative | published: table |" in integrators
    assert "| load [N] | 80 | 75 | ≤ 5 | 10 | published: table |" in integrators
    assert r"| \|gap\| | 0 | ≤ 2e-6 | ≤ 2e-6 | 0.0001 | published: table |" in integrators
    assert "| drift | 0 | ≤ 1e-12 | ≤ 1e-12 | 1e-12 | published: table |" in integrators
    assert "**5 comparisons: 5 within their tolerance.** By reference: 5 published." in integrators
    vibration = written["validation/vibration.md"]
    assert "| depth | 0.754 | 0.691 | 0.063 |  | closed form |" in vibration
    assert "**1 comparison: 0 within their tolerance, 1 for information.**" in vibration
    assert "| [Integrators](validation/integrators.md) | 5 |" in written["validation.md"]


def test_a_topic_without_an_area_is_an_error(pytester: pytest.Pytester) -> None:
    _, rows = run(pytester, "2.0")
    with pytest.raises(ValueError, match="AREAS"):
        pages([*rows, {**rows[0], "topic": "Tides"}])


def test_an_unknown_kind_of_reference_fails_the_test(pytester: pytest.Pytester) -> None:
    pytester.makeconftest((ROOT / "tests" / "conftest.py").read_text())
    pytester.makepyfile(TEST.format(ours="2.0").replace('kind="closed form"', 'kind="hearsay"'))
    pytester.runpytest().assert_outcomes(failed=1)


@pytest.mark.parametrize("ours", ["2.06", "float('nan')", "[2.0]"])
def test_a_value_outside_the_tolerance_fails_the_test_and_is_no_row(pytester: pytest.Pytester, ours: str) -> None:
    result, rows = run(pytester, ours)
    result.assert_outcomes(failed=1)
    assert rows == []


def test_the_page_does_not_depend_on_the_order_of_the_tests_or_on_last_bits(pytester: pytest.Pytester) -> None:
    _, rows = run(pytester, "2.0123456")
    _, others = run(pytester, "2.0123456 + 4e-16")
    assert pages(rows) == pages(others[::-1])
