"""The raw records of the tutorial: their files are those that the script writes, and their study finds the truth."""

import re

import numpy as np
import pytest

import raw_records
from dalembert.errors import DataError
from dalembert.study import load, plan, run_study
from dalembert.study.template import begin, templates

NUMBER = re.compile(r"-?\d+[.,]?\d*")


def test_the_template_holds_what_the_script_writes(tmp_path):
    """To a unit of the last digit, since integrators differ between machines."""
    raw_records.main(tmp_path)
    for name, text in templates()["records"].files.items():
        written = (tmp_path / name).read_text(encoding="utf-8")
        assert NUMBER.sub("", written) == NUMBER.sub("", text)
        numbers = [[float(one.replace(",", ".")) for one in NUMBER.findall(each)] for each in (text, written)]
        np.testing.assert_allclose(*numbers, atol=0.0101, rtol=0)


@pytest.mark.slow
def test_the_study_of_the_template_finds_the_truth(tmp_path):
    study = load(begin("records", tmp_path / "rig"))
    assert "mixed: 601 samples" in plan(study)
    _, outcome = run_study(study, tmp_path / "run")
    fit = outcome.result
    truth = {
        "torque_constant": raw_records.TORQUE_CONSTANT,
        "friction": raw_records.FRICTION,
        "bar.start.angle delay": raw_records.DELAY,
    }
    for name, deviation in zip(fit.parameters.names, fit.deviations, strict=True):
        assert abs(fit.estimates[name] - truth[name]) < 3 * deviation
    assert fit.validation.misfit == pytest.approx(1.0, abs=0.1)


def test_an_input_with_missing_time_stamps_is_refused(tmp_path):
    path = begin("records", tmp_path / "rig")
    lines = (tmp_path / "rig" / "mixed.csv").read_text().splitlines()
    (tmp_path / "rig" / "mixed.csv").write_text("\n".join(lines[:200] + lines[240:]))
    with pytest.raises(DataError, match=r"has no values from 1\.98 to 2\.39 s, and what drives the model there is not"):
        plan(load(path))
