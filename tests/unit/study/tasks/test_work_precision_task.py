"""The task that compares integrators."""

import pytest

from dalembert.errors import InputError
from dalembert.study import load, run_study
from dalembert.study.run.validation import forecast, plan
from dalembert.study.tasks import TASKS
from study_texts import BAR

STUDY = (
    BAR
    + """
[work_precision]
end = "1 s"
channels = ["bar.end.x"]
repeats = 1
reference = [{ step = 1e-4 }, { step = 2e-4 }]

[[work_precision.series]]
solver = { step = 0.01 }
over = { step = [0.02, 0.01] }
"""
)
SECOND = """
[[work_precision.series]]
solver = { step = 0.01, spectral_radius = 0.5 }
over = { step = [0.02] }
"""


def _load(tmp_path, text):
    path = tmp_path / "study.toml"
    path.write_text(text)
    return load(path)


def test_it_runs_and_is_read_again(tmp_path):
    study = _load(tmp_path, STUDY)
    assert plan(study) == "compares 1 integrators in 2 settings over 1 s: 6 simulations"
    assert ": 6 simulations of " in next(forecast(study))
    folder, outcome = run_study(study, tmp_path / "run")
    assert outcome.success
    assert [row.steps for row in outcome.result.rows] == [50, 100]
    assert TASKS["work_precision"].load(study, folder.result).result.rows == outcome.result.rows


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            STUDY + SECOND,
            "[[work_precision.series]]: 'GeneralizedAlpha' names 2 series; give each a name",
        ),
        (
            STUDY.replace("over = { step", "over = { stride"),
            "over: a GeneralizedAlpha has no setting 'stride'",
        ),
        (STUDY.replace(", { step = 2e-4 }", ""), "at least 2"),
    ],
)
def test_what_cannot_be_meant(tmp_path, text, sentence):
    with pytest.raises(InputError) as error:
        _load(tmp_path, text)
    assert sentence in str(error.value)
