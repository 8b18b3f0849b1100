"""Held amplitudes and phases, beside closed forms and curves of held forces."""

from dataclasses import replace

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError
from dalembert.structure import Material, box, solid
from dalembert.vibration import HarmonicBalance, HeldAmplitude, VibrationSystem, frequency_response, track_resonance
from support import says

METHOD = HarmonicBalance(7)


def pair(level: float = 1.0, friction: bool = False, static: float = 0.1) -> VibrationSystem:
    """Two masses, a cubic spring at the first, a slider at the second."""
    system = VibrationSystem(da.lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.05), ("a", "b", 1.0, 0.05)]))
    system.add(da.HarmonicForce("a", 0.2 * level))
    if static:
        system.add(da.StaticForce("b", static))
    system.add(da.CubicSpring("k", "a", stiffness=0.5))
    if friction:
        system.add(da.FrictionContact("f", "b", friction=0.3, preload=0.5, law=da.ElasticSlider(1.0)))
    return system


@pytest.mark.parametrize(("friction", "solver"), [(False, "auto"), (True, "stiffness"), (True, "receptance")])
def test_a_held_amplitude_is_that_of_the_force_it_needs(friction, solver):
    frequencies, method = np.linspace(0.05, 0.35, 25), replace(METHOD, solver=solver)
    curve = frequency_response(pair(friction=friction), frequencies, method, control=HeldAmplitude("b", 0.4))
    assert curve.converged.all()
    np.testing.assert_allclose(curve.amplitude("b", "harmonic 1"), 0.4, rtol=1e-9)
    assert curve.load_factors.min() > 0
    assert curve.provenance["control"] == {"dof": "b", "amplitude": 0.4}
    assert curve.coordinates == (("k", "f.x") if friction else ("k",))
    for point in (0, 12, 24):
        # From its motion, the curve of the held force stays there.
        forced = pair(float(curve.load_factors[point]), friction)
        again = frequency_response(forced, frequencies[[point]], METHOD, start=(curve, point))
        np.testing.assert_allclose(again.amplitude("b", "harmonic 1"), 0.4, rtol=1e-8)


def on_the_ground(level: float = 1.0) -> VibrationSystem:
    """Two masses, the second one on a rigid contact."""
    system = VibrationSystem(da.lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.05), ("a", "b", 1.0, 0.05)]))
    system.add(da.HarmonicForce("a", level))
    system.add(da.FrictionContact("foot", "b", friction=0.3, preload=0.5, law=da.Rigid()))
    return system


def test_a_rigid_contact_moves_by_its_displacement_and_not_by_what_its_law_predicts():
    method, held = HarmonicBalance(7, solver="receptance"), HeldAmplitude("b", 0.8)
    curve = frequency_response(on_the_ground(), np.array([0.12, 0.15]), method, control=held)
    np.testing.assert_allclose(curve.amplitude("b", "harmonic 1"), 0.8, rtol=1e-9)
    tracks = [
        track_resonance(
            on_the_ground, "level", [1.0, 1.2], (0.05, 0.2), replace(method, solver=solver), dof="b", kind="harmonic 1"
        )
        for solver in ("stiffness", "receptance")
    ]
    np.testing.assert_allclose(tracks[0].amplitudes, tracks[1].amplitudes, rtol=1e-5)


def test_the_motion_of_a_held_curve_is_that_of_all_degrees_of_freedom():
    plate = solid(box((1.0, 1.0, 0.2), (1, 1, 1)), Material(1e4, 0.3, 100.0))
    fixed = plate.fixed("left").with_damping(da.Rayleigh(mass=1.0))
    system = VibrationSystem(fixed)
    end = next(name for name in fixed.dofs.names if name.endswith(".z")).rpartition(".")[0]
    system.add(da.HarmonicForce(f"{end}.z", 1.0))
    system.add(da.CubicSpring("k", f"{end}.x", stiffness=1.0))
    held = HeldAmplitude(f"{end}.z", 0.01)
    curve = frequency_response(system, np.array([0.5]), METHOD, control=held)
    assert da.deformation(system, curve).coefficients.shape[0] > 0


def test_the_amplitude_of_a_retained_degree_of_freedom_along_a_path(tmp_path):
    curve = frequency_response(pair(), (0.05, 0.35), METHOD, control=HeldAmplitude("a", 0.5))
    assert curve.complete
    np.testing.assert_allclose(curve.amplitude("a", "harmonic 1"), 0.5, rtol=1e-9)
    curve.save(tmp_path / "curve.nc")
    again = da.FrequencyCurve.load(tmp_path / "curve.nc")
    np.testing.assert_array_equal(again.load_factors, curve.load_factors)


def test_a_stored_curve_is_the_same_to_the_bits(tmp_path):
    from dalembert.forward import Checkpoint

    frequencies, held = np.linspace(0.1, 0.3, 5), HeldAmplitude("b", 0.4)
    curves = []
    for _ in range(2):
        with Checkpoint(tmp_path / "solutions.db") as checkpoint:
            curves.append(frequency_response(pair(), frequencies, METHOD, control=held, checkpoint=checkpoint))
    plain = frequency_response(pair(), frequencies, METHOD, control=held)
    for curve in curves:
        np.testing.assert_array_equal(curve.unknowns, plain.unknowns)
        np.testing.assert_array_equal(curve.load_factors, plain.load_factors)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"continuation": "arc-length"}, "frequency_response: a held amplitude was asked for with continuation='arc-length'. Leave one of them out"),
        ({"stability": True}, "frequency_response: a held amplitude was asked for with stability=True. Leave one of them out"),
        ({"method": HarmonicBalance("auto")}, "frequency_response: a held amplitude was asked for with harmonics='auto'. Leave one of them out"),
        ({"control": HeldAmplitude("c", 1.0)}, "HeldAmplitude: unknown degree of freedom 'c'; known: a.x, b.x"),
    ],
)  # fmt: skip
def test_what_does_not_go_with_a_held_amplitude(options, message):
    settings = {"method": METHOD, "control": HeldAmplitude("a", 0.5)} | options
    with pytest.raises(InputError, match=says(message)):
        frequency_response(pair(), (0.1, 0.2), **settings)


def test_a_held_amplitude_is_positive():
    with pytest.raises(InputError, match=says("HeldAmplitude: the amplitude is -1.0; expected a positive number")):
        HeldAmplitude("a", -1.0)


def duffing(force: float) -> VibrationSystem:
    system = VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.05)]))
    system.add(da.HarmonicForce("m", force, 0.3))
    system.add(da.CubicSpring("k3", "m", stiffness=0.1))
    return system


def test_the_phase_resonance_of_one_harmonic_has_a_closed_form():
    forces = np.array([0.05, 0.1, 0.18])
    track = track_resonance(
        duffing, "force", forces, (0.1, 0.3), HarmonicBalance(1), dof="m", kind="harmonic 1", phase=-np.pi / 2
    )
    # One harmonic: (k - ω² + ¾ k3 a²) a = F cos, c ω a = F sin: at a quarter of a period ω² = k + ¾ k3 a², a = F/(c ω).
    omegas = 2 * np.pi * track.frequencies
    np.testing.assert_allclose(omegas**2, 1 + 0.075 * track.amplitudes**2, rtol=1e-9)
    np.testing.assert_allclose(track.amplitudes, forces / (0.05 * omegas), rtol=1e-9)
    assert track.provenance["phase"] == -np.pi / 2


@pytest.mark.parametrize("solver", ["stiffness", "receptance"])
def test_another_phase_of_an_interior_degree_of_freedom(solver):
    method = replace(METHOD, solver=solver)
    track = track_resonance(
        pair, "level", [0.04, 0.08], (0.05, 0.15), method, dof="b", kind="harmonic 1", phase=-np.pi / 4
    )
    assert track.converged.all()
    for level, frequency in zip(track.values, track.frequencies, strict=True):
        curve = frequency_response(pair(float(level)), np.array([frequency]), METHOD)
        column = curve.harmonics("b")[0]
        assert np.angle(column[1] - 1j * column[2]) == pytest.approx(-np.pi / 4, abs=1e-8)


def test_a_phase_is_relative_to_a_force():
    with pytest.raises(InputError, match=says("track_resonance: phase is nan; expected a number in rad")):
        track_resonance(duffing, "force", [0.1], (0.1, 0.3), METHOD, dof="m", phase=float("nan"))


def test_what_else_takes_the_force_of_a_held_amplitude():
    curve = frequency_response(pair(), np.array([0.1]), METHOD, control=HeldAmplitude("a", 0.5))
    words = ": the curve has a held amplitude, so that its forces are not those of the system. Compute a curve without control"
    with pytest.raises(InputError, match=says(f"floquet_multipliers{words}")):
        da.floquet_multipliers(pair(), curve, 0)
    with pytest.raises(InputError, match=says(f"compare_in_time{words}")):
        da.compare_in_time(pair(), curve)


def test_no_amplitude_is_held_without_a_varying_force():
    system = VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.1)]))
    system.add(da.StaticForce("m", 1.0))
    words = "HeldAmplitude: no force acts in the first harmonic, so none holds its amplitude. Add a HarmonicForce"
    with pytest.raises(InputError, match=says(words)):
        frequency_response(system, np.array([0.1]), METHOD, control=HeldAmplitude("m", 1.0))


@pytest.mark.parametrize("delay", [0.1, 2.0, 4.0])
def test_the_phase_of_a_tabulated_force_depends_on_the_frequency(delay):
    def build(level: float) -> VibrationSystem:
        system = VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.2)]))
        f = np.linspace(0.05, 0.4, 200)
        system.add(da.TabulatedForce("m", f, np.ones_like(f), -delay * 2 * np.pi * f, scale=level))
        return system

    track = track_resonance(
        build, "level", [1.0], (0.1, 0.25), HarmonicBalance(1), dof="m", kind="harmonic 1", phase=-np.pi / 2
    )
    # The phase is relative to the force, whatever its delay: the undamped frequency.
    assert track.frequencies[0] == pytest.approx(1 / (2 * np.pi), rel=1e-6)


def test_a_track_that_leaves_the_table_of_a_force_is_refused():
    def build(stiffness: float) -> VibrationSystem:
        system = VibrationSystem(da.lumped({"m": 1.0}, [("m", None, stiffness, 0.1)]))
        system.add(da.TabulatedForce("m", [0.05, 0.2], [1.0, 2.0]))
        return system

    with pytest.raises(InputError, match=r"the table of the force on 'm' from 0\.05 to 0\.2 Hz"):
        track_resonance(build, "stiffness", [1.0, 4.0], (0.1, 0.19), HarmonicBalance(1), dof="m")
