"""Stability of points of a curve, the markers of its changes, and how they are kept."""

from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.forward import Checkpoint
from dalembert.structure import Dofs, Structure, lumped
from dalembert.vibration import (
    BilinearStop,
    CubicSpring,
    ElasticSlider,
    FrequencyCurve,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    Rigid,
    StaticForce,
    UserLaw,
    VibrationSystem,
    floquet_multipliers,
    frequency_response,
)
from dalembert.vibration.stability import stability
from support import says
from vibrating_systems import duffing, one_mass, pressed_blocks, two_masses

TURN = 2 * np.pi


def drag(u, v, z, numbers, force):
    """Force by the square of the velocity."""
    force[0] = numbers[0] * v[0] * (v[0] if v[0].real > 0 else -v[0])


def springs_and_slider(mass: float = 1.0) -> VibrationSystem:
    """Three masses, the middle one with a slider and some mass; a cubic spring and a drag at the last."""
    names = ("a", "b", "c")
    places = [("a", None), ("a", "b"), ("b", "c")]
    structure = lumped(dict.fromkeys(names, 1.0) | {"b": mass}, [(*ends, 1.0, 0.03) for ends in places])
    system = VibrationSystem(structure)
    system.add(HarmonicForce("c", 0.8))
    system.add(FrictionContact("slider", "b", friction=0.4, preload=0.5, law=ElasticSlider(2.0)))
    system.add(CubicSpring("cubic", "c", stiffness=0.4))
    system.add(UserLaw("drag", "c", function=drag, values=[0.05]))
    return system


@pytest.mark.parametrize(
    ("posed", "unstable", "error"),
    [
        (springs_and_slider, 0, 1e-7),
        # Without mass both take backward differences, of different coordinates: an error of the steps.
        (lambda: springs_and_slider(0.0), 0, 1e-4),
        (pressed_blocks, 1, 1e-7),
    ],
)
def test_multipliers_by_receptances_are_those_by_dynamic_stiffnesses(posed, unstable: int, error: float) -> None:
    system, frequencies = posed(), np.array([0.13, 0.2, 0.3])
    stiff, modal = (
        frequency_response(
            system, frequencies, HarmonicBalance(5, samples=512, solver=solver), stability=True, check=False
        )
        for solver in ("stiffness", "receptance")
    )
    np.testing.assert_array_equal(stiff.stable, modal.stable)
    assert np.sum(stiff.stable == 0) == unstable
    for point in range(3):
        first, other = (floquet_multipliers(system, curve, point) for curve in (stiff, modal))
        np.testing.assert_allclose(np.abs(first[:6]), np.abs(other[:6]), rtol=error)


def test_rigid_contacts_take_part_in_the_multipliers_of_a_curve_by_receptances() -> None:
    system = VibrationSystem(lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.05), ("a", "b", 1.0, 0.05)]))
    system.add(HarmonicForce("a", 1.0))
    system.add(FrictionContact("foot", "b", friction=0.3, preload=0.5, law=Rigid()))
    first, other = (
        floquet_multipliers(
            system, frequency_response(system, np.array([0.13]), HarmonicBalance(5, solver=solver), check=False), 0
        )
        for solver in ("stiffness", "receptance")
    )
    np.testing.assert_allclose(np.abs(first), np.abs(other), rtol=1e-6)


def test_a_motion_whose_disturbances_are_forgotten_is_stable() -> None:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.3)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("slider", "m", friction=0.5, preload=1.0, law=ElasticSlider(0.8)))
    curve = frequency_response(system, np.array([0.002]), HarmonicBalance(3), stability=True, check=False)
    assert curve.stable.tolist() == [1]


def test_motions_of_too_many_contacts_have_no_label(monkeypatch) -> None:
    monkeypatch.setattr("dalembert.vibration.stability.stability.MOST_ROWS", 1)
    monkeypatch.setattr("dalembert.vibration.stability.bifurcations.MOST_ROWS", 1)
    method = HarmonicBalance(5, solver="receptance")
    curve = frequency_response(springs_and_slider(), np.array([0.13, 0.2]), method, stability=True, check=False)
    assert curve.stable.tolist() == [-1, -1]
    with pytest.raises(InputError, match=r"floquet_multipliers: more than \d+ displacements of contacts slip or open"):
        floquet_multipliers(springs_and_slider(), curve, 0)
    finding = next(finding for finding in curve.findings if finding.code == "stability-many-contacts")
    assert finding.message == (
        "The stability of 2 points between 0.13 and 0.2 Hz is not known: more than 1 displacements of contacts slip or "
        "open there."
    )


METHOD = HarmonicBalance(5)


@pytest.fixture(scope="module")
def duffings_curve() -> FrequencyCurve:
    ends = 0.8 / TURN, 1.6 / TURN
    return frequency_response(duffing(), ends, METHOD, continuation="arc-length", stability=True)


def test_a_curve_is_unstable_between_its_folds(duffings_curve: FrequencyCurve) -> None:
    kinds, (first, last) = zip(*duffings_curve.markers, strict=True)
    assert kinds == ("fold", "fold")
    between = np.zeros(len(duffings_curve), dtype=bool)
    between[first + 1 : last + 1] = True
    np.testing.assert_array_equal(duffings_curve.stable == 0, between)
    np.testing.assert_array_equal(np.flatnonzero(duffings_curve.fold), [first, last])
    assert "stable points" in duffings_curve.facts()


def test_stability_is_kept_with_a_curve(duffings_curve: FrequencyCurve, tmp_path: Path) -> None:
    duffings_curve.save(tmp_path / "curve.nc")
    again = FrequencyCurve.load(tmp_path / "curve.nc")
    assert again.markers == duffings_curve.markers
    assert again.stable.dtype == np.int8
    np.testing.assert_array_equal(again.stable, duffings_curve.stable)


@pytest.mark.parametrize(("system", "way"), [(duffing, "hill"), (two_masses, "_by_time_map")])
def test_stability_that_is_known_is_not_found_again(system, way: str, tmp_path: Path, monkeypatch) -> None:
    def follow(**options) -> FrequencyCurve:
        ends = 0.8 / TURN, 1.6 / TURN
        return frequency_response(system(), ends, METHOD, continuation="arc-length", stability=True, **options)

    found, find = [], getattr(stability, way)

    def counted(problem, solution):
        found.append(solution.unknowns.tobytes() + np.float64(solution.omega).tobytes())
        if len(found) == 12:
            raise KeyboardInterrupt
        return find(problem, solution)

    undisturbed = follow().to_xarray()
    monkeypatch.setattr(stability, way, counted)
    with pytest.raises(KeyboardInterrupt), Checkpoint(tmp_path / "checkpoint") as checkpoint:
        follow(checkpoint=checkpoint)
    for _ in range(2):
        with Checkpoint(tmp_path / "checkpoint") as checkpoint:
            assert follow(checkpoint=checkpoint).to_xarray().identical(undisturbed)
    assert len(found) == len(set(found)) + 1  # the one that the interruption hit


def test_without_asking_only_folds_are_marked() -> None:
    ends = 0.8 / TURN, 1.6 / TURN
    curve = frequency_response(duffing(), ends, METHOD, continuation="arc-length")
    assert [kind for kind, _ in curve.markers] == ["fold", "fold"]
    assert set(curve.stable) == {-1}


def test_a_slider_is_stable_and_points_that_are_not_found_are_not_judged() -> None:
    hard = HarmonicBalance(5, samples=128, iterations=2, halvings=0)
    curve = frequency_response(one_mass(), np.linspace(0.05, 0.3, 6), hard, stability=True)
    np.testing.assert_array_equal(curve.stable, np.where(curve.converged, 1, -1))


@pytest.mark.parametrize("odd_only", [False, True])
def test_no_point_behind_a_fold_is_stable_by_perturbations_of_a_motion_before_its_fold(odd_only: bool) -> None:
    """Between two folds of one degree of freedom a real multiplier is above 1.

    The fold with one harmonic is before that of the perturbations, which all harmonics of the stop enter.
    """
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.05)]))
    system.add(HarmonicForce("m", 0.18))
    system.add(BilinearStop("stop", "m", stiffness=5.0, gap=0.5))
    system.add(FrictionContact("slider", "m", friction=0.5, preload=0.05, law=ElasticSlider(0.8)))
    ends = 0.8 / TURN, 2.5 / TURN

    def follow(harmonics: int) -> FrequencyCurve:
        return frequency_response(
            system, ends, HarmonicBalance(harmonics, odd_only), continuation="arc-length", stability=True, check=False
        )

    curve = follow(1)
    first, last = np.flatnonzero(curve.fold)
    unknown = np.flatnonzero(curve.stable < 0)
    assert [kind for kind, _ in curve.markers] == ["fold", "fold"]
    assert np.all(curve.stable[first + 1 : last] <= 0)
    assert np.all(curve.stable[[*range(first), *range(last + 1, len(curve))]] == 1)
    (finding,) = curve.findings
    assert (finding.code, finding.severity) == ("stability-near-fold", "warning")
    apart = np.abs(curve.frequencies[unknown, None] - curve.folds).min(axis=1) > 1e-5 * curve.frequencies[unknown]
    places = curve.frequencies[unknown[apart]]
    assert finding.values == {
        "points": len(places), "lowest": places.min(), "highest": places.max(), "harmonics": 1,
    }  # fmt: skip
    assert finding.message == (
        f"The stability of {len(places)} points between 0.249457 and {places.max():.6g} Hz is not known: a fold lies at another "
        "frequency with 1 harmonic than with more."
    )
    finer = follow(9)
    assert not finer.findings
    assert np.all(finer.stable >= 0)


def test_with_given_frequencies_the_first_point_behind_a_change_is_marked() -> None:
    omegas = np.linspace(1.3, 1.1, 11)
    curve = frequency_response(pushed(), omegas / TURN, HarmonicBalance(9), stability=True)
    (kind, point), *others = curve.markers
    assert (kind, others) == ("period doubling", [])
    np.testing.assert_array_equal(curve.stable, np.arange(11) < point)
    assert omegas[point] < 1.2279 < omegas[point - 1]


def pushed() -> VibrationSystem:
    """The oscillator of the verification whose period doubles below 1.2279 rad/s."""
    structure = Structure(np.eye(1), np.zeros((1, 1)), Dofs(("m.x",)), damping=np.array([[0.05]]))
    system = VibrationSystem(structure)
    system.add(StaticForce("m", 0.03))
    system.add(HarmonicForce("m", 0.16))
    system.add(CubicSpring("cubic", "m", stiffness=1.0))
    return system


def sharing() -> VibrationSystem:
    structure = Structure(np.ones((2, 2)), np.diag([1.0, 2.0]), Dofs(("a.x", "b.x")), damping=0.1 * np.eye(2))
    system = VibrationSystem(structure)
    system.add(HarmonicForce("a", 1.0))
    system.add(FrictionContact("foot", "a", friction=0.3, preload=1.0, law=ElasticSlider(1.0)))
    return system


def test_the_map_over_a_period_needs_masses_of_their_own() -> None:
    sentence = (
        "stability: some degrees of freedom with contacts have a mass only together with others; give each a mass"
    )
    with pytest.raises(InputError, match=says(sentence)):
        frequency_response(sharing(), np.array([0.1]), METHOD, stability=True)


def test_multipliers_are_refused_where_they_make_no_sense(duffings_curve: FrequencyCurve) -> None:
    sentence = "floquet_multipliers: unknown way 'times map'; did you mean 'time map'?"
    with pytest.raises(InputError, match=says(sentence)):
        floquet_multipliers(duffing(), duffings_curve, 0, "times map")
    sentence = (
        "floquet_multipliers: the start has unknowns of shape (1, 11) and harmonics (0, 1, 2, 3, 4, 5); the system has "
        "(2, 11) and (0, 1, 2, 3, 4, 5); start from a curve of the same system"
    )
    with pytest.raises(InputError, match=says(sentence)):
        floquet_multipliers(both(), duffings_curve, 0)


def both() -> VibrationSystem:
    system = two_masses()
    system.add(CubicSpring("cubic", "m1", stiffness=1.0))
    return system
