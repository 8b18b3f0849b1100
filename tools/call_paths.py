"""Count the changes of file on five paths through the package: ``python tools/call_paths.py [path ...]``.

A change of file is a call of a Python function of the package whose file is not the file of the call before it. Calls
are counted in their order, in the thread of the caller; returns are not counted, nor are calls of other packages. The
files are those that contain these functions.

The counts do not depend on the speed of the machine: each path runs until two runs count the same, so that modules are
imported, kernels are compiled and caches are filled. They are taken in a process with a fixed hash seed, since the
order of sets changes some of them. ``tools/limits.toml`` has the largest allowed counts.
"""

import gc
import json
import os
import subprocess
import sys
import tempfile
import tomllib
import warnings
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

import numpy as np

import dalembert as da
from dalembert.study import load

ROOT = Path(__file__).parents[1]
LIMITS = ROOT / "tools" / "limits.toml"
PACKAGE = str(Path(da.__file__).parent)
TIMES = np.linspace(0, 4, 41)
MOST_RUNS = 6
IN_THIS_PROCESS = "--in-this-process"
STUDY = ROOT / "studies" / "flexible-pendulum" / "identify.toml"


class Counts(NamedTuple):
    """Changes of file on a path, and the number of different files."""

    changes: int
    files: int


def files_of_calls(action: Callable[[], Any]) -> list[str]:
    """File of each call of a function of the package, in the order of the calls."""
    files: list[str] = []

    def note(frame: FrameType, event: str, argument: Any) -> None:
        if event == "call" and frame.f_code.co_filename.startswith(PACKAGE):
            files.append(frame.f_code.co_filename)

    before = sys.getprofile()
    gc.disable()  # a finaliser of the package would count at a random place
    sys.setprofile(note)
    try:
        action()
    finally:
        sys.setprofile(before)
        gc.enable()
    return files


def counted(action: Callable[[], Any]) -> Counts:
    """Counts of an action that two successive runs agree on.

    Raises
    ------
    RuntimeError
        If no two successive runs agree.
    """
    last = None
    for _ in range(MOST_RUNS):
        files = files_of_calls(action)
        counts = Counts(sum(before != after for before, after in pairwise(files)), len(set(files)))
        if counts == last:
            return counts
        last = counts
    raise RuntimeError(f"No two of {MOST_RUNS} runs count the same. Is the path random?")


def _cable(E: float) -> da.System:
    system = da.System(gravity=(0.0, -9.81))
    cable = system.add(
        da.AncfCable("C", length=1.0, elements=1, youngs_modulus=E, density=1000.0, height=0.01, width=0.01)
    )
    system.add(da.RevoluteJoint("O", system.ground, cable.start))
    return system


def _decay(size: float, rate: float) -> np.ndarray:
    return size * np.exp(-rate * TIMES)


def _fit(file: Path) -> da.Fit:
    data = da.read(file, columns={"x": "x"})
    model = da.PythonModel(_decay, {"size": (0.5, 4.0), "rate": (0.1, 3.0)}, ["x"], TIMES)
    return da.identify(model, data, starts=1, seed=0)


def _written(file: Path, values: np.ndarray) -> Path:
    rows = [f"{float(time)!r},{float(value)!r}" for time, value in zip(TIMES, values, strict=True)]
    file.write_text("\n".join(["t,x", *rows]), encoding="utf-8")
    return file


def paths(folder: Path) -> dict[str, Callable[[], Any]]:
    """Action of each path, by its name in ``limits.toml``; files are written to a folder."""
    model = da.TimeResponse(
        _cable, {"E": (1e6, 1e7)}, ["C.end.x"], np.linspace(0, 0.1, 11), da.GeneralizedAlpha(step=1e-3)
    )
    vector = np.array([5e6])
    exact = _decay(2.0, 0.8)
    noise = 0.01 * np.random.default_rng(0).standard_normal(len(TIMES))
    exact_file, noisy_file = _written(folder / "exact.csv", exact), _written(folder / "noisy.csv", exact + noise)
    noisy_fit = _fit(noisy_file)
    return {
        "evaluate": lambda: model.evaluate(vector),
        "linearise": lambda: model.linearise(vector),
        "column_to_fit": lambda: _fit(exact_file),
        "noisy_column_to_fit": lambda: _fit(noisy_file),
        "fit_to_report": lambda: noisy_fit.report(folder / "report.html"),
        "study_to_system": lambda: load(STUDY).system(),
    }


def measured_here(names: list[str]) -> dict[str, Counts]:
    """Counts of paths in this process, of all if none is named."""
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {name: counted(run) for name, run in paths(Path(folder)).items() if not names or name in names}


def measured(names: list[str] | None = None) -> dict[str, Counts]:
    """Counts of paths in a new process, of all if none is named."""
    command = [sys.executable, __file__, IN_THIS_PROCESS, *(names or [])]
    environment = {**os.environ, "PYTHONHASHSEED": "0"}
    run = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    return {name: Counts(*counts) for name, counts in json.loads(run.stdout).items()}


def limits() -> dict[str, dict[str, int]]:
    """Counts at the first measurement and largest allowed counts, by the name of the path."""
    return tomllib.loads(LIMITS.read_text(encoding="utf-8"))["call_paths"]


def main() -> int:
    if sys.argv[1:2] == [IN_THIS_PROCESS]:
        print(json.dumps(measured_here(sys.argv[2:])))
        return 0
    allowed = limits()
    exceeded = False
    print(f"{'path':22} {'changes':>8} {'limit':>8} {'first':>8} {'files':>8}")
    for name, counts in measured(sys.argv[1:]).items():
        limit = allowed[name]
        exceeded |= counts.changes > limit["most"]
        print(f"{name:22} {counts.changes:8} {limit['most']:8} {limit['first']:8} {counts.files:8}")
    return int(exceeded)


if __name__ == "__main__":
    sys.exit(main())
