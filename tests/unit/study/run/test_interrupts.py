"""Interrupts inside callbacks, whose errors Python drops."""

import ctypes
import gc
import signal
import time

import pytest

from dalembert.study import RunFolder, load, run_study
from dalembert.study.run.interrupts import kept_interrupts
from dalembert.study.run.runner import Stopped


class Interrupting:
    """Sends an interrupt when it is called first, or deleted."""

    def __init__(self) -> None:
        self.sent = False

    def __call__(self, *arguments: object) -> int:
        if not self.sent:
            self.sent = True
            signal.raise_signal(signal.SIGINT)
        return 0

    def __del__(self) -> None:
        self()


def of_collector() -> None:
    callback = Interrupting()
    gc.callbacks.append(callback)
    try:
        gc.collect()
    finally:
        gc.callbacks.remove(callback)


def of_destructor() -> None:
    Interrupting()


def of_library() -> None:
    ctypes.CFUNCTYPE(ctypes.c_int)(Interrupting())()


@pytest.mark.parametrize("callback", [of_collector, of_destructor, of_library])
def test_an_interrupt_inside_a_callback_is_raised(callback):
    with pytest.raises(KeyboardInterrupt), kept_interrupts():
        _worked_after(callback)


def _worked_after(callback):
    callback()
    end = time.monotonic() + 60
    while time.monotonic() < end:
        pass


def test_other_errors_of_callbacks_are_handed_on(monkeypatch):
    seen = []
    monkeypatch.setattr("sys.unraisablehook", seen.append)
    with kept_interrupts():
        ctypes.CFUNCTYPE(ctypes.c_int)(lambda: 1 // 0)()
    assert [one.exc_type for one in seen] == [ZeroDivisionError]


MODEL = """
import gc, signal, time
import numpy as np
from dalembert.forward import PythonModel

sent = []

def interrupt(phase, info):
    if not sent:
        sent.append(True)
        signal.raise_signal(signal.SIGINT)

def response(rate):
    if np.real(rate) > 1.0 and not sent:
        gc.callbacks.append(interrupt)
        try:
            gc.collect()
        finally:
            gc.callbacks.remove(interrupt)
        for _ in range(6000):
            time.sleep(0.01)
    return np.exp(-rate * np.linspace(0, 1, 3))

def decay(parameters):
    return PythonModel(response, parameters, ["x"], np.linspace(0, 1, 3))
"""
STUDY = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
[model]
forward = "collected.py:decay"
[sweep]
at = 0.5
channels = ["x"]
over = { rate = { count = 5 } }
"""


def test_a_run_is_stopped_by_an_interrupt_inside_the_garbage_collector(tmp_path):
    (tmp_path / "collected.py").write_text(MODEL)
    (tmp_path / "collected.toml").write_text(STUDY)
    with pytest.raises(Stopped):
        run_study(load(tmp_path / "collected.toml"), tmp_path / "run")
    assert RunFolder(tmp_path / "run").state()["state"] == "interrupted"
