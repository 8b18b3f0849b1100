"""A model that takes its time, and runs of it as processes: for tests that end runs in the middle."""

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

COMMAND = Path(sys.executable).with_name("dalembert")
MODEL = """
import time
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 1, 3)

def slow(parameters):
    return PythonModel(response, parameters, ["x"], times)

def response(rate):
    time.sleep(0.02)
    return np.exp(-rate * times)
"""
HEAD = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
[model]
forward = "slow.py:slow"
"""


def written(folder: Path, task: str) -> Path:
    """A study of the slow model."""
    (folder / "slow.py").write_text(MODEL)
    (folder / "slow.toml").write_text(HEAD + task)
    return folder / "slow.toml"


def begun(folder: Path, *arguments: str, **options: object) -> subprocess.Popen[str]:
    """A process of the command, in a folder; an interrupt reaches it.

    A shell's background job ignores the interrupt, and so would its children.
    """
    first = options.pop("preexec_fn", lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    options |= dict(cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=first)
    return subprocess.Popen([COMMAND, *arguments], **options)  # type: ignore[call-overload]


def wait_for(condition: Callable[[], bool], seconds: float = 300.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.02)
