"""Motions side by side at a frequency, and isolated branches, against closed forms of one harmonic."""

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError
from dalembert.vibration import (
    HarmonicBalance,
    VibrationSystem,
    coexisting_motions,
    frequency_response,
    isolated_branches,
)
from support import says

ONE = HarmonicBalance(1)
LINEAR, CUBIC, QUINTIC, FORCE = 0.1, -0.1, 0.03, 0.0375


def damper(u, v, z, numbers, force):
    """Force by the third and the fifth power of the velocity."""
    force[0] = numbers[0] * v[0] ** 3 + numbers[1] * v[0] ** 5


def damped(force: float = FORCE) -> VibrationSystem:
    """A mass whose damper takes less at medium speeds: its response has an isolated branch."""
    system = VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, LINEAR)]))
    system.add(da.HarmonicForce("m", force))
    system.add(da.UserLaw("damper", "m", function=damper, values=[CUBIC, QUINTIC]))
    return system


def amplitudes(omega: float) -> np.ndarray:
    """Of all motions of one harmonic: F² = a² ((1 - ω²)² + ω² (c_1 + ¾ c_3 ω² a² + ⅝ c_5 ω⁴ a⁴)²)."""
    square = np.polynomial.Polynomial([0.0, 1.0])
    taken = LINEAR + 0.75 * CUBIC * omega**2 * square + 0.625 * QUINTIC * omega**4 * square**2
    roots = (square * ((1 - omega**2) ** 2 + omega**2 * taken**2) - FORCE**2).roots()
    real = np.real(roots[np.abs(roots.imag) < 1e-9])
    return np.sqrt(np.sort(real[real > 0]))


def end_of_the_branch(outside: float) -> float:
    """Angular frequency between 1 and a place outside where three motions become one, by bisection."""
    inside = 1.0
    for _ in range(50):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if len(amplitudes(middle)) > 1 else (inside, middle)
    return inside


def test_all_motions_of_one_harmonic_are_found():
    frequencies = np.array([0.9, 1.0, 1.1]) / (2 * np.pi)
    motions = coexisting_motions(damped(), frequencies, ONE, stability=True)
    assert motions.converged.all()
    expected = [amplitudes(omega) for omega in (0.9, 1.0, 1.1)]
    assert [len(places) for places in expected] == [1, 3, 1]
    np.testing.assert_allclose(motions.amplitude("m", "harmonic 1"), np.concatenate(expected), rtol=1e-8)
    np.testing.assert_array_equal(motions.stable, [1, 1, 0, 1, 1])
    assert motions.markers == ()


def test_an_isolated_branch_is_closed_and_ends_where_the_closed_form_does():
    motions = coexisting_motions(damped(), [1 / (2 * np.pi)], ONE)
    window = 0.7 / (2 * np.pi), 1.3 / (2 * np.pi)
    outside = frequency_response(damped(), window, ONE, continuation="arc-length", check=False)
    assert outside.amplitude("m").max() < 0.44  # the curve from outside does not come to it
    for start in (1, 2):
        branch = frequency_response(
            damped(), window, ONE, continuation="arc-length", start=(motions, start), check=False
        )
        assert branch.converged.all()
        assert [finding.values["reason"] for finding in branch.findings] == ["closed"]
        assert len(branch) < 100
        found = 2 * np.pi * np.array([branch.frequencies.min(), branch.frequencies.max()])
        np.testing.assert_allclose(found, [end_of_the_branch(0.9), end_of_the_branch(1.1)], rtol=1e-9)


def test_branches_that_a_curve_does_not_pass():
    window = 0.7 / (2 * np.pi), 1.3 / (2 * np.pi)
    curve = frequency_response(damped(), window, ONE, check=False)
    (branch,) = isolated_branches(damped(), curve, [0.95 / (2 * np.pi), 1 / (2 * np.pi)])
    assert [finding.values["reason"] for finding in branch.findings] == ["closed"]
    with pytest.raises(InputError, match="Use frequencies inside a curve between two frequencies"):
        isolated_branches(damped(), curve, [0.3])
    # A range that cuts the branch: both parts, from the motion to each side.
    cut = frequency_response(damped(), (0.7 / (2 * np.pi), 1 / (2 * np.pi)), ONE, check=False)
    parts = isolated_branches(damped(), cut, [0.998 / (2 * np.pi)])
    assert min(part.frequencies.min() for part in parts) == pytest.approx(end_of_the_branch(0.9) / (2 * np.pi))
    assert max(part.frequencies.max() for part in parts) == pytest.approx(1 / (2 * np.pi))


@pytest.mark.parametrize("solver", ["stiffness", "receptance"])
def test_motions_beside_a_resonance_with_friction(solver):
    system = VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.02)]))
    system.add(da.HarmonicForce("m", 0.3))
    system.add(da.CubicSpring("k", "m", stiffness=0.1))
    system.add(da.FrictionContact("slider", "m", friction=0.5, preload=0.1, law=da.ElasticSlider(1.0)))
    method = HarmonicBalance(5, solver=solver)
    motions = coexisting_motions(system, [0.21], method)
    upwards, downwards = (
        frequency_response(system, path, method, check=False).amplitude("m")[-1] for path in ((0.12, 0.21), (0.3, 0.21))
    )
    np.testing.assert_allclose(motions.amplitude("m")[[0, -1]], [downwards, upwards], rtol=1e-6)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"most": 1.0}, "coexisting_motions: most is 1.0; expected a factor above 1, such as 10"),
        ({"method": HarmonicBalance(harmonics="auto")}, 'coexisting_motions: harmonics is "auto"; expected a number'),
    ],
)
def test_what_makes_no_sense_is_refused(options, message):
    with pytest.raises(InputError, match=says(message)):
        coexisting_motions(damped(), [0.16], **options)
