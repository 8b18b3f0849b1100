"""Findings on what no motion closes, on unstable rotors, and on paths that leave their range."""

import numpy as np
import pytest

import dalembert as da
from dalembert.structure import RotatingDamper, lumped, with_rotors
from dalembert.vibration import HarmonicBalance, VibrationSystem, frequency_response

METHOD = HarmonicBalance(3)


def mass(force: float = 1.0) -> VibrationSystem:
    system = VibrationSystem(lumped({"m.x": 1.0, "m.y": 1.0}, [("m.x", None, 1.0, 0.1), ("m.y", None, 2.0, 0.1)]))
    system.add(da.HarmonicForce("m.x", force))
    return system


def test_a_gap_that_no_motion_closes_is_named():
    system = mass()
    system.add(da.BilinearStop("stop", "m.x", stiffness=1.0, gap=1e3))
    system.add(da.Gap("touched", "m.x", stiffness=1.0, gap=0.1))
    law = da.ElasticSlider(1.0, 1.0, gap=1e3)
    system.add(da.FrictionContact("far", "m", None, ("x",), "y", friction=0.3, law=law))
    curve = frequency_response(system, np.array([0.1, 0.15]), METHOD)
    [finding] = [finding for finding in curve.findings if finding.code == "never-closed"]
    assert finding.values == {"elements": ("stop", "far")}
    assert finding.message == "No motion of the curve closes 'stop' and 'far'."
    assert finding.severity == "warning"


def test_what_a_motion_closes_is_not_named():
    system = mass()
    system.add(da.Gap("touched", "m.x", stiffness=1.0, gap=0.1))
    assert not [f for f in frequency_response(system, np.array([0.1]), METHOD).findings if f.code == "never-closed"]


@pytest.mark.parametrize(("speed", "unstable"), [(40.0, False), (70.0, True), ("synchronous", True), (0.0, False)])
def test_a_rotor_that_its_own_damping_excites_is_named(speed, unstable):
    axes = ("d.x", "d.y")
    rotor = lumped(dict.fromkeys(axes, 2.0), [(axis, None, 800.0, 3.0) for axis in axes])
    system = VibrationSystem(with_rotors(rotor, [RotatingDamper(*axes, 1.5)]), speed=speed)
    system.add(da.HarmonicForce("d.x", 1.0))
    # The threshold is 20 rad/s (1 + 3/1.5) = 60 rad/s; the highest excitation is 70 rad/s.
    curve = frequency_response(system, np.array([50.0, 70.0]) / (2 * np.pi), HarmonicBalance(1))
    findings = [finding for finding in curve.findings if finding.code == "unstable-rotor"]
    assert bool(findings) == unstable
    for finding in findings:
        assert finding.values["speed"] == 70.0
        # m λ² + (c_o + c_i) λ + k - i Ω c_i = 0
        root = max(np.roots([2.0, 4.5, 800.0 - 1j * 70.0 * 1.5]), key=lambda value: value.real)
        assert finding.values["growth"] == pytest.approx(root.real, rel=1e-9)
        assert finding.values["frequency"] == pytest.approx(abs(root.imag) / (2 * np.pi), rel=1e-9)


def test_a_path_that_leaves_its_range_is_not_complete():
    # A softening spring: from between its folds, the path passes the upper one, leaves the range, and returns.
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.02)]))
    system.add(da.HarmonicForce("m", 0.05))
    system.add(da.CubicSpring("soft", "m", stiffness=-0.05))
    whole = frequency_response(system, (0.17, 0.1), METHOD, continuation="arc-length", check=False)
    assert whole.complete
    middle = float(whole.folds.mean())
    part = frequency_response(system, (middle, 0.17), METHOD, continuation="arc-length", check=False)
    assert "left-range" in {finding.code for finding in part.findings}
    assert part.converged.all()
    assert not part.complete
