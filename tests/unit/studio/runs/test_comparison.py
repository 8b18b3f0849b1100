"""Runs compared as one page, and as CSV."""

import csv
import io
import json
import shutil

import h5py
import pytest

from dalembert.errors import DataError
from dalembert.inverse import Fit
from dalembert.report import report
from dalembert.studio.runs.compare_page import comparison_file
from dalembert.studio.runs.comparison import RunComparison, curves_of
from dalembert.studio.workspace import Workspace
from dalembert.study import load, run_study
from dalembert.study.template import begin


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    """A workspace with two fits, of different studies, and a motion."""
    root = tmp_path_factory.mktemp("work")
    study = begin("identify", root / "studies" / "pendulum")
    run_study(load(study), root / "runs" / "coarse")
    study.write_text(study.read_text().replace('step = "1 ms"', 'step = "2 ms"'))
    run_study(load(study), root / "runs" / "<i>fine")
    run_study(load(begin("motion", root / "studies" / "motion")), root / "runs" / "motion")
    return root


def test_curves(root):
    by_run = {folder.path.name: list(curves_of(folder)) for folder in Workspace(root).runs()}
    fitted = [(one.channel, one.along, one.measured) for one in by_run["coarse"]]
    assert ("rod.end.x (m)", "time (s)", True) in fitted
    assert ("rod.end.x (m)", "time (s)", False) in fitted
    motion = {one.channel for one in by_run["motion"]}
    assert "rod.end.x (m)" in motion
    assert not any(channel.startswith("energy.") for channel in motion)


def test_the_page_has_values_responses_and_differences(root, tmp_path):
    text = report(RunComparison(Workspace(root).runs()), tmp_path / "page.html").read_text()
    assert "<i>fine" not in text.partition("<script")[0]
    assert "3 runs compared" in text
    assert "+ step = &#34;1 ms&#34;" in text
    assert "responses-1" in text
    assert "which means nothing" in text  # of the two fits


def test_the_values_as_csv(root):
    answer = comparison_file(Workspace(root), ["coarse", "motion", "coarse"], csv=True)
    rows = {row[0]: row[1:] for row in csv.reader(io.StringIO(bytes(answer.body).decode()))}
    assert rows[""] == ["coarse", "motion"]
    assert float(rows["drag (N*m*s)"][0]) == pytest.approx(0.2, abs=1e-3)
    assert 0 < float(rows["drag, standard deviation (N*m*s)"][0]) < 1e-2
    assert rows["drag (N*m*s)"][1] == ""
    assert -60 < float(rows["angle (deg)"][0]) < -20


@pytest.mark.parametrize("names", [[], ["nothing"]])
def test_runs_that_are_not_there(root, names):
    assert comparison_file(Workspace(root), names).status_code == 404


def test_a_run_of_other_code_leaves_the_page_of_the_others(root):
    shutil.copytree(root / "runs" / "coarse", root / "runs" / "foreign")
    folder = Workspace(root).run("foreign")
    with h5py.File(folder.result, "a") as file:
        file.attrs["settings"] = json.dumps({**json.loads(file.attrs["settings"]), "parameters": [{"other": 1}]})
    with pytest.raises(DataError, match=r"this version cannot read the result .*\. Run the study again, or read"):
        Fit.load(folder.result)
    answer = comparison_file(Workspace(root), ["coarse", "foreign"])
    assert answer.status_code == 200
    assert "responses-1" in bytes(answer.body).decode()
    shutil.rmtree(folder.path)
