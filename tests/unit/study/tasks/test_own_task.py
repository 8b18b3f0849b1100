"""A task of another package: three files, a task, its section and its figure, and nothing else is changed."""

import os
import subprocess
import sys
from pathlib import Path

FILES = {
    "own_ringing": '''
"""The task [ringing]: how long the lowest modes of a structure ring."""

import json
from dataclasses import asdict, dataclass

import numpy as np

from dalembert.files import write_text
from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.text.table import StudyTable
from dalembert.study.tasks.task import ResultTask
from dalembert.study.tasks.requirements import needs_structure


@dataclass(frozen=True)
class Ringing:
    """Times in which modes fall to a tenth."""

    frequencies: list[float]
    times: list[float]
    success = True
    status = "All modes ring down."

    def summary(self):
        return f"{len(self.times)} modes, the longest rings for {max(self.times):.4g} s"

    def save(self, path):
        write_text(path, json.dumps(asdict(self)))

    @classmethod
    def load(cls, path):
        return cls(**json.loads(path.read_text()))


class RingingTable(StudyTable):
    """Find how long modes ring."""

    damping_ratio: float = 0.01


class RingingTask(ResultTask):
    """The task ``[ringing]``."""

    name = "ringing"
    of_structures = True
    schema = RingingTable
    needs = (needs_structure,)
    kind = "own_ringing:Ringing"

    def plan(self, study):
        return "finds how long modes ring: 1 simulation"

    def effort(self, study):
        return Effort(repeatedly(lambda: self._result(study)), 1, 1, 1, "the modes")

    def parts(self, study):
        return ()

    def unknowns(self, study):
        return ()

    def result(self, study, emit):
        return self._result(study)

    def _result(self, study):
        structure = study.system().structure
        squares = np.linalg.eigvals(np.linalg.solve(structure.mass, structure.stiffness))
        omegas = np.sort(np.sqrt(np.real(squares)))
        times = np.log(10) / (study.table.damping_ratio * omegas)
        return Ringing((omegas / (2 * np.pi)).tolist(), times.tolist())
''',
    "own_ringing_section": '''
"""The section on a Ringing."""

from dalembert.report import ReportSection, sections_of
from own_ringing import Ringing
from own_ringing_figure import ringing_times


@sections_of(Ringing)
def ringing(result, asked):
    return [ReportSection("Ringing", (result.summary() + ".",), {"One bar a mode.": ringing_times(result)})]
''',
    "own_ringing_figure": '''
"""The figure of a Ringing."""

import plotly.graph_objects as go


def ringing_times(result):
    return go.Figure(go.Bar(x=result.frequencies, y=result.times), layout={"title": {"text": "Times of ringing"}})
''',
}
STUDY = """
[[model.mass]]
name = "a"
mass = 2.0

[[model.spring]]
first = "a"
stiffness = 800.0

[ringing]
damping_ratio = 0.05
"""


def run(folder: Path, *command: str) -> str:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), *filter(None, sys.path)])}
    done = subprocess.run(
        [sys.executable, "-m", "dalembert.cli", *command],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_a_task_in_three_files_runs_and_reports(tmp_path: Path) -> None:
    for name, text in FILES.items():
        (tmp_path / f"{name}.py").write_text(text)
    about = tmp_path / "own-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: own\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("[dalembert.tasks]\nringing = own_ringing_section\n")
    (tmp_path / "study.toml").write_text(STUDY)
    assert len(FILES) == 3
    assert "finds how long modes ring" in run(tmp_path, "check", "study.toml")
    # ln 10 / (0.05 · 20 rad/s)
    assert "the longest rings for 2.303 s" in run(tmp_path, "run", "study.toml", "--out", "run")
    page = (tmp_path / "run" / "report.html").read_text()
    assert "One bar a mode." in page
    assert "Times of ringing" in page
    (tmp_path / "run" / "report.html").unlink()
    run(tmp_path, "report", "run")
    assert "One bar a mode." in (tmp_path / "run" / "report.html").read_text()
