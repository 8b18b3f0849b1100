"""The best fit so far of a run that goes on."""

from base64 import b64decode

import numpy as np
import pytest

from dalembert.studio.runs.fit_so_far import fit_so_far
from dalembert.studio.worker import Kept
from dalembert.study import RunFolder, load, run_study
from dalembert.study.tables.posing import unknown_names
from dalembert.study.template import begin

EXPERIMENTS = """
[[experiments]]
name = "first"
file = "motion.csv"
columns = { "rod.end.x" = "x" }
local = ["angle"]
[[experiments]]
name = "second"
file = "motion.csv"
columns = { "rod.end.y" = "y" }
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A run of a study with two experiments."""
    path = begin("identify", tmp_path_factory.mktemp("studies") / "mine")
    before, data = path.read_text().split("[data]\n")
    task = data.partition("\n\n")[2]
    path.write_text(before + EXPERIMENTS + task.replace("starts = 4", "starts = 1"))
    folder, _ = run_study(load(path), path.parent / "runs" / "one")
    return folder.path


def test_each_experiment_has_its_own_fit(folder):
    assert unknown_names(RunFolder(folder).kept()) == ("drag", "first.angle", "angle")
    values = [0.2, -0.5, -0.7]
    first, second = (fit_so_far(Kept(), folder, values, name) for name in ("", "second"))
    assert first.experiments == second.experiments == ("first", "second")
    assert [_start(first, "rod.end.x"), _start(second, "rod.end.y")] == pytest.approx(
        [0.8 * np.cos(0.5), -0.8 * np.sin(0.7)], abs=1e-6
    )


def test_a_vector_of_another_length_has_no_fit(folder):
    assert fit_so_far(Kept(), folder, [0.2, -0.5]) is None


def _start(fit, channel):
    """First computed value of a channel."""
    y = next(trace["y"] for trace in fit.figure["data"] if trace["name"] == f"{channel} computed")
    return np.frombuffer(b64decode(y["bdata"]), y["dtype"])[0]
