"""Compiling ahead: everything, once; who finds the code on disk computes the bits of the one that compiled it."""

import os
import subprocess
import sys

import pytest

from dalembert.study import ahead
from dalembert.study.catalogue import catalogue

MOVE = """
import hashlib
from dalembert.multibody import GeneralizedAlpha, simulate
from dalembert.study import ahead
from flexible_pendulum import tip

ahead._move("GeneralizedAlpha")
model = tip({"theta1": (0.6, 1.0), "theta2": (0.4, 0.65)}, end=0.5)
print(hashlib.sha256(model.evaluate([[0.7, 0.5], [0.9, 0.6]]).values.tobytes()).hexdigest())
"""


def test_every_integrator_is_compiled():
    assert {kind.__name__ for kind in catalogue()["solver"]} - {"Automatic"} <= set(ahead._sorts())


def test_all_sorts_run_here():
    for name in ahead._sorts():
        assert ahead._timed(name)[0] == name


@pytest.mark.slow
def test_a_process_that_compiles_and_one_that_does_not_compute_the_same_bits(tmp_path):
    here = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(tmp_path),
        "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
    }
    answers, kept = [], []
    for _ in range(2):
        answers.append(
            subprocess.run([sys.executable, "-c", MOVE], env=here, stdout=subprocess.PIPE, check=True).stdout
        )
        kept.append(sorted(path.name for path in tmp_path.rglob("*.nbc")))
    assert answers[0] == answers[1]
    assert kept[0] == kept[1] != []
