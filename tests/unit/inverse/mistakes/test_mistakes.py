"""Mistakes in records are named by the finding on them, and right records have none."""

import json

import numpy as np
import pytest

import dalembert as da
from dalembert.inverse.mistakes.patterns import runs
from record_mistakes import CODES, LATE, RATE, TABLE, TIMES, codes, fitted, plain

LINES = {
    "sign": "[sensors] 'y' = { gain = [-1, -1] }",
    "swap": "swap the columns of 'x' and 'y' in columns",
    "late": "write start = 0.",
    "rate": "divide the times by 1.0",
    "clipped": "Measure with a larger range",
}
TABLES = json.loads(TABLE.read_text(encoding="utf-8"))


def named(fit: da.Fit, code: str) -> da.Finding:
    (finding,) = [finding for finding in fit.findings if finding.code == code]
    return finding


@pytest.mark.parametrize("kind", CODES)
def test_each_mistake_is_named(kind: str) -> None:
    """Seed 1: the second channel has the mistake, the clock is late and fast."""
    fit = fitted("function", kind, 0.8, 1)
    finding = named(fit, CODES[kind])
    assert finding.severity == "warning"
    assert finding.values["explained"] == pytest.approx(0.8, abs=0.08)
    expected = {
        "sign": {"channel": "y"},
        "swap": {"channel": "x", "other": "y", "experiment": ""},
        "late": {"record": "", "delay": pytest.approx(LATE, abs=0.02)},
        "rate": {"record": "", "error": pytest.approx(RATE, abs=0.003)},
        "clipped": {"channel": "y"},
        "zeros": {"channel": "y"},
        "repeated": {"channel": "y"},
    }[kind]
    assert {key: finding.values[key] for key in expected} == expected
    assert LINES.get(kind, "Leave") in finding.advice
    assert {found.code for found in fit.findings} & set(CODES.values()) == {CODES[kind]}


def test_the_experiment_with_a_wrong_sign_is_named() -> None:
    """The key `[sensors]` of study files is for all experiments."""
    finding = named(fitted("function, two experiments", "sign", 0.9, 1), "suspect-sign")
    assert finding.values["channel"] == "run0.y"
    assert finding.values["experiment"] == "run0"
    assert "negate the values of 'y' in the data of experiment 'run0'" in finding.advice
    assert "[sensors]" not in finding.advice


def test_the_experiment_with_a_late_clock_is_named() -> None:
    finding = named(fitted("function, two experiments", "late", 0.9, 1), "suspect-clock")
    assert finding.values["record"] == "run0"
    assert finding.values["delay"] == pytest.approx(LATE, abs=0.02)
    assert "in the table of experiment 'run0'" in finding.advice


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["sign", "late"])
def test_the_experiment_of_a_mechanism_with_the_mistake_is_named(kind: str) -> None:
    finding = named(fitted("pendulum, two experiments", kind, 0.9, 1), CODES[kind])
    assert finding.values.get("record", "run0") == "run0"
    assert finding.values.get("channel", "run0.bar.end.y") == "run0.bar.end.y"


@pytest.mark.parametrize("kind", ["sign", "late", "rate", "clipped", "repeated"])
def test_some_values_of_a_long_record_rank_its_mistakes(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The ranking by 60 of 202 values leads to the same finding."""
    whole = named(fitted("function", kind, 0.9, 1), CODES[kind])
    monkeypatch.setattr("dalembert.inverse.mistakes.record.RANKED", 60)
    by_some = named(fitted("function", kind, 0.9, 1), CODES[kind])
    for key, value in whole.values.items():
        assert by_some.values[key] == (value if isinstance(value, str) else pytest.approx(value, rel=1e-3))


@pytest.mark.parametrize("name", ["function", "function, estimated noise"])
@pytest.mark.parametrize("seed", range(4))
def test_right_records_have_no_mistakes(name: str, seed: int) -> None:
    assert codes(name, "right", 0.3, seed) == []


def test_a_mistake_is_named_beside_estimated_noise() -> None:
    assert "suspect-swap" in codes("function, estimated noise", "swap", 0.9, 0)


def test_the_line_for_a_wrong_sign_works() -> None:
    values = fitted("function", "sign", 0.99, 1).data.values
    seen = da.Sensors(plain(), {"y": da.Sensor(gain=(-1, -1))})
    fit = da.identify(seen, da.Measurements.of(TIMES, dict(zip("xy", values.T, strict=True))))
    assert fit.estimates["size"] == pytest.approx(1.0, abs=0.05)
    assert not {finding.code for finding in fit.findings} & set(CODES.values())


def test_runs_of_equal_values() -> None:
    assert runs(np.array([0.0, 0.0, 1.0, 0.0])).tolist() == [0, 0, 2, 3]


@pytest.mark.parametrize("name", TABLES)
def test_the_table_of_seeds(name: str) -> None:
    """The repetitions of ``python tests/record_mistakes.py``."""
    for kind, row in TABLES[name].items():
        if kind == "right":
            assert row["seeds"] >= 400
            assert row["flagged"] <= 8
        else:
            assert row["named"] >= 0.9 * row["seeds"]
            assert row["seeds"] >= 100
