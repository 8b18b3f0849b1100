"""What a user waits for: the first simulation on a machine (compiles), a later process (loads), and the help text."""

import subprocess
import sys
import tempfile
import time
from os import environ
from pathlib import Path

from benchmarks import timing

SIMULATION = "from benchmarks import ours; from benchmarks.cases import PENDULUM; " + (
    "ours.simulated(ours.cable_pendulum(), PENDULUM.integration, ours.JOINT_AND_TIP)"
)
SENSITIVITY = "from benchmarks.sensitivities import BEAM, _row; from benchmarks import ours; " + (
    "_row('', ours.beam_pendulum, BEAM, 1)"
)


def main() -> list[dict[str, object]]:
    with tempfile.TemporaryDirectory() as cache:
        fresh = {**environ, "NUMBA_CACHE_DIR": cache}
        rows = [
            {"what": "first simulation on a machine, all compiled", "seconds": _run(SIMULATION, fresh)},
            {"what": "simulation in a later process", "seconds": _warm(SIMULATION, fresh)},
            {"what": "first sensitivity on a machine, after that", "seconds": _run(SENSITIVITY, fresh)},
            {"what": "sensitivity in a later process", "seconds": _warm(SENSITIVITY, fresh)},
            {"what": "import dalembert", "seconds": _warm("import dalembert", fresh)},
        ]
    help_text = [str(Path(sys.executable).with_name("dalembert")), "--help"]
    rows.append({"what": "dalembert --help", "seconds": min(_timed(help_text, dict(environ)) for _ in range(5))})
    timing.report("startup", "Waiting times, whole processes", rows)
    return rows


def _run(code: str, environment: dict[str, str]) -> float:
    return _timed([sys.executable, "-c", code], environment)


def _warm(code: str, environment: dict[str, str]) -> float:
    return min(_run(code, environment) for _ in range(3))


def _timed(command: list[str], environment: dict[str, str]) -> float:
    before = time.perf_counter()
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
    return time.perf_counter() - before


if __name__ == "__main__":
    main()
