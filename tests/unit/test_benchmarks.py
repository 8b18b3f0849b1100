"""Benchmarks that use inner parts of the package run, and what they compare agrees."""

from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


def test_formulas_of_joints_by_hand_equal_automatic_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT)
    joints = import_module("benchmarks.joints")
    monkeypatch.setattr(joints, "COUNT", 3)
    joint, kind, rates = joints.JOINTS["revolute"]
    chain = joints._chain(joints._rigid_bodies, joint)
    by_hand, automatic = (joints._Rates(chain, own, kind).answer() for own in (joints._by_hand(kind, rates), kind))
    assert np.count_nonzero(automatic) == 2 * 2 * 3  # first and second rates of two equations a joint
    np.testing.assert_allclose(by_hand, automatic, rtol=0, atol=1e-14 * np.abs(automatic).max())
