"""Nonlinear modes: how they are kept, followed and refused; against numbers in tests/verification."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import InputError, SolveError
from dalembert.forward import Checkpoint
from dalembert.structure import lumped
from dalembert.vibration import (
    Backbone,
    CubicSpring,
    ElasticSlider,
    FrictionContact,
    Gap,
    HarmonicBalance,
    StaticForce,
    UserElement,
    VibrationSystem,
    backbone,
)
from dalembert.vibration.modes.mode_equations import ModeEquations
from support import says
from vibrating_systems import chain, duffing, two_masses

METHOD = HarmonicBalance(5)


def pressed_pair() -> VibrationSystem:
    """Two masses with two directions each, the first one pressed on the ground, with friction and a varying load."""
    names = [f"{node}.{axis}" for node in "ab" for axis in "xz"]
    springs = [(f"a.{axis}", None, 1.0, 0.02) for axis in "xz"] + [
        (f"a.{axis}", f"b.{axis}", 1.0, 0.02) for axis in "xz"
    ]
    springs += [("a.x", "b.z", 0.3, 0.0)]
    system = VibrationSystem(lumped(dict.fromkeys(names, 1.0), springs))
    system.add(StaticForce("a.z", 2.0))
    law = ElasticSlider(1.5, normal_stiffness=2.0)
    system.add(FrictionContact("foot", "a", normal="z", friction=0.5, law=law))
    return system


def test_a_backbone_is_kept_to_the_bit(tmp_path: Path) -> None:
    found = backbone(two_masses(), np.geomspace(0.1, 10.0, 5), 1, METHOD)
    found.save(tmp_path / "mode.nc")
    again = Backbone.load(tmp_path / "mode.nc")
    assert (again.mode, again.dof, again.dofs, again.orders) == (1, found.dof, found.dofs, found.orders)
    assert again.provenance == found.provenance
    np.testing.assert_array_equal(again.shapes, found.shapes)
    np.testing.assert_array_equal(again.damping, found.damping)
    assert again.summary() == found.summary()
    assert again.converged.dtype == bool


def test_a_linear_structure_keeps_its_modes() -> None:
    system = VibrationSystem(lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.02), ("a", "b", 1.0, 0.02)]))
    system.add(Gap("far away", "a", stiffness=1.0, gap=1e6))
    for mode, omega in ((1, np.sqrt((3 - np.sqrt(5)) / 2)), (2, np.sqrt((3 + np.sqrt(5)) / 2))):
        found = backbone(system, np.array([1e-3, 1.0]), mode, METHOD)
        np.testing.assert_allclose(2 * np.pi * found.frequencies, omega, rtol=1e-12)
        np.testing.assert_allclose(found.damping, 0.01 * omega, rtol=1e-9)  # C = 0.02 K


def test_a_mode_swings_about_the_position_that_static_forces_give() -> None:
    """A stop that a static force presses on is a spring as long as it stays closed."""
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.0)]))
    system.add(Gap("stop", "m", stiffness=3.0))
    system.add(StaticForce("m", 8.0))
    found = backbone(system, np.array([0.5, 1.5]), method=METHOD)
    np.testing.assert_allclose(2 * np.pi * found.frequencies, 2.0, rtol=1e-12)
    np.testing.assert_allclose(found.shapes[:, 0, 0], 2.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("posed", "direct"), [(two_masses, 120), (two_masses, 0), (chain, 120), (pressed_pair, 120), (pressed_pair, 0)]
)
def test_a_mode_by_receptances_is_that_by_dynamic_stiffnesses(posed, direct: int, monkeypatch) -> None:
    monkeypatch.setattr("dalembert.vibration.balance.receptance_tangent.DIRECT", direct)
    paths = [
        backbone(posed(), (0.1, 2.0), 2, HarmonicBalance(5, samples=256, solver=solver))
        for solver in ("stiffness", "receptance")
    ]
    assert all(path.converged.all() for path in paths)
    given = np.geomspace(0.12, 1.9, 4)
    for name in ("frequencies", "damping", "energies"):
        first, other = (np.interp(given, path.amplitudes, getattr(path, name)) for path in paths)
        np.testing.assert_allclose(first, other, rtol=5e-3)  # between points of both paths
    ends = [np.array([path.frequencies[-1], path.damping[-1], path.energies[-1]]) for path in paths]
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-8)
    np.testing.assert_allclose(paths[0].shapes[-1], paths[1].shapes[-1], rtol=0, atol=1e-8)


def test_a_part_that_only_a_nonlinear_spring_holds_has_no_mode_by_receptances() -> None:
    system = VibrationSystem(lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.02)]))
    system.add(CubicSpring("e", "a", "b", stiffness=1.0))
    with pytest.raises(SolveError, match=r"backbone: a part moves freely at rest.*solver='stiffness'"):
        backbone(system, np.array([0.1]), 1, replace(METHOD, solver="receptance"))


def test_an_element_that_couples_displacements_is_refused_by_receptances() -> None:
    system = VibrationSystem(lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.02), ("b", None, 2.0, 0.02)]))
    system.add(UserElement("user", ["a.x", "b.x"], lambda u: np.stack([0.5 * u[1], 0.5 * u[0]])))
    with pytest.raises(InputError, match="couples several displacements at rest"):
        backbone(system, np.array([0.1]), 1, replace(METHOD, solver="receptance"))


def test_a_mode_about_a_stop_that_a_static_force_closes_by_receptances() -> None:
    """The linear mode has the stiffness of the stop, though this is not among the contacts that stick."""
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.02)]))
    system.add(Gap("stop", "m", stiffness=3.0))
    system.add(StaticForce("m", 8.0))
    found = backbone(system, np.array([0.5, 1.5]), method=replace(METHOD, solver="receptance"))
    np.testing.assert_allclose(2 * np.pi * found.frequencies, 2.0, rtol=1e-12)
    np.testing.assert_allclose(found.damping, 0.005, rtol=1e-9)
    np.testing.assert_allclose(found.shapes[:, 0, 0], 2.0, rtol=1e-12)


def test_the_largest_motion_is_the_measure_unless_another_is_named() -> None:
    assert backbone(two_masses(), np.array([0.1]), 1, METHOD).dof == "m1.x"
    assert backbone(two_masses(), np.array([0.1]), 1, METHOD, dof="m2.x").dof == "m2.x"


def test_a_path_between_two_amplitudes_holds_its_ends_and_agrees_with_given_amplitudes() -> None:
    path = backbone(duffing(), (0.1, 3.0), method=METHOD)
    assert path.converged.all()
    assert (path.amplitudes[0], path.amplitudes[-1]) == (0.1, 3.0)
    given = backbone(duffing(), path.amplitudes, method=METHOD)
    np.testing.assert_allclose(given.frequencies, path.frequencies, rtol=1e-8)
    np.testing.assert_allclose(given.damping, path.damping, rtol=1e-7)


def test_a_path_leads_through_the_begin_of_slip() -> None:
    path = backbone(two_masses(), (0.1, 10.0), method=METHOD)
    assert path.converged.all()
    assert path.amplitudes[-1] == 10.0
    assert path.damping.max() > 5 * path.damping[0]


def test_given_amplitudes_do_not_jump_to_another_mode() -> None:
    given = backbone(chain(), np.array([0.6, 0.9, 1.1]), method=METHOD)
    np.testing.assert_array_equal(given.converged, [True, False, False])
    assert [row[-1].text for row in given.tables()[0].rows] == ["", "not found", "not found"]


def test_a_path_that_turns_back_before_its_end_says_so(tmp_path: Path) -> None:
    """An internal resonance of the chain turns the path of its first mode back at 0.744 m."""
    path = backbone(chain(), (0.6, 1.1), method=METHOD)
    assert path.converged.all()
    (finding,) = path.doubts
    assert (finding.code, finding.severity) == ("end-not-reached", "warning")
    assert finding.values["reason"] == "fold"
    assert (finding.values["last"], finding.values["end"]) == (0.6, 1.1)
    assert finding.values["farthest"] == path.amplitudes.max() == pytest.approx(0.74436, abs=1e-4)
    assert finding.message in path.summary()
    assert path.status == (
        f"Mode 1 was found at {len(path)} points of a path over the amplitude of {path.dof}, which came to "
        f"{path.amplitudes.max():.6g} m and not to 1.1 m."
    )
    path.save(tmp_path / "mode.nc")
    assert Backbone.load(tmp_path / "mode.nc").findings == path.findings
    assert not backbone(duffing(), (0.1, 0.2), method=METHOD).findings


def test_a_path_without_a_first_motion_is_one_point_that_is_not_found() -> None:
    path = backbone(two_masses(), (0.1, 10.0), method=HarmonicBalance(5, iterations=1, halvings=0))
    assert path.converged.tolist() == [False]
    assert path.amplitudes[0] == 0.1
    assert path.doubts[0].values["reason"] == "stopped"


@pytest.mark.parametrize("amplitudes", [(0.1, 10.0), np.geomspace(0.1, 10.0, 8)], ids=["path", "given"])
def test_a_mode_that_was_interrupted_goes_on_where_it_was(amplitudes, tmp_path: Path, monkeypatch) -> None:
    solve, turn, places, left = ModeEquations.newton, ModeEquations.tangent, [], [5]

    def limited(own: ModeEquations, guess, plane, samples: int):
        places.append(guess.harmonics.tobytes() + plane.direction.tobytes() + bytes([samples.bit_length()]))
        if not left[0]:
            raise KeyboardInterrupt
        left[0] -= 1
        return solve(own, guess, plane, samples)

    def turned(own: ModeEquations, motion, before):
        places.append(motion.harmonics.tobytes() + before.tobytes())
        return turn(own, motion, before)

    undisturbed = backbone(two_masses(), amplitudes, 1, METHOD).to_xarray()
    monkeypatch.setattr(ModeEquations, "newton", limited)
    monkeypatch.setattr(ModeEquations, "tangent", turned)
    with pytest.raises(KeyboardInterrupt), Checkpoint(tmp_path / "checkpoint") as checkpoint:
        backbone(two_masses(), amplitudes, 1, METHOD, checkpoint=checkpoint)
    left[0] = 10_000
    del places[-1]  # the one that the interruption hit
    for _ in range(2):
        with Checkpoint(tmp_path / "checkpoint") as checkpoint:
            resumed = backbone(two_masses(), amplitudes, 1, METHOD, checkpoint=checkpoint)
        assert resumed.to_xarray().identical(undisturbed)
        assert checkpoint.spared > 0
    assert len(places) == len(set(places))


def free() -> VibrationSystem:
    system = VibrationSystem(lumped({"a": 1.0, "b": 1.0}, [("a", "b", 1.0, 0.0)]))
    system.add(StaticForce("a", 1.0))
    system.add(FrictionContact("foot", "b", friction=0.1, preload=0.1))
    return system


@pytest.mark.parametrize(
    ("system", "amplitudes", "options", "error", "sentence"),
    [
        (duffing(), [-1.0], {}, InputError, "backbone: the amplitudes are [-1.0]; expected positive numbers in m"),
        (
            duffing(),
            (1.0, 1.0),
            {},
            InputError,
            "backbone: the ends are (1.0, 1.0); expected two different amplitudes in m",
        ),
        (
            duffing(),
            [1.0],
            {"mode": 2},
            InputError,
            "backbone: mode 2 is asked for; expected 1 to 1, as many as the system has where its contacts stick",
        ),
        (duffing(), [1.0], {"dof": "n"}, InputError, "unknown degree of freedom 'n'; known: m.x"),
        (
            free(),
            [1.0],
            {},
            SolveError,
            "backbone: the static forces found no balance; give smaller ones, or hold the structure",
        ),
    ],
)
def test_what_cannot_be_meant_is_told(system, amplitudes, options, error, sentence: str) -> None:
    with pytest.raises(error, match=says(sentence)):
        backbone(system, amplitudes, method=METHOD, **options)
