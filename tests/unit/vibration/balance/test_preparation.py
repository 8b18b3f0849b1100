"""A computation in frequency or in time prepares the kernels that it calls, and no others."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from dalembert.kernels.kernel import Compiled, Kernel
from dalembert.kernels.preparation import observed
from dalembert.structure import lumped
from dalembert.study import load, run_study
from dalembert.study.run.events import read_events
from dalembert.study.template import begin
from dalembert.vibration import (
    ElasticSlider,
    FrequencyCurve,
    FrequencyResponse,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    Newmark,
    Rigid,
    VibrationSystem,
    backbone,
    compare_in_time,
    floquet_multipliers,
    frequency_response,
    frequency_responses,
    steady_state,
    track_resonance,
)
from dalembert.vibration.balance import preparation
from dalembert.vibration.laws.law import Law
from vibrating_systems import duffing, one_mass, two_masses

METHOD = HarmonicBalance(3, samples=64)
PLACES = np.array([0.1, 0.15])


def damped(preload: float) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("slider", "m", friction=0.5, preload=preload, law=ElasticSlider(0.8)))
    return system


def known() -> FrequencyCurve:
    return frequency_response(one_mass(), PLACES, METHOD)


def model() -> FrequencyResponse:
    return FrequencyResponse(damped, {"preload": (1.0, 3.0)}, ["m peak"], PLACES, METHOD)


CASES: dict[str, Callable[[], object]] = {
    "response": known,
    "response, stable or not": lambda: frequency_response(one_mass(), PLACES, METHOD, stability=True),
    "rigid contact, stable or not": lambda: frequency_response(two_masses(Rigid()), PLACES, METHOD, stability=True),
    "no friction": lambda: frequency_response(duffing(), PLACES, METHOD, stability=True),
    "several responses": lambda: frequency_responses(damped, "preload", [1.0, 2.0, 3.0], PLACES, METHOD, workers=3),
    "ensemble": lambda: model().evaluate(np.array([[1.5], [2.0], [2.5]])),
    "derivatives": lambda: model().jacobian(np.array([2.0])),
    "nonlinear mode": lambda: backbone(one_mass(), np.array([1.0, 5.0]), method=METHOD),
    "peak": lambda: track_resonance(damped, "preload", [2.0, 3.0], (0.1, 0.3), METHOD, dof="m"),
    "multipliers": lambda: floquet_multipliers(one_mass(), known(), 0),
    "time": lambda: steady_state(one_mass(), 0.15, Newmark(64)),
    "time, by shooting": lambda: steady_state(one_mass(), 0.15, Newmark(64), way="shooting"),
    "time beside a curve": lambda: compare_in_time(one_mass(), known(), points=[0, 1], method=Newmark(64)),
}


@pytest.mark.parametrize("case", CASES)
def test_what_is_called_was_prepared_and_nothing_else(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    prepared: set[str] = set()
    called: set[str] = set()
    call = Kernel.called

    def recorded(self: Kernel, entry: object, values: list) -> object:
        assert self.symbol in prepared
        called.add(self.symbol)
        return call(self, entry, values)

    def prepare(kernels: list[Compiled]) -> None:
        prepared.update(kernel.symbol for kernel in kernels)

    def address(self: Law) -> int:  # a law is called by its address
        (kernel,) = self.all_kernels()
        assert kernel.symbol in prepared
        called.add(kernel.symbol)
        return kernel.address

    monkeypatch.setattr(Law, "address", property(address))
    monkeypatch.setattr(Kernel, "called", recorded)
    monkeypatch.setattr(preparation, "prepare", prepare)
    CASES[case]()
    assert called == prepared


def test_threads_of_an_ensemble_compile_each_kernel_once(nothing_compiled: Path) -> None:
    seen: list[tuple[int, int]] = []
    with observed(lambda count, total, _: seen.append((count, total))):
        assert not any(model().evaluate(np.array([[1.5], [2.0], [2.5]])).failures)
    assert seen == [(1, 2), (2, 2)]


def test_a_study_shows_how_many_kernels_are_left(
    nothing_compiled: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    folder, _ = run_study(load(begin("response", tmp_path / "study")))
    shown = [event for event in read_events(folder.events) if event["event"] == "run-compiling"]
    assert [(event["done"], event["total"]) for event in shown] == [(1, 2), (2, 2)]
