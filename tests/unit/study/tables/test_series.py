"""Series of parameters in study files, and the task that identifies them."""

import shutil
from pathlib import Path

import pytest
from inline_snapshot import snapshot

from dalembert.errors import InputError
from dalembert.study import load
from refusals import refused

STUDY = Path(__file__).parents[4] / "studies" / "unknown-load"
PUSH = 'push = { count = 100, lower = -10.0, upper = 10.0, unit = "N" }'


@pytest.fixture
def changed(tmp_path):
    """Loads the study of an unknown load with a part of its text replaced."""
    shutil.copy(STUDY / "motion.csv", tmp_path)

    def load_with(before: str, after: str):
        text = (STUDY / "identify.toml").read_text(encoding="utf-8")
        assert before in text
        (tmp_path / "study.toml").write_text(text.replace(before, after), encoding="utf-8")
        return load(tmp_path / "study.toml")

    return load_with


def test_a_series_is_as_many_parameters(changed) -> None:
    study = changed("count = 100", "count = 6")
    assert study.parameters.names == tuple(f"push_{k}" for k in range(1, 7))
    assert {item.unit for item in study.parameters} == {"N"}
    force = study.system(study.parameters.vector({name: k for k, name in enumerate(study.parameters.names)}))
    (load_,) = force.loads
    assert list(load_.x.coefficients) == [0, 1, 2, 3, 4, 5]


@pytest.mark.parametrize(
    ("before", "after", "sentence"),
    [
        ("count = 100", "count = 1", snapshot("""\
study.toml: [parameters.push], count: 1 was given; expected a number of at least 2
study.toml: [[model.load]] 'hand', x, coefficients: 'push' was given; expected a list of numbers, or the name of a series: a parameter with count\
""")),
        (PUSH, "push_7 = { lower = 0.0, upper = 1.0 }\n" + PUSH, snapshot("study.toml: [parameters]: 'push_7' is a parameter and one of the series 'push'; rename one of the two")),
        ('coefficients = "push"', 'coefficients = "pull"', snapshot("study.toml: [[model.load]] 'hand', x, coefficients: 'pull' was given; expected a list of numbers, or the name of a series: a parameter with count")),
        ('mass = "2 kg"', 'mass = "push"', snapshot("study.toml: [[model.body]] 'bar', mass: 'push' was given, but unknown name 'push'; did you mean 'push_9' or 'push_8'?; expected a mass such as '500 g' or 0.5 in kg, or an expression of parameters and constants")),
        ('smooth = "push"', 'smooth = "pull"', snapshot("study.toml: [regularise], smooth: unknown parameter 'pull'; known: push_1, push_10, push_100, push_11, push_12, push_13, push_14, push_15, push_16, push_17, push_18, push_19, and 88 more")),
        ('smooth = "push"', 'smooth = ["push_1", "push_101"]', snapshot("study.toml: [regularise], smooth: unknown parameter 'push_101'; did you mean 'push_11' or 'push_10'?")),
        ('smooth = "push"', 'weight = "corner"', snapshot("study.toml: [regularise], weight: 'corner' was given; expected 'l-curve' or 'discrepancy'")),
        ('smooth = "push"', "weight = -1.0", snapshot('study.toml: [regularise], weight: -1.0 was given; expected a number greater than 0.0')),
        ('deviations = { "bar.end.x" = "0.5 mm", "bar.end.y" = "0.5 mm" }\n\n[regularise]\nsmooth = "push"',
         '[regularise]\nweight = "discrepancy"', snapshot("study.toml: [regularise], weight: 'discrepancy' compares with the noise; give deviations in [data]")),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_series(changed, before: str, after: str, sentence: str) -> None:
    with refused(InputError, sentence):
        changed(before, after)
