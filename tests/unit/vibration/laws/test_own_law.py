"""A law of another package: one file, and it serves in frequency, in time, in a study and in its report."""

import os
import subprocess
import sys
from pathlib import Path

LAW = '''
"""A spring that softens with its largest displacement so far in a period."""

from dataclasses import dataclass, field

from dalembert.vibration import LawElement, law


@law
def wearing(u, v, z, numbers, force):
    force[0] = numbers[0] * u[0] / (1.0 + numbers[1] * u[0] * u[0]) + numbers[2] * v[0] ** 3


@dataclass(frozen=True)
class Wearing(LawElement):
    """A spring that softens, with cubic damping."""

    name: str
    first: str
    second: str | None = None
    stiffness: float | complex = field(kw_only=True, metadata={"unit": "N/m"})
    softening: float | complex = field(kw_only=True, metadata={"unit": "1/m^2"})
    damping: float | complex = field(default=0.1, kw_only=True, metadata={"unit": ""})

    law = wearing
    rated = True
'''

CODE = """
import numpy as np
from dalembert.structure import lumped
from dalembert.vibration import (
    HarmonicBalance, HarmonicForce, Newmark, VibrationSystem, compare_in_time, frequency_response
)
from own_wearing import Wearing

system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 0.5, 0.05)]))
system.add(HarmonicForce("m", 0.3))
system.add(Wearing("law", "m", stiffness=0.6, softening=0.4))
curve = frequency_response(system, np.array([0.1, 0.15]), HarmonicBalance(9), stability=True)
assert curve.converged.all() and curve.stable.all()
comparison = compare_in_time(system, curve, points=[0, 1], method=Newmark(2048))
assert np.abs(comparison.differences).max() < 1e-5, comparison.differences
"""

STUDY = """
[parameters]
stiffness = { lower = 0.4, upper = 0.8 }

[[model.mass]]
name = "m"
mass = 1.0

[[model.spring]]
first = "m"
stiffness = 0.5
damping = 0.05

[[model.spring]]
kind = "Wearing"
name = "mount"
first = "m"
stiffness = "stiffness"
softening = 0.4

[[model.force]]
dof = "m"
amplitude = 0.3

[frequency_response]
frequencies = { start = 0.05, end = "0.25 Hz", count = 11 }
"""


def run(folder: Path, *command: str) -> str:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), *filter(None, sys.path)])}
    done = subprocess.run(
        [sys.executable, *command], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_a_law_in_one_file_serves_everywhere(tmp_path: Path) -> None:
    (tmp_path / "own_wearing.py").write_text(LAW)
    about = tmp_path / "own-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: own\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("[dalembert.components]\nown_wearing = own_wearing\n")
    (tmp_path / "study.toml").write_text(STUDY)
    run(tmp_path, "-c", CODE)
    assert "All 11 points between" in run(tmp_path, "-m", "dalembert.cli", "run", "study.toml", "--out", "run")
    assert "mount" in (tmp_path / "run" / "report.html").read_text()
