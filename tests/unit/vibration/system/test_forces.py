"""Forces that depend on the frequency, base excitation, and rotors: slopes, derivatives, messages."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError
from dalembert.structure import Dofs, Structure, craig_bampton, lumped
from dalembert.vibration import HarmonicBalance, VibrationSystem, frequency_response
from dalembert.vibration.balance.equations import equations
from dalembert.vibration.system.system import Part
from support import says

METHOD = HarmonicBalance(3)


def rotor(size: int = 6, seed: int = 0) -> Structure:
    """A structure with random matrices, without any symmetry of its rotor parts."""
    random = np.random.default_rng(seed)
    full = random.normal(size=(4, size, size))
    mass, stiffness, damping = (
        scale * (part @ part.T / size + np.eye(size)) for scale, part in zip((1.0, 50.0, 0.2), full, strict=False)
    )
    names = tuple(f"n{k}.x" for k in range(size))
    gyroscopic, circulatory = 0.02 * random.normal(size=(2, size, size))
    return Structure(mass, stiffness, Dofs(names), damping, gyroscopic=gyroscopic, circulatory=circulatory)


def loaded(structure: Structure, *parts: Part, speed: float | str = "synchronous") -> VibrationSystem:
    system = VibrationSystem(structure, speed=speed)
    for part in parts:
        system.add(part)
    return system


def table(**options: float) -> da.TabulatedForce:
    f = np.linspace(0.5, 3.0, 30)
    return da.TabulatedForce("n1.x", f.tolist(), (1 + f**2).tolist(), (0.3 * f).tolist(), **options)


EVERY = (
    da.HarmonicForce("n0.x", 1.0),
    da.Unbalance("n2.x", "n3.x", moment=0.1, phase=0.4),
    table(),
    da.BaseExcitation("x", displacement=0.05, phase=0.2),
    da.BaseExcitation("x", acceleration=0.5, harmonic=2),
)


@pytest.mark.parametrize("speed", [0.0, 7.0, "synchronous"])
@pytest.mark.parametrize("sparse", [False, True])
def test_a_linear_system_answers_as_its_matrices_do(speed, sparse, monkeypatch):
    structure = rotor()
    if sparse:
        from scipy.sparse import csc_array

        monkeypatch.setattr("dalembert.vibration.interface.condensation.DENSE", 1)
        parts = ("mass", "stiffness", "damping", "gyroscopic", "circulatory")
        structure = replace(structure, **{name: csc_array(getattr(structure, name)) for name in parts})
    parts = [part for part in EVERY if speed == "synchronous" or not isinstance(part, da.Unbalance)]
    system = loaded(structure, *parts, da.CubicSpring("c", "n4.x", stiffness=1e-9), speed=speed)
    omega = 7.3
    curve = frequency_response(system, np.array([omega]) / (2 * np.pi), METHOD)
    dense = rotor()
    spin = omega if speed == "synchronous" else speed
    base = dense.mass.sum(axis=1)
    f = omega / (2 * np.pi)
    first = 0.05 * omega**2 * base * np.exp(0.2j)
    first += np.eye(6)[0] + (speed == "synchronous") * 0.1 * omega**2 * np.exp(0.4j) * (
        np.eye(6)[2] - 1j * np.eye(6)[3]
    )
    first += (1 + f**2) * np.exp(0.3j * f) * np.eye(6)[1]
    for order, load in ((1, first), (2, -0.5 * base)):
        s = order * omega
        dynamic = dense.stiffness + spin * dense.circulatory - s**2 * dense.mass
        dynamic = dynamic + 1j * s * (dense.damping + spin * dense.gyroscopic)
        exact = np.linalg.solve(dynamic, load)
        ours = curve.response[0, :, 2 * order - 1] - 1j * curve.response[0, :, 2 * order]
        # The table is interpolated.
        assert np.abs(ours - exact).max() < (2e-4 if order == 1 else 1e-7) * np.abs(exact).max()


@pytest.mark.parametrize("solver", ["stiffness", "receptance"])
@pytest.mark.parametrize("speed", [3.0, "synchronous"])
def test_slopes_by_the_frequency_are_those_of_differences(speed, solver):
    structure, parts = rotor(), list(EVERY)
    if speed == 3.0:
        parts = [part for part in parts if not isinstance(part, da.Unbalance)]
    system = loaded(structure, *parts, da.CubicSpring("c", "n4.x", stiffness=30.0), speed=speed)
    problem = equations(system, replace(METHOD, solver=solver))
    omega, step = 8.0, 1e-5
    unknowns = np.random.default_rng(1).normal(size=problem.balance(64).shape)

    def residual(at: float) -> np.ndarray:
        return problem.balance(64).at(problem.at(at), unknowns).residual  # pyright: ignore[reportArgumentType]

    slope = problem.balance(64).linearised(problem.at(omega), unknowns)[1].slope  # pyright: ignore[reportArgumentType]
    differences = (residual(omega + step) - residual(omega - step)) / (2 * step)
    assert np.abs(slope - differences).max() < 1e-7 * np.abs(differences).max()


@pytest.mark.parametrize("speed", [3.0, "synchronous"])
def test_a_rotor_by_receptances_moves_as_by_dynamic_stiffnesses(speed):
    slider = da.FrictionContact("c", "n1", friction=0.4, preload=0.5, law=da.ElasticSlider(2.0))
    system = loaded(rotor(), da.HarmonicForce("n0.x", 1.0), slider, speed=speed)
    curves = [
        frequency_response(system, np.array([0.2, 0.4, 0.7, 1.1]), replace(METHOD, solver=solver), stability=True)
        for solver in ("stiffness", "receptance")
    ]
    assert all(curve.converged.all() for curve in curves)
    np.testing.assert_allclose(curves[0].response, curves[1].response, rtol=0, atol=1e-9)
    first, other = (da.floquet_multipliers(system, curve, 1) for curve in curves)
    np.testing.assert_allclose(np.abs(first[:4]), np.abs(other[:4]), rtol=1e-6)


@pytest.mark.parametrize("solver", ["stiffness", "receptance"])
def test_derivatives_by_the_parameters_of_a_rotor_and_its_forces(solver):
    def build(moment: float, base: float, scale: float, speed: float, inner: float, polar: float) -> VibrationSystem:
        from dalembert.structure import Disc, RotatingDamper, with_rotors

        structure = lumped({f"d.{axis}": 1.0 for axis in ("x", "y", "rx", "ry")}, [])
        stiffness = np.diag([90.0, 80.0, 70.0, 60.0]) + np.kron(np.ones((2, 2)), 4 * np.eye(2))
        structure = replace(structure, stiffness=stiffness, damping=0.02 * stiffness)
        structure = with_rotors(structure, [Disc("d.rx", "d.ry", polar), RotatingDamper("d.x", "d.y", inner)])
        system = VibrationSystem(structure, speed=speed)
        system.add(da.TabulatedForce("d.y", [0.5, 1.0, 2.0], [1.0, 2.0, 1.5], [0.0, 0.2, 0.1], scale=scale))
        system.add(da.BaseExcitation("x", displacement=base))
        system.add(da.HarmonicForce("d.rx", moment))
        system.add(da.CubicSpring("c", "d.x", stiffness=40.0))
        return system

    bounds = {
        "moment": (1.0, 3.0), "base": (0.01, 0.03), "scale": (0.5, 1.5),
        "speed": (2.0, 8.0), "inner": (0.05, 0.2), "polar": (0.2, 0.8),
    }  # fmt: skip
    model = da.FrequencyResponse(
        build, bounds, ["d.x rms", "d.ry rms"], np.array([0.8, 1.3]), replace(METHOD, solver=solver)
    )
    vector = np.array([2.0, 0.02, 1.0, 5.0, 0.1, 0.4])
    _, jacobian = model.linearise(vector)
    for column, name in enumerate(bounds):
        step = np.zeros_like(vector)
        step[column] = 1e-6 * vector[column]
        differences = (model.linearise(vector + step)[0] - model.linearise(vector - step)[0]) / (2 * step[column])
        assert np.abs(jacobian[..., column] - differences).max() < 1e-6 * np.abs(differences).max(), name


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ((table(), da.CubicSpring("c", "n4.x", stiffness=1.0)), "frequency_response: the frequencies reach from 0.4 to 0.4 Hz, and the table of the force on 'n1.x' from 0.5 to 3 Hz. Extend the table, or ask for frequencies inside it"),
        ((da.BaseExcitation("y", displacement=1.0),), "the base excitation along 'y': no degree of freedom with a mass moves along this axis"),
        ((da.HarmonicForce("n0.x", 1.0, harmonic=9),), "the force on 'n0.x' acts in harmonic 9, which is not among the harmonics kept (0, 1, 2, 3); keep more of them"),
    ],
)  # fmt: skip
def test_forces_that_do_not_fit(parts, message):
    with pytest.raises(InputError, match=says(message)):
        frequency_response(loaded(rotor(), *parts), np.array([0.4]), METHOD)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: da.Unbalance("a.x", "a.x", moment=1.0), "the unbalance at 'a.x': both directions are equal; expected two across the axis"),
        (lambda: da.BaseExcitation("w", displacement=1.0), "BaseExcitation: direction is 'w'; expected one of x, y, z"),
        (lambda: da.BaseExcitation("x"), "the base excitation along 'x' has no displacement and no acceleration; expected one of them"),
        (lambda: da.BaseExcitation("x", 1.0, 2.0), "the base excitation along 'x' has both a displacement and an acceleration; expected one of them"),
        (lambda: da.BaseExcitation("x", 1.0, harmonic=0), "the base excitation along 'x': the harmonic is 0; expected 1 or more, and a StaticForce for a force that does not change"),
        (lambda: da.TabulatedForce("a.x", [1.0], [1.0]), "the force on 'a.x': the frequencies of the table are [1.0]; expected two or more, positive and ascending, in Hz"),
        (lambda: da.TabulatedForce("a.x", [1.0, 1.0], [1.0, 2.0]), "the force on 'a.x': the frequencies of the table are [1.0, 1.0]; expected two or more, positive and ascending, in Hz"),
        (lambda: da.TabulatedForce("a.x", [1.0, 2.0], [1.0]), "the force on 'a.x': the table has 2 frequencies and 1 amplitudes; expected as many"),
        (lambda: da.TabulatedForce("a.x", [1.0, 2.0], [1.0, 2.0], [0.1]), "the force on 'a.x': the table has 2 frequencies and 1 phases; expected as many"),
        (lambda: VibrationSystem(rotor(), speed="fast"), "VibrationSystem: speed is 'fast'; expected a number in rad/s, or 'synchronous' for the frequency of the excitation"),
        (lambda: loaded(rotor(), da.Unbalance("n0.x", "n1.x", moment=1.0), speed=5.0), "the unbalance at 'n0.x' turns with the rotor, and the speed of the system is 5 rad/s. Use speed='synchronous'"),
    ],
)  # fmt: skip
def test_messages_of_forces_and_speeds(make, message):
    with pytest.raises(InputError, match=says(message)):
        make()


def test_a_rotor_that_turns_is_refused_where_it_has_no_meaning():
    system = loaded(rotor(), da.HarmonicForce("n0.x", 1.0), da.CubicSpring("c", "n1.x", stiffness=1.0))
    with pytest.raises(
        InputError,
        match=says(
            "backbone: the structure has a rotor that turns, which only responses over frequency take. Use frequency_response"
        ),
    ):
        da.backbone(system, np.array([1.0]))
    with pytest.raises(
        da.ModelError,
        match=says(
            "the structure has circulatory forces, such as those of damping that turns with a rotor, which motions in time do not take here. Use frequency_response"
        ),
    ):
        da.steady_state(system, 1.0)


def test_a_clamped_and_reduced_structure_has_the_inertia_of_the_whole():
    # A consistent mass couples clamped degrees of freedom, and all modes of a reduction are as good as the structure.
    count, coupling = 6, 0.3
    mass = np.eye(count) + coupling * (np.eye(count, k=1) + np.eye(count, k=-1))
    stiffness = 50.0 * (2 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1))
    names = tuple(f"n{k}.x" for k in range(count))
    whole = Structure(mass, stiffness, Dofs(names), 0.01 * stiffness)
    free = whole.fixed(["n0"])
    frequencies, base = np.array([0.3, 0.7]), da.BaseExcitation("x", acceleration=1.0)
    curve = frequency_response(loaded(free, base), frequencies, METHOD)
    for point, omega in enumerate(2 * np.pi * frequencies):
        dynamic = free.stiffness - omega**2 * free.mass + 1j * omega * free.damping
        exact = np.linalg.solve(dynamic, -mass.sum(axis=1)[1:])
        np.testing.assert_allclose(curve.response[point, :, 1] - 1j * curve.response[point, :, 2], exact, rtol=1e-9)
    reduced = craig_bampton(free, ["n1", "n5"], 3)
    again = frequency_response(loaded(reduced, base), frequencies, METHOD, observe=["n1", "n5"])
    np.testing.assert_allclose(again.response, curve.response[:, [0, 4]], atol=1e-9)


def test_a_reduction_keeps_the_parts_of_a_rotor():
    structure = rotor()
    reduced = craig_bampton(structure, ["n0", "n1"], 4)
    np.testing.assert_allclose(reduced.gyroscopic, reduced.basis.T @ structure.gyroscopic @ reduced.basis)
    system = loaded(structure, da.HarmonicForce("n0.x", 1.0))
    small = loaded(reduced, da.HarmonicForce("n0.x", 1.0))
    curves = [frequency_response(each, np.array([1.1]), METHOD, observe=["n0", "n1"]) for each in (system, small)]
    np.testing.assert_allclose(curves[0].response, curves[1].response, atol=1e-9)


def test_a_rotor_needs_a_speed():
    words = (
        "VibrationSystem: the structure has a rotor. Give its speed in rad/s, or speed='synchronous' for that of the "
        "excitation"
    )
    with pytest.raises(InputError, match=says(words)):
        VibrationSystem(rotor())


def test_a_large_structure_under_base_excitation_is_observed_whole():
    names = [f"m{k}" for k in range(70)]
    springs = [("m0", None, 900.0, 1.0), *((a, b, 900.0, 1.0) for a, b in pairwise(names))]
    system = VibrationSystem(lumped(dict.fromkeys(names, 1.0), springs))
    system.add(da.BaseExcitation("x", displacement=0.0))
    system.add(da.BaseExcitation("x", displacement=1.0))
    assert frequency_response(system, np.array([0.1]), METHOD).response.shape == (1, 70, 7)
