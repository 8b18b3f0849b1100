"""Curves over frequency: what is kept, how they go on, and what is refused."""

import gc
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import csc_array

from dalembert.errors import InputError, ModelError
from dalembert.structure import lumped
from dalembert.vibration import (
    ElasticSlider,
    FollowedPoint,
    FrequencyCurve,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    Iwan,
    Rigid,
    StaticForce,
    VibrationSystem,
    frequency_response,
)
from dalembert.vibration.balance.newton import Solution
from support import says
from vibrating_systems import duffing, one_mass, two_masses

FREQUENCIES = np.linspace(0.1, 0.25, 7)
METHOD = HarmonicBalance(5, samples=128)


def test_a_curve_is_kept_to_the_bit(tmp_path: Path) -> None:
    curve = frequency_response(two_masses(), FREQUENCIES, METHOD)
    curve.save(tmp_path / "curve.nc")
    again = FrequencyCurve.load(tmp_path / "curve.nc")
    assert (again.dofs, again.contacts, again.orders) == (curve.dofs, curve.contacts, curve.orders)
    assert again.provenance == curve.provenance
    np.testing.assert_array_equal(again.response, curve.response)
    np.testing.assert_array_equal(again.states, curve.states)
    assert again.converged.dtype == bool
    assert again.summary() == curve.summary()


def test_points_that_are_not_found_are_marked_and_the_curve_goes_on() -> None:
    hard = HarmonicBalance(5, samples=128, iterations=2, halvings=0)
    curve = frequency_response(one_mass(), np.linspace(0.05, 0.3, 6), hard)
    assert len(curve) == 6
    assert 0 < curve.converged.sum() < 6
    assert np.all(curve.residuals[~curve.converged] > hard.tolerance)
    assert np.isnan(curve.response[~curve.converged]).all()
    assert "Points that were not found" in curve.summary()


def test_the_samples_are_doubled_until_they_are_enough() -> None:
    curve = frequency_response(one_mass(), np.array([0.17]), HarmonicBalance(5, sampling=1e-5, events=False))
    assert curve.samples[0] > 64
    assert curve.sampling_errors[0] <= 1e-5
    fine = frequency_response(one_mass(), np.array([0.17]), HarmonicBalance(5, samples=4096))
    assert curve.amplitude("m")[0] == pytest.approx(fine.amplitude("m")[0], rel=1e-4)


def test_a_curve_restarts_from_a_point_of_another() -> None:
    """The upper branch of the Duffing oscillator is found from below, and kept on the way back."""
    method = HarmonicBalance(5)
    up = frequency_response(duffing(), np.linspace(0.12, 0.195, 16), method)
    again = frequency_response(duffing(), np.array([0.195, 0.19]), method, start=(up, len(up) - 1))
    fresh = frequency_response(duffing(), np.array([0.195]), method)
    assert again.amplitude("m")[0] == pytest.approx(up.amplitude("m")[-1])
    assert fresh.amplitude("m")[0] < 0.5 * again.amplitude("m")[0]


def test_odd_harmonics_are_enough_for_a_symmetric_system() -> None:
    odd = frequency_response(one_mass(), FREQUENCIES, HarmonicBalance(7, odd_only=True, samples=256))
    every = frequency_response(one_mass(), FREQUENCIES, HarmonicBalance(7, samples=256))
    np.testing.assert_allclose(odd.amplitude("m"), every.amplitude("m"), rtol=1e-9)


def test_cells_side_by_side_with_one_stiffness_are_one_slider() -> None:
    together = frequency_response(two_masses(ElasticSlider(1.5)), FREQUENCIES, METHOD)
    apart = frequency_response(two_masses(Iwan((0.6, 0.9), (0.4, 0.6))), FREQUENCIES, METHOD)  # type: ignore[arg-type]
    np.testing.assert_allclose(apart.amplitude("m2"), together.amplitude("m2"), rtol=1e-9)


def free_mass(*parts, massless: bool = False) -> VibrationSystem:
    masses, springs = {"a": 1.0, "b": 1.0}, [("a", "b", 1.0, 0.01)]
    if massless:
        masses, springs = {**masses, "c": 0.0, "d": 0.0}, [*springs, ("c", "d", 1.0, 0.0)]
    system = VibrationSystem(lumped(masses, springs))
    for part in parts:
        system.add(part)
    return system


FORCE = HarmonicForce("a", 1.0)
CONTACT = {"friction": 0.3, "preload": 1.0}


@pytest.mark.parametrize(
    ("system", "options", "error", "sentence"),
    [
        (
            free_mass(FORCE, StaticForce("b", 2.0), StaticForce("a", -1.0)),
            {},
            ModelError,
            "a mean force of 0.707 N acts along 'a.x' and 'b.x', where no spring and no contact holds the structure, "
            "so it has no periodic motion; clamp it, or balance the static forces",
        ),
        (
            free_mass(FORCE, massless=True),
            {},
            ModelError,
            "the structure can move freely, at 'a.x', 'b.x', 'c.x' and 'd.x', without a mass, a spring or a contact "
            "that holds it, so its motion is not determined; clamp it, or give it mass",
        ),
        (
            free_mass(FORCE, FrictionContact("foot", "c", **CONTACT)),
            {},
            InputError,
            "contact 'foot': unknown degree of freedom 'c.x'; did you mean 'b.x' or 'a.x'?",
        ),
        (
            free_mass(HarmonicForce("d", 1.0)),
            {},
            InputError,
            "a force: unknown degree of freedom 'd'; known: a.x, b.x",
        ),
        (
            free_mass(FORCE, *(FrictionContact(name, "a", law=Rigid(), **CONTACT) for name in ("one", "two"))),
            {},
            ModelError,
            "the rigid contact coordinate 'two.x' moves only together with other rigid contacts, so their forces "
            "are not determined. Remove one of them, or choose an elastic law",
        ),
        (
            free_mass(HarmonicForce("a", 1.0, harmonic=9)),
            {"method": HarmonicBalance(1)},
            InputError,
            "the force on 'a' acts in harmonic 9, which is not among the harmonics kept (0, 1); keep more of them",
        ),
        (
            free_mass(FORCE, StaticForce("b", 1.0)),
            {"method": HarmonicBalance(3, odd_only=True)},
            InputError,
            "HarmonicBalance: odd_only=True, but the static force on 'b' causes a mean or even harmonics; "
            "use odd_only=False",
        ),
        (
            free_mass(FORCE),
            {"continuation": "arc-length"},
            InputError,
            "frequency_response: a path by arc length finds its own frequencies; give a tuple of two, (begin, end)",
        ),
        (
            free_mass(FORCE),
            {"continuation": "arc"},
            InputError,
            "frequency_response: unknown continuation 'arc'; known: arc-length, natural",
        ),
    ],
)
def test_what_cannot_be_meant_is_told(system: VibrationSystem, options: dict, error: type, sentence: str) -> None:
    with pytest.raises(error, match=says(sentence)):
        frequency_response(system, np.array([0.1]), **options)


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_a_part_that_nothing_holds_moves_about_its_place(
    sparse: bool, damping: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A chain that is held at its first mass and cut behind the second, in modes and not, and by a sparse solver."""
    names = [f"m{number}" for number in range(8)]
    springs = [(first, second, 1.0, 0.0) for first, second in pairwise(names) if first != "m1"]
    chain = lumped(dict.fromkeys(names, 1.0), [("m0", None, 1.0, damping), *springs])
    matrices = chain.mass, chain.stiffness, chain.damping
    if sparse:
        monkeypatch.setattr("dalembert.vibration.interface.condensation.DENSE", 0)
        chain = replace(chain, mass=csc_array(chain.mass), stiffness=csc_array(chain.stiffness))
    system = VibrationSystem(chain)
    static = np.array([0, 0, 1.0, 0, 0, 0, 0, -1.0])
    for part in (HarmonicForce("m0", 1.0), HarmonicForce("m4", 1.0), StaticForce("m2", 1.0), StaticForce("m7", -1.0)):
        system.add(part)
    curve = frequency_response(system, np.array([0.1]))
    mass, stiffness, viscous = matrices
    omega = 0.2 * np.pi
    moved = np.linalg.solve(
        stiffness - omega**2 * mass + 1j * omega * (0 if viscous is None else viscous), np.eye(8)[0] + np.eye(8)[4]
    )
    np.testing.assert_allclose(curve.response[0, :, 1], moved.real, atol=1e-11)
    np.testing.assert_allclose(curve.response[0, :, 2], -moved.imag, atol=1e-11)
    np.testing.assert_allclose(curve.response[0, :, 0], np.linalg.pinv(stiffness) @ static, atol=1e-11)
    assert curve.findings[0].code == "free-mean-position"
    assert curve.findings[0].severity == "note"
    assert curve.findings[0].message == (
        "No spring and no contact holds the mean position along 'm2.x', 'm3.x', 'm4.x', 'm5.x' and 2 more degrees of "
        "freedom; the smallest one was chosen."
    )


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda: HarmonicBalance(2**62),
            "HarmonicBalance: harmonics is 4.61169e+18; expected a whole number from 1 to 1000",
        ),
        (
            lambda: HarmonicBalance(samples=2**62),
            "HarmonicBalance: 4611686018427387904 samples of a period were asked for; expected at most 1000000",
        ),
        (
            lambda: FrictionContact("foot", "a", friction=0.3, preload=-1.0),
            "FrictionContact 'foot': preload is -1 N; expected zero or a positive number",
        ),
        (
            lambda: FrictionContact("foot", "a", friction=0.3, tangential=("x", "z"), normal="-z"),
            "contact 'foot': the directions are x, z, normal -z; expected one or two tangential ones and another one "
            "for the normal, if any, each x, y or z",
        ),
        (
            lambda: FrictionContact("foot", "a", friction=0.3, normal="z", law=ElasticSlider(1.0)),
            "contact 'foot' has a normal direction; give its law a normal_stiffness in N/m",
        ),
        (
            lambda: FrictionContact("foot", "a", friction=0.3, law=ElasticSlider(0.0)),
            "ElasticSlider: tangential_stiffness is 0 N/m; expected a positive number",
        ),
        (
            lambda: Iwan((1.0, 2.0), (0.5, 0.6)),
            "Iwan: 2 stiffnesses and 2 shares that add up to 1.1 were given; expected one share for each stiffness, "
            "and a sum of 1",
        ),
        (
            lambda: HarmonicBalance(5, samples=10),
            "HarmonicBalance: samples is 10, too few for 5 harmonics. Use at least 11",
        ),
        (
            lambda: HarmonicForce("a", 1.0, harmonic=0),
            "the force on 'a': the harmonic is 0; expected 1 or more, and a StaticForce for a force that does not change",
        ),
    ],
)
def test_parts_that_make_no_sense_are_told(make, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        make()


@pytest.mark.parametrize(
    ("along", "continuation"), [(FREQUENCIES, "natural"), ((0.25, 0.1), "natural"), ((0.12, 0.3), "arc-length")]
)
def test_each_point_is_told_as_it_is_found(along: np.ndarray | tuple[float, float], continuation: str) -> None:
    told: list[FollowedPoint] = []
    system = duffing() if continuation == "arc-length" else two_masses()
    curve = frequency_response(system, along, METHOD, continuation=continuation, on_point=told.append)
    np.testing.assert_array_equal([one.frequency for one in told], curve.frequencies)
    np.testing.assert_array_equal(np.stack([one.response for one in told]), curve.response)
    assert {one.dofs for one in told} == {curve.dofs}
    done = np.array([one.done for one in told])
    assert np.all(np.diff(done) >= 0)
    assert done[0] < 0.2
    assert done[-1] == pytest.approx(1.0)
    assert (continuation == "arc-length") == bool(len(curve.folds))


def test_matrices_of_points_that_are_past_are_let_go() -> None:
    alive: dict[float, int] = {}
    frequencies = np.linspace(0.1, 0.25, 20)

    def count(point: FollowedPoint) -> None:
        if point.done in (0.1, 1.0):
            alive[point.done] = sum(type(one) is Solution for one in gc.get_objects())

    frequency_response(two_masses(), frequencies, METHOD, on_point=count)
    assert alive[1.0] - alive[0.1] < 5
