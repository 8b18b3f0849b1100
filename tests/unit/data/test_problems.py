"""Problems of columns, found before a fit."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dalembert.data.guesses import Unit
from dalembert.data.preview import Preview, PreviewColumn
from dalembert.data.problems import Use, outliers, problems

TIMES = np.arange(200) / 100
WAVE = 0.3 * np.cos(5 * TIMES)
USE = Use("t", channels={"rod.angle": ("a", "rad")})


def found(values=WAVE, times=TIMES, **column):
    columns = (
        PreviewColumn("t", "", np.asarray(times, dtype=float)),
        PreviewColumn("a", "", np.asarray(values), **column),
    )
    return Preview(Path("own.csv"), "csv", columns, ())


def codes(data, use=USE):
    return [finding.code for finding in problems(data, use)]


def spiked(*places):
    values = WAVE.copy()
    values[list(places)] += 2.0
    return values


CASES = {
    "uneven-line": replace(found(), uneven=(7, 3)),
    "no-number": found(wrong=(3, "oops")),
    "missing-values": found(missing=4),
    "times-not-growing": found(times=np.r_[TIMES[:100], TIMES[99:-1]]),
    "late-times": found(times=TIMES + 1.5),
    "time-gaps": found(times=np.where(TIMES > 1, TIMES + 0.5, TIMES)),
    "constant-column": found(np.full(200, 2.0)),
    "suspect-degrees": found(40 * WAVE / 0.3),
    "angle-jumps": found((20 * TIMES + np.pi) % (2 * np.pi) - np.pi),
    "outliers": found(spiked(20, 90)),
}


@pytest.mark.parametrize("code", CASES)
def test_a_problem_is_found_by_itself(code):
    assert codes(CASES[code]) == [code]
    (finding,) = problems(CASES[code], USE)
    assert finding.message[-1] == finding.advice[-1] == "."


@pytest.mark.parametrize(("unit", "code"), [("wombat", "unknown-unit"), ("mm", "wrong-unit"), ("Degree", None)])
def test_a_unit_is_known_and_measures_what_the_channel_does(unit, code):
    use = replace(USE, units={"a": Unit(unit, "file")})
    listed = problems(found(), use)
    assert [(one.code, one.values["unit"]) for one in listed] == ([(code, unit)] if code else [])
    times = replace(USE, units={"t": Unit(unit, "file")})
    assert [one.code for one in problems(found(), times) if one.severity == "error"] == [code or "wrong-unit"]


def test_good_data_have_no_problems():
    rough = WAVE + 0.02 * np.random.default_rng(1).normal(size=200)
    for values in (WAVE, rough, np.round(WAVE, 2), np.sign(WAVE), np.exp(-9 * TIMES) * np.cos(300 * TIMES)):
        assert codes(found(values)) == []


def test_columns_that_are_not_used_have_no_problems():
    assert codes(found(wrong=(3, "oops")), Use("t")) == []


def test_choices_put_problems_right():
    assert codes(CASES["missing-values"], replace(USE, missing="leave-out")) == []
    assert codes(CASES["angle-jumps"], replace(USE, wraps=("rod.angle",))) == []
    assert codes(CASES["suspect-degrees"], replace(USE, units={"a": Unit("deg", "")})) == []
    (note,) = problems(CASES["late-times"], replace(USE, start="first"))
    assert (note.severity, note.advice) == ("note", "")


def test_samples_before_the_start_are_named_with_what_to_keep():
    late = replace(USE, start=0.5)
    (finding,) = problems(found(), late)
    assert (finding.code, finding.values["samples"]) == ("samples-before-start", 50)
    assert finding.values["last"] == pytest.approx(1.49)
    assert codes(found(), replace(late, between=(0.0, 1.49))) == []


def test_a_guessed_unit_of_times_is_said():
    use = replace(USE, units={"t": Unit("ms", "steps")}, start="first")
    (finding,) = [one for one in problems(found(times=1000 * TIMES), use) if one.code == "guessed-time-unit"]
    assert finding.values == {"column": "t", "unit": "ms", "step": pytest.approx(0.01), "duration": pytest.approx(1.99)}
    assert "100 samples a second, 1.99 s in all" in finding.message


def test_many_samples_are_to_be_decimated():
    times = np.arange(50_000) * 1e-4
    (finding,) = problems(found(np.cos(5 * times), times), USE)
    assert (finding.code, finding.values["factor"], finding.values["even"]) == ("many-samples", 10, True)
    assert codes(found(np.cos(5 * times), times), replace(USE, decimate=10)) == []


def test_errors_come_first():
    data = found(spiked(20), times=TIMES + 1, missing=2)
    assert codes(data) == ["missing-values", "late-times", "outliers"]


def test_outliers_of_two_samples_are_found_and_edges_are_none():
    assert outliers(spiked(50, 51)).tolist() == [50, 51]
    assert len(outliers(np.where(TIMES > 1, 1.0, 0.0))) == 0
    assert len(outliers(spiked(2)[:20])) == 0
