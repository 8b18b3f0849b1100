"""Branches that leave a curve, beside integration in time; motions of several periods."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import dalembert as da
from dalembert.errors import InputError
from dalembert.vibration import HarmonicBalance, VibrationSystem, follow_branch, frequency_response
from support import says

DAMPING = 0.1


def duffing() -> VibrationSystem:
    system = VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, DAMPING)]))
    system.add(da.HarmonicForce("m", 4.0))
    system.add(da.CubicSpring("k3", "m", stiffness=1.0))
    return system


def stopped() -> VibrationSystem:
    """A mass that touches a spring on one side."""
    system = VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, DAMPING)]))
    system.add(da.HarmonicForce("m", 1.0))
    system.add(da.Gap("stop", "m", stiffness=4.0, gap=0.0))
    return system


LAWS = {
    "duffing": (duffing, lambda x: x + x**3, 4.0, (0.1, 0.3), "branch point", HarmonicBalance(15)),
    "stopped": (stopped, lambda x: x + 4 * max(0.0, x), 1.0, (0.3, 0.45), "period doubling", HarmonicBalance(9)),
}


@pytest.mark.parametrize("case", LAWS)
def test_a_branch_is_a_motion_in_time(case):
    build, force, level, ends, kind, method = LAWS[case]
    system = build()
    curve = frequency_response(system, ends, method, continuation="arc-length", stability=True)
    assert next(marker for marker, _ in curve.markers if marker in ("branch point", "period doubling")) == kind
    branch = follow_branch(system, curve, between=ends, stability=True)
    assert branch.converged.all()
    assert branch.provenance["branch"] == kind
    periods = 2 if kind == "period doubling" else 1
    assert branch.provenance["method"]["periods"] == periods
    stable = np.flatnonzero(branch.stable == 1)
    point = int(stable[len(stable) // 2])
    omega = 2 * np.pi * branch.frequencies[point]
    period = 2 * np.pi * periods / omega
    # From the motion itself, 40 periods later it is still there.
    start = branch.motion("m", point, np.array([0.0, 1e-4, -1e-4]))
    speed = (start[1] - start[2]) / 2e-4 * omega / periods
    moved = solve_ivp(
        lambda t, y: [y[1], level * np.cos(omega * t) - DAMPING * y[1] - force(y[0])],
        (0.0, 40 * period), [start[0], speed], rtol=1e-8, atol=1e-10, dense_output=True,
    )  # fmt: skip
    later = moved.sol(39 * period + np.linspace(0, period, 201))[0]
    expected = branch.motion("m", point, np.linspace(0, 2 * np.pi, 201))
    assert np.abs(later - expected).max() < 3e-3 * np.abs(expected).max()
    # It is another motion than that of the curve.
    if periods == 2:
        assert np.abs(later[:101] - later[100:]).max() > 0.02 * np.abs(expected).max()
    else:
        assert np.abs(branch.harmonics("m")[point, 0]) > 0.01 * np.abs(expected).max()


@pytest.mark.parametrize("number", [0, 1])
def test_a_branch_between_two_branch_points_ends_at_the_other_one(number):
    system = duffing()
    curve = frequency_response(system, (0.12, 0.3), HarmonicBalance(7), continuation="arc-length", stability=True)
    branch = follow_branch(system, curve, number)
    [finding] = [finding for finding in branch.findings if finding.code == "end-not-reached"]
    assert finding.values["reason"] == "joined"
    assert not branch.complete
    ends = [curve.frequencies[point] for kind, point in curve.markers if kind == "branch point"]
    assert branch.frequencies[0] == pytest.approx(ends[number], rel=1e-2)
    assert branch.frequencies[-1] == pytest.approx(ends[1 - number], rel=2e-2)


def test_a_motion_of_several_periods_contains_that_of_one():
    frequencies = np.array([0.2, 0.25])
    single = frequency_response(stopped(), frequencies, HarmonicBalance(5, samples=256))
    double = frequency_response(stopped(), frequencies, HarmonicBalance(5, samples=256, periods=2))
    assert double.orders == tuple(range(11))
    np.testing.assert_allclose(double.frequencies, frequencies)
    phases = np.linspace(0, 2 * np.pi, 50)
    for point in range(2):
        expected = single.motion("m", point, phases)
        np.testing.assert_allclose(double.motion("m", point, phases / 2), expected, atol=2e-3 * np.abs(expected).max())
    again = frequency_response(stopped(), frequencies, HarmonicBalance(5, samples=256, periods=2), start=(double, 1))
    np.testing.assert_allclose(again.unknowns[1], double.unknowns[1], atol=1e-9)


def test_what_takes_no_motion_of_several_periods():
    method = HarmonicBalance(3, periods=2)
    words = "periods of the harmonic balance is 2, which only frequency_response and follow_branch take. Use periods=1"
    with pytest.raises(InputError, match=says(f"backbone: {words}")):
        da.backbone(duffing(), np.array([0.1]), method=method)
    with pytest.raises(InputError, match=says(f"track_resonance: {words}")):
        da.track_resonance(lambda force: duffing(), "force", [1.0], (0.1, 0.2), method, dof="m")
    with pytest.raises(InputError, match=says("HarmonicBalance: odd_only=True, but a motion of several periods has all harmonics. Use odd_only=False")):  # fmt: skip
        HarmonicBalance(3, odd_only=True, periods=2)


def test_a_branch_that_is_not_there():
    curve = frequency_response(duffing(), np.array([0.1]), HarmonicBalance(3))
    words = (
        "follow_branch: bifurcation 0 is asked for, and the curve has 0 markers 'branch point' or 'period doubling'. "
        "Follow it by arc length with stability=True, or choose another number"
    )
    with pytest.raises(InputError, match=says(words)):
        follow_branch(duffing(), curve)
