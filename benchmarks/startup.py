"""What a user waits for: kernels that nobody has compiled yet, a later process, a wheel, a study, the help text.

Processor seconds of whole processes with those that they start, divided by the time of a loop in plain Python that runs
beside them, and multiplied by the loop's time on a quiet machine: so a busy machine gives about the same numbers.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tests.installed_wheel import install_wheel

from benchmarks import timing

QUIET = 0.12  # s that the loop takes on a quiet machine of the kind that the tables were made on
ROOT = Path(__file__).parents[1]

_HEAD = "import numpy as np, dalembert as da; times = np.linspace(0.0, 0.2, 3)\n"
_RIGID = (
    _HEAD
    + """
def arm(angle=0.5):
    system = da.System()
    bar = system.add(da.RigidBar("bar", length=1.0, mass=1.0, angle=angle))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start))
    return system
"""
)
_SIMULATE = _RIGID + "da.simulate(arm(), 0.2, da.{solver}, times).channels(['bar.end.x'])"
_SPATIAL = (
    _HEAD
    + """
from benchmarks import ours, spatial_cases
system = ours.mechanism(spatial_cases.double_pendulum())
da.simulate(system, 0.2, da.{solver}, times).channels(['1.tip.x'])
"""
)
_FIT = (
    _HEAD
    + """
from benchmarks import ours
from benchmarks.sensitivities import BEAM, _row
_row('', ours.beam_pendulum, BEAM, 2)
"""
)
_FRICTION = (
    _HEAD
    + """
system = da.VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
system.add(da.HarmonicForce("m", 1.0))
system.add(da.FrictionContact("damper", "m", friction=0.5, preload=2.0, law=da.ElasticSlider(0.8)))
da.frequency_response(system, np.array([0.17, 0.18]), da.HarmonicBalance(harmonics=3))
"""
)
_SOLVERS = (
    "GeneralizedAlpha(step=1e-2)", "RadauIIA()", "Variational(step=1e-2)", "EnergyMomentum(step=1e-2)",
    "RungeKutta4(step=1e-2)", "OdeSolver()", "Collocation(step=1e-2)",
)  # fmt: skip


def main() -> list[dict[str, object]]:
    with tempfile.TemporaryDirectory() as folder:
        rows = [
            _row("rigid mechanism, first simulation, nothing compiled", _SIMULATE.format(solver=_SOLVERS[0]), folder)
        ]
        rows += [
            _row(f"then the same by {solver.partition('(')[0]}", _SIMULATE.format(solver=solver), folder)
            for solver in _SOLVERS[1:]
        ]
        spatial = _SPATIAL.format(solver=_SOLVERS[0])
        rows.append(_row("mechanism in space, first simulation, nothing compiled", spatial, f"{folder}/spatial"))
        rows.append(_of_a_wheel(Path(folder)))
        rows.append(_row("friction in frequency, nothing compiled", _FRICTION, f"{folder}/friction"))
        rows.append(_row("flexible pendulum with sensitivities, nothing compiled", _FIT, f"{folder}/fit"))
        rows.append(_row("flexible pendulum with sensitivities, later process", _FIT, f"{folder}/fit"))
        study = [sys.executable, "-m", "dalembert.cli", "run", "studies/flexible-pendulum/identify.toml"]
        run = [*study, "--out", f"{folder}/run", "--force"]
        rows.append(_row("the demo's study, nothing compiled", run, f"{folder}/study"))
        rows.append(_row("the demo's study, later process", run, f"{folder}/study"))
        compile_all = [sys.executable, "-m", "dalembert.cli", "compile"]
        rows.append(_row("dalembert compile, nothing compiled", compile_all, f"{folder}/all"))
        rows.append(_row("import dalembert", "import dalembert", folder))
        rows.append(_row("dalembert --help", [sys.executable, "-m", "dalembert.cli", "--help"], folder))
    timing.report("startup", "Waiting times: whole processes", rows)
    return rows


def _of_a_wheel(folder: Path) -> dict[str, object]:
    """The first simulation of a user who has installed a wheel with kernels, which must compile nothing."""
    site, cache = install_wheel(folder), folder / "cache of the wheel"
    row = _row(
        "rigid mechanism, first simulation, from a wheel", _SIMULATE.format(solver=_SOLVERS[0]), str(cache), site
    )
    if cache.exists():
        raise RuntimeError(f"the wheel lacks kernels, which were compiled: {sorted(cache.rglob('*'))}")
    return row


def _row(what: str, command: str | list[str], cache: str, package: Path = ROOT / "src") -> dict[str, object]:
    """Processor and wall-clock seconds of a process, scaled to a quiet machine."""
    arguments = [sys.executable, "-c", command] if isinstance(command, str) else command
    before = _children()
    loops = [_loop() for _ in range(3)]
    began = time.perf_counter()
    subprocess.run(
        arguments,
        check=True,
        cwd=ROOT,
        env={**os.environ, "DALEMBERT_CACHE_DIR": cache, "PYTHONPATH": str(package)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    wall, used = time.perf_counter() - began, _children() - before
    scale = QUIET / min(loops + [_loop() for _ in range(3)])
    return {"what": what, "CPU s": round(used * scale, 2), "wall s": round(wall * scale, 2)}


def _children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _loop() -> float:
    """Processor time of a loop in plain Python."""
    began, total = time.process_time(), 0
    for i in range(2_000_000):
        total += i * i & 7
    return time.process_time() - began


if __name__ == "__main__":
    main()
