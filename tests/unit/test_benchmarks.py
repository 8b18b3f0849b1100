"""Benchmarks that use inner parts of the package run, and what they compare agrees."""

from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from dalembert.multibody import GeneralizedAlpha, simulate

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


def test_mechanisms_in_space_of_both_sides_start_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT)
    ours, cases = import_module("benchmarks.ours"), import_module("benchmarks.spatial_cases")
    for case in (cases.heavy_top(), cases.double_pendulum(), cases.bricard(), cases.chain(3)):
        motion = simulate(ours.mechanism(case), 2e-3, GeneralizedAlpha(step=1e-3), times=np.array([0.0, 2e-3]))
        start, _ = motion.channels(ours.tip(case))
        np.testing.assert_allclose(start, case.bodies[-1].position + case.tip, rtol=0, atol=1e-15)
    heavier = cases.scaled(cases.double_pendulum(), {"mass": 2.0, "lower_centre": 0.5})
    assert heavier.bodies[0].mass == 2.0 * cases.double_pendulum().bodies[0].mass
