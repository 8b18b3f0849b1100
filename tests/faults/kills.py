"""Run a study in a child process again and again, kill it at random moments, and see that it ends the same.

``python kills.py STUDY.toml FOLDER KILLS SEED`` prints a JSON record. The children are forks of one process that holds
all that a run imports and compiles, so that a kill costs a few milliseconds and can come at any moment of the work.
"""

import json
import os
import random
import re
import signal
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray

from dalembert.study import RunFolder, load, resume_run, run_study
from dalembert.study.run.events import read_events

TIMED = ("seconds",)
"""Attributes and variables that hold measured times, which no two runs share."""


def content(path: Path) -> dict[str, bytes]:
    """All that a result holds, as bytes by name, without measured times."""
    with xarray.open_datatree(path, engine="h5netcdf") as tree:
        held = {}
        for node in tree.subtree:
            for name, array in node.ds.variables.items():
                if name not in TIMED:
                    held[f"{node.path}:{name}"] = np.asarray(array.values).tobytes()
            held |= {f"{node.path}@{key}": untimed(value) for key, value in node.attrs.items() if key not in TIMED}
    return held


def held(folder: RunFolder) -> dict[str, bytes]:
    """All that a run's result holds, and what stands beside it."""
    every = {path.name: content(path) for path in sorted(folder.path.glob("*.nc"))}
    return {f"{file} {name}": value for file, own in every.items() for name, value in own.items()}


def untimed(value: object) -> str:
    """An attribute without the measured times that JSON in it tells."""
    return re.sub(r'"seconds": [^,}]+', "", str(value))


def kinds(folder: RunFolder) -> list[str]:
    """Kinds of events of what a run did."""
    return [event["event"] for event in read_events(folder.events) if not event["event"].startswith("run-")]


def forked(work: Callable[[], object]) -> int:
    """Process number of a child that does some work."""
    child = os.fork()
    if child == 0:
        status = 1
        try:
            work()
            status = 0
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(status)
    return child


def go_on(study: Path, folder: RunFolder) -> None:
    """Resume a run, or begin it if its folder is not there yet or was not whole when its process was killed."""
    if folder.is_run:
        resume_run(folder)
    else:
        run_study(load(study), folder.path)


def killed(study: Path, folder: RunFolder, kills: int, longest: float, dice: random.Random) -> int:
    """Kills at random moments until the run has ended, or so many; how many it survived."""
    survived = 0
    while not (folder.is_run and folder.state()["state"] == "finished"):
        child = forked(lambda: go_on(study, folder))
        if survived < kills:
            time.sleep(dice.uniform(0, longest))
            os.kill(child, signal.SIGKILL)
            survived += 1
        _, status = os.waitpid(child, 0)
        if os.WIFEXITED(status) and os.WEXITSTATUS(status):
            raise SystemExit(f"{study}: a child failed after {survived} kills")
    return survived


def main(study: Path, out: Path, kills: int, seed: int) -> None:
    """Undisturbed once, then killed."""
    os.chdir(out)
    began = time.perf_counter()
    reference, _ = run_study(load(study), out / "undisturbed")
    once = time.perf_counter() - began
    began = time.perf_counter()
    os.waitpid(forked(lambda: run_study(load(study), out / "timed")), 0)
    longest, dice, survived, runs = time.perf_counter() - began, random.Random(seed), 0, 0
    wanted, events = held(reference), kinds(reference)
    while survived < kills:
        folder = RunFolder(out / f"killed-{runs}")
        survived += killed(study, folder, kills - survived, longest, dice)
        found = held(folder)
        wrong = [name for name in wanted | found if wanted.get(name) != found.get(name)]
        if wrong or kinds(folder) != events:
            raise SystemExit(f"{folder.path} differs in {wrong or 'its events'}")
        runs += 1
    print(json.dumps({"kills": survived, "runs": runs, "seconds": [round(once, 2), round(longest, 2)]}))  # noqa: T201


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4]))
