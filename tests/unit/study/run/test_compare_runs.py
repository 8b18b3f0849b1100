"""Runs are ranked by name, from the command, and runs that are no fits are refused."""

import numpy as np
import pytest
from typer.testing import CliRunner

from dalembert.cli import app
from dalembert.errors import InputError
from dalembert.study import load, run_study
from dalembert.study.run.compare_runs import compare_runs
from dalembert.study.run.folder import RunFolder
from support import says

MODEL = """
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0.0, 2.0, 81)

def line(parameters):
    return PythonModel(lambda a, b: a + b * times, parameters, ["x"], times)

def bent(parameters):
    return PythonModel(lambda a, b, c: a + b * times + c * times**2, parameters, ["x"], times)
"""
STUDY = """
[parameters]
a = { lower = -9.0, upper = 9.0 }
b = { lower = -9.0, upper = 9.0 }
%s
[model]
forward = "model.py:%s"
[data]
file = "data.csv"
columns = { x = "x" }
[identify]
starts = 1
"""
SWEEP = """
[parameters]
a = { lower = -9.0, upper = 9.0 }
b = { lower = -9.0, upper = 9.0 }
[model]
forward = "model.py:line"
[sweep]
at = 1.0
channels = ["x"]
over = { a = { count = 2 } }
"""


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    root = tmp_path_factory.mktemp("work")
    times, noise = np.linspace(0, 2, 81), 0.1 * np.random.default_rng(0).standard_normal(81)
    rows = zip(times, 1 + 2 * times + 0.5 * times**2 + noise, strict=True)
    (root / "data.csv").write_text("t,x\n" + "".join(f"{t},{x}\n" for t, x in rows))
    (root / "model.py").write_text(MODEL)
    texts = {
        "line": STUDY % ("", "line"),
        "bent": STUDY % ("c = { lower = -9.0, upper = 9.0 }", "bent"),
        "sweep": SWEEP,
    }
    for name, text in texts.items():
        (root / f"{name}.toml").write_text(text)
        run_study(load(root / f"{name}.toml"), root / "runs" / name)
    return root


def test_the_command_ranks_runs_and_writes_a_report(root, monkeypatch):
    monkeypatch.chdir(root)
    ran = CliRunner().invoke(app, ["compare", "line", "runs/bent", "--out", "ranked.html"])
    assert ran.exit_code == 0, ran.output
    assert "'bent' predicts best" in ran.output
    assert "report: ranked.html" in ran.output
    assert (root / "ranked.html").stat().st_size > 50_000


def test_what_is_left_out_can_be_chosen(root):
    folders = [RunFolder(root / "runs" / name) for name in ("line", "bent")]
    assert compare_runs(folders, "values").left_out == "values"


def test_a_run_of_another_task_is_refused(root):
    with pytest.raises(
        InputError,
        match=says(
            "run 'sweep' has no fit to samples and no posterior; compare runs of the task [identify], or of the task [sample]"
        ),
    ):
        compare_runs([RunFolder(root / "runs" / "line"), RunFolder(root / "runs" / "sweep")])
