"""The evidence fixture and the page made from it: a comparison that fails must fail, and the page must not flicker."""

import json
import runpy
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]
ROOT = Path(__file__).parents[2]
page = runpy.run_path(str(ROOT / "docs" / "validation.py"))["page"]

TEST = """
def test_rate(record_evidence):
    record_evidence("rate", 2.0, {ours}, tolerance=0.05, topic="Orders", source="theory")
    table = dict(topic="Orders", source="table", relative=True)
    record_evidence("curve", [1.0, 4.0], [1.0, 4.0 + 3e-6], tolerance=1e-5, **table)
    record_evidence("depth", 0.754, 0.6913, tolerance=None, topic="Orders", source="figure")
"""


def run(pytester: pytest.Pytester, ours: str) -> tuple[pytest.RunResult, list[dict]]:
    pytester.makeconftest((ROOT / "tests" / "conftest.py").read_text())
    pytester.makepyfile(TEST.format(ours=ours))
    result = pytester.runpytest("--evidence=out/evidence.json")
    return result, json.loads((pytester.path / "out" / "evidence.json").read_text())


def test_a_value_within_the_tolerance_becomes_a_row(pytester: pytest.Pytester) -> None:
    result, rows = run(pytester, "2.0123456")
    result.assert_outcomes(passed=1)
    text = page(rows)
    assert "| rate | 2 | 2.01 | ≤ 0.02 | 0.05 | theory |" in text
    assert "| curve | 2 values | as many | ≤ 1e-6 relative | 1e-5 relative | table |" in text
    assert "| depth | 0.754 | 0.691 | 0.063 |  | figure |" in text


@pytest.mark.parametrize("ours", ["2.06", "float('nan')", "[2.0]"])
def test_a_value_outside_the_tolerance_fails_the_test_and_is_no_row(pytester: pytest.Pytester, ours: str) -> None:
    result, rows = run(pytester, ours)
    result.assert_outcomes(failed=1)
    assert rows == []


def test_the_page_does_not_depend_on_the_order_of_the_tests_or_on_last_bits(pytester: pytest.Pytester) -> None:
    _, rows = run(pytester, "2.0123456")
    _, others = run(pytester, "2.0123456 + 4e-16")
    assert page(rows) == page(others[::-1])
