"""Inertias of an engine's crank and rod over many draws of noise: median, bias and spread of their errors."""

import importlib
from pathlib import Path

import numpy as np
import pytest

STUDY = Path(__file__).parents[2] / "studies" / "slider-crank-inertias"
STEP = np.array([0.0004, -0.0012])
"""What the step of the identification is known to cost, without noise."""


@pytest.mark.slow
@pytest.mark.parametrize(("level", "median"), [(1, 0.002), (5, 0.01), (10, 0.02)])
def test_inertias_come_back_from_noisy_motions(level, median, monkeypatch, record_evidence):
    monkeypatch.syspath_prepend(str(STUDY))
    errors = importlib.import_module("spread").errors(level, 20)
    typical = np.median(np.abs(errors), axis=0)
    bias, spread = errors.mean(axis=0), errors.std(axis=0, ddof=1)
    assert np.all(np.abs(bias - STEP) < 3 * spread / np.sqrt(len(errors)))
    record_evidence(
        f"median error of two inertias over 20 draws of {level} % noise", np.zeros(2), typical,
        tolerance=median, noisy=True, topic="Response sensitivity", kind="known truth", source="the inertias that made the motion",
    )  # fmt: skip
    record_evidence(
        f"spread of two inertias over 20 draws of {level} % noise", level * np.array([0.00053, 0.00137]), spread,
        tolerance=0.4, relative=True, noisy=True, topic="Response sensitivity", kind="other method", source="standard deviations of one fit",
    )  # fmt: skip
