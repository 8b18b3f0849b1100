"""Compiling ahead: everything, once; whoever compiles, the bits are the same."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from dalembert.kernels import packaged
from dalembert.kernels.everything import package_kernels
from dalembert.kernels.kernel import find
from dalembert.multibody.components.planar.cable_element import CABLE
from dalembert.multibody.integrators.generalized_alpha import generalized_alpha, lanes_run
from dalembert.multibody.integrators.radau import radau_loop
from installed_wheel import install_wheel

MOVE = """
import hashlib
import dalembert as da
from flexible_pendulum import CHANNELS, pendulum, tip

def falling(gravity, **numbers):
    system = pendulum(**numbers)
    system.gravity = (0.0, -gravity)
    return system

model = tip({"theta1": (0.6, 1.0), "theta2": (0.4, 0.65)}, end=0.5)
values, jacobian = model.linearise([0.7, 0.5])
print(hashlib.sha256(model.evaluate([[0.7, 0.5], [0.9, 0.6]]).values.tobytes()).hexdigest())
print(hashlib.sha256(values.tobytes() + jacobian.tobytes()).hexdigest())
# Eight samples in lanes, and four directions in dual numbers.
print(hashlib.sha256(model.evaluate([[0.7 + k / 50, 0.5] for k in range(8)]).values.tobytes()).hexdigest())
ranges = {"theta1": (0.6, 1.0), "theta2": (0.4, 0.65), "youngs_ab": (1e7, 3e7), "gravity": (5.0, 20.0)}
other = da.TimeResponse(falling, ranges, CHANNELS, [0.0, 0.1], da.GeneralizedAlpha(5e-4))
values, jacobian = other.linearise([0.7, 0.5, 2e7, 9.81])
print(hashlib.sha256(jacobian.tobytes()).hexdigest())
"""


def test_everything_is_listed_once_and_found_by_other_processes() -> None:
    kernels = package_kernels()
    symbols = [kernel.symbol for kernel in kernels]
    assert len(set(symbols)) == len(symbols)
    expected = generalized_alpha.integrate, radau_loop.integrate, *CABLE.all_kernels()
    assert {kernel.symbol for kernel in expected} | {"dal_vibration_laws_friction_period_forces_real"} < set(symbols)
    assert all(find(kernel.origin) is kernel for kernel in kernels)


def moved(cache: Path, *first: str) -> str:
    """Digests of a motion and its derivatives, computed by a process with that cache and path."""
    here = {
        **os.environ,
        "DALEMBERT_CACHE_DIR": str(cache),
        "PYTHONPATH": os.pathsep.join([*first, *(path for path in sys.path if path)]),
    }
    run = subprocess.run([sys.executable, "-c", MOVE], env=here, capture_output=True, text=True, check=True)
    return run.stdout


@pytest.mark.slow
def test_a_process_that_compiles_and_one_that_does_not_compute_the_same_bits(tmp_path: Path) -> None:
    answers = {moved(tmp_path) for _ in range(2)}
    assert len(answers) == 1
    assert list(tmp_path.rglob("*.o"))


@pytest.mark.slow
def test_a_wheel_computes_the_same_bits_without_compiling(tmp_path: Path) -> None:
    if packaged.family() is None:
        pytest.skip("no object is made for this processor")
    site = install_wheel(tmp_path)
    assert moved(tmp_path / "empty", str(site)) == moved(tmp_path / "cache")
    assert not (tmp_path / "empty").exists()


def test_kernels_in_lanes_and_duals_are_compiled_when_needed_unless_all_are_asked_for() -> None:
    usual, every = ({kernel.symbol for kernel in package_kernels(vectors)} for vectors in (False, True))
    assert usual < every
    assert lanes_run.integrate_lanes.symbol in every - usual
    assert {kernel.symbol for kernel in CABLE.vector_kernels()} < every - usual
