"""Periodic motions in time: the steps, the two ways to a steady state, what is kept and what is refused."""

from inspect import unwrap
from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import InputError, ModelError
from dalembert.forward import Checkpoint
from dalembert.structure import Dofs, Structure, lumped
from dalembert.vibration import (
    BilinearStop,
    CubicSpring,
    ElasticSlider,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    Iwan,
    Newmark,
    PeriodicMotion,
    Rigid,
    StaticForce,
    TimeComparison,
    UserElement,
    VibrationSystem,
    compare_in_time,
    frequency_response,
    steady_state,
)
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.time.elements import Instant, react, reaction
from dalembert.vibration.time.modal_system import ModalSystem, address
from support import says
from vibrating_systems import chain, duffing, one_mass, two_masses

TURN = 2 * np.pi


def oscillator(damping: float = 0.2) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, damping)]))
    system.add(HarmonicForce("m", 1.0, phase=0.3))
    return system


@pytest.mark.parametrize("radius", [None, 1.0, 0.8, 0.0])
def test_steps_converge_with_the_second_order(radius: float | None) -> None:
    exact = np.exp(0.3j) / (1 - 1.3**2 + 1j * 0.2 * 1.3)
    errors = []
    for steps in (64, 128):
        motion = steady_state(oscillator(), 1.3 / TURN, Newmark(steps, radius, tolerance=1e-12))
        assert motion.converged
        cosine, sine = motion.harmonics("m", 1)[1:]
        errors.append(abs(cosine - 1j * sine - exact))
        assert motion.displacements[0, 0] == pytest.approx(exact.real, rel=0.05)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("radius", [None, 0.8])
def test_shooting_finds_the_motion_of_a_long_run_in_fewer_periods(radius: float | None) -> None:
    method = Newmark(256, radius)
    long = steady_state(two_masses(), 0.88 / TURN, method)
    shot = steady_state(two_masses(), 0.88 / TURN, method, way="shooting")
    assert long.converged
    assert shot.converged
    assert shot.periods < 0.7 * long.periods
    np.testing.assert_allclose(shot.displacements, long.displacements, atol=1e-6)
    np.testing.assert_array_equal(shot.states, long.states)


def rubbing(law: ElasticSlider | Iwan, *parts) -> VibrationSystem:
    """A mass on three springs that rubs in a plane and lifts off, beside another one."""
    stiffness = np.diag([12.0, 16.0, 21.0, 3.0]) - np.diag([1.0, 0.0, 0.5], 1) - np.diag([1.0, 0.0, 0.5], -1)
    dofs = Dofs(("a.x", "a.y", "a.z", "b.x"))
    system = VibrationSystem(Structure(np.diag([1.0, 1.2, 1.0, 0.8]), stiffness, dofs, damping=0.05 * stiffness))
    contact = FrictionContact("foot", "a", tangential=("x", "y"), normal="z", friction=0.6, preload=4.0, law=law)
    for part in (contact, StaticForce("a.z", 10.0), *parts):
        system.add(part)
    for dof, size, phase in (("a.x", 20.0, 0.0), ("a.y", 12.0, 1.2), ("a.z", 25.0, 0.4), ("b.x", 3.0, 0.0)):
        system.add(HarmonicForce(dof, size, phase=phase))
    return system


PLANE = ElasticSlider(8.0, normal_stiffness=15.0)


@pytest.mark.parametrize(
    ("system", "states"),
    [
        (rubbing(PLANE), {0, 1, 2}),
        (rubbing(Iwan((3.0, 5.0), (0.3, 0.7), normal_stiffness=15.0)), {0, 1, 2}),
        (rubbing(PLANE, CubicSpring("cubic", "a.x", "b.x", stiffness=0.7)), {0, 1, 2}),
        (rubbing(PLANE, Gap("gap", "b.x", stiffness=6.0, gap=0.2)), {0, 1, 2}),
        (rubbing(PLANE, BilinearStop("stop", "b.x", stiffness=6.0, gap=0.3)), {0, 1, 2}),
        pytest.param(
            rubbing(PLANE, UserElement("pair", ["a.x", "b.x"], lambda u: u**3 + u[::-1] * u**2)),
            {0, 1, 2},
            marks=pytest.mark.slow,
        ),
    ],
    ids=["friction", "microslip", "cubic", "gap", "stop", "user"],
)
def test_every_law_agrees_with_harmonic_balance(system: VibrationSystem, states: set[int]) -> None:
    curve = frequency_response(system, np.array([0.45, 0.7]), HarmonicBalance(15, samples=1024))
    assert curve.converged.all()
    # the error of the steps in time is of first order at lift-off: 1.7e-3 with 512, 2.2e-4 with 4,096
    comparison = compare_in_time(system, curve, points=[0, 1], method=Newmark(2048), way="shooting")
    assert comparison.converged.all()
    assert np.abs(comparison.differences).max() < 5e-4
    seen = steady_state(system, 0.7, Newmark(128, tolerance=1e-3), start=(curve, 1)).states
    assert set(np.unique(seen)) == states


def test_slopes_of_the_elements_are_those_of_their_forces() -> None:
    law = UserElement("pair", ["a.x", "b.x"], lambda u: u**3 + u[::-1] * u**2)
    stop, cubic = BilinearStop("stop", "b.x", stiffness=6.0, gap=0.3), CubicSpring("cubic", "a.x", stiffness=0.7)
    lowered = lower(rubbing(PLANE, law, stop, cubic, Gap("gap", "a.y", stiffness=2.0, gap=0.1))).real
    problem = ModalSystem(lowered, 1.0, 16, 1.0)
    users, rows, rng = problem.users([]), len(problem.places), np.random.default_rng(3)
    states = set()
    for _ in range(40):
        u, sliders = rng.normal(size=rows), rng.normal(size=(1, 2)) * 0.3

        def forces(u: np.ndarray, sliders: np.ndarray = sliders) -> tuple[np.ndarray, np.ndarray, int]:
            found = reaction(rows, problem.elements, 1)
            instant = Instant(u, np.zeros(rows), 0.0, sliders, np.zeros(0))
            react(problem.elements, address(users), instant, found)
            return found.force, found.slopes, int(found.states[0])

        _, slopes, state = forces(u)
        states.add(state)
        steps = 1e-6 * np.eye(rows)
        differences = np.array([(forces(u + step)[0] - forces(u - step)[0]) / 2e-6 for step in steps]).T
        np.testing.assert_allclose(slopes, differences, atol=1e-7)
    assert states == {0, 1, 2}


def test_damping_that_couples_modes_is_kept_whole() -> None:
    springs = [("a", None, 1.0, 0.3), ("a", "b", 2.0, 0.0), ("b", None, 0.5, 0.0)]
    system = VibrationSystem(lumped({"a": 1.0, "b": 2.0}, springs))
    system.add(HarmonicForce("b", 1.0))
    curve = frequency_response(system, np.array([0.1, 0.2]), HarmonicBalance(1))
    for way in ("long run", "shooting"):
        comparison = compare_in_time(system, curve, method=Newmark(1024), way=way)
        assert np.abs(comparison.differences).max() < 1e-4


def test_a_massless_foot_and_a_rigid_contact_are_integrated() -> None:
    springs = [("m", None, 1.0, 0.04), ("m", "foot", 0.8, 0.0)]
    system = VibrationSystem(lumped({"m": 1.0, "foot": 0.0}, springs))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("slider", "foot", friction=0.5, preload=2.0, law=Rigid()))
    motion = steady_state(system, 1.12 / TURN, Newmark(1024, stand_in=1e5), observe=["m"])
    alone = steady_state(one_mass(), 1.12 / TURN, Newmark(1024))
    assert motion.amplitude("m") == pytest.approx(alone.amplitude("m"), rel=2e-5)
    assert motion.dofs == ("m.x",)


def test_stiff_contacts_in_two_directions_are_solved_in_every_step() -> None:
    """As they grow stiffer, the motion tends to that with rigid ones."""
    sizes = []
    for stiffening in (1e2, 1e3, 1e4):
        system = VibrationSystem(rubbing(PLANE).structure)
        for dof, size, phase in (("a.x", 6.0, 0.0), ("a.y", 2.0, 0.2), ("b.x", 1.0, 0.0)):
            system.add(HarmonicForce(dof, size, phase=phase))
        for foot in ("left", "right"):
            law = ElasticSlider(16.0 * stiffening)
            system.add(FrictionContact(foot, "a", tangential=("x", "y"), friction=0.6, preload=4.0, law=law))
        motion = steady_state(system, 0.45, Newmark(1024, 0.5))
        assert motion.converged
        assert set(np.unique(motion.states)) == {1, 2}
        sizes.append(motion.amplitude("a.x"))
    assert abs(sizes[1] - sizes[2]) < 0.2 * abs(sizes[0] - sizes[1])
    assert sizes[1] == pytest.approx(sizes[2], rel=1e-2)


def test_a_branch_is_kept_where_there_are_several() -> None:
    """Above the fold of the Duffing oscillator's upper branch, time stays where the curve starts it."""
    up = frequency_response(duffing(), np.linspace(0.12, 0.195, 16), HarmonicBalance(7))
    down = frequency_response(duffing(), np.array([0.195]), HarmonicBalance(7))
    for curve in (up, down):
        comparison = compare_in_time(duffing(), curve, frequencies=[0.195])
        assert np.abs(comparison.differences).max() < 1e-4
    assert down.amplitude("m")[0] < 0.5 * up.amplitude("m")[-1]


def test_sizes_and_energy_of_a_motion_are_those_of_harmonic_balance() -> None:
    curve = frequency_response(one_mass(), np.array([1.12]) / TURN, HarmonicBalance(35, samples=4096))
    motion = steady_state(one_mass(), 1.12 / TURN, Newmark(2048))
    for kind in ("peak", "rms", "harmonic 1", "harmonic 3"):
        assert motion.amplitude("m", kind) == pytest.approx(curve.amplitude("m", kind)[0], rel=1e-4)
    assert motion.dissipated("slider.x") == pytest.approx(curve.dissipated("slider.x")[0], rel=1e-4)
    u, force = motion.loop("slider.x")
    assert (u[0], force[0], len(u)) == (u[-1], force[-1], 2049)
    assert np.abs(force).max() == pytest.approx(1.0)
    np.testing.assert_allclose(motion.motion("m"), motion.relative[:, 0], atol=1e-13)


def test_a_motion_and_a_comparison_are_kept_to_the_bit(tmp_path: Path) -> None:
    curve = frequency_response(chain(), np.linspace(0.2, 0.3, 6), HarmonicBalance(7, samples=128))
    comparison = compare_in_time(chain(), curve, method=Newmark(64, tolerance=1e-4), kind="rms")
    comparison.save(tmp_path / "comparison.nc")
    again = TimeComparison.load(tmp_path / "comparison.nc")
    assert (again.dofs, again.kind, again.provenance) == (comparison.dofs, "rms", comparison.provenance)
    np.testing.assert_array_equal(again.differences, comparison.differences)
    assert again.converged.dtype == bool
    assert again.summary() == comparison.summary()
    motion = steady_state(chain(), 0.26, Newmark(64, tolerance=1e-4), start=(curve, 3))
    motion.save(tmp_path / "motion.nc")
    loaded = PeriodicMotion.load(tmp_path / "motion.nc")
    assert (loaded.coordinates, loaded.contacts) == (motion.coordinates, ("to ground", "between"))
    assert (loaded.periods, loaded.residual, loaded.converged) == (motion.periods, motion.residual, True)
    np.testing.assert_array_equal(loaded.forces, motion.forces)
    assert loaded.summary() == motion.summary()


def test_the_points_that_are_compared() -> None:
    curve = frequency_response(one_mass(), np.linspace(0.1, 0.25, 13), HarmonicBalance(3, samples=64))
    quick = {"method": Newmark(16, tolerance=1e-2)}
    comparison = compare_in_time(one_mass(), curve, **quick)
    largest = int(curve.amplitude("m").argmax())
    assert comparison.points.tolist() == sorted({0, 4, 8, 12, largest})
    assert len(comparison) == len(comparison.points)
    assert compare_in_time(one_mass(), curve, frequencies=[0.2, 0.111], **quick).points.tolist() == [8, 1]
    assert compare_in_time(one_mass(), curve, points=[7, 2], **quick).points.tolist() == [7, 2]


def test_points_that_were_compared_are_not_integrated_again(tmp_path: Path, monkeypatch) -> None:
    curve = frequency_response(one_mass(), np.linspace(0.1, 0.25, 13), HarmonicBalance(3, samples=64))
    ran, steady = [], steady_state

    def counted(system: VibrationSystem, frequency: float, *given, **more) -> PeriodicMotion:
        ran.append(frequency)
        return steady(system, frequency, *given, **more)

    def compare(points: list[int], steps: int = 32) -> TimeComparison:
        with Checkpoint(tmp_path / "checkpoint") as checkpoint:
            return compare_in_time(one_mass(), curve, points=points, method=Newmark(steps), checkpoint=checkpoint)

    monkeypatch.setitem(unwrap(compare_in_time).__globals__, "steady_state", counted)
    first = compare([2, 7])
    every = compare([2, 5, 7])
    assert sorted(ran) == curve.frequencies[[2, 5, 7]].tolist()
    assert first.time.tobytes() == every.time[[0, 2]].tobytes()
    alone = compare_in_time(one_mass(), curve, points=[2, 5, 7], method=Newmark(32))
    assert every.to_xarray().identical(alone.to_xarray())
    ran.clear()
    compare([2], steps=64)
    assert len(ran) == 1


def test_a_motion_that_is_not_periodic_yet_is_said_to_be_so() -> None:
    motion = steady_state(one_mass(), 0.18, Newmark(32, periods=3))
    assert (motion.converged, motion.periods) == (False, 3)
    assert motion.status == "The motion does not repeat itself yet."
    curve = frequency_response(one_mass(), np.array([0.18]), HarmonicBalance(3, samples=64))
    comparison = compare_in_time(one_mass(), curve, method=Newmark(32, periods=2))
    assert "not periodic yet" in comparison.summary()


def broken(u: np.ndarray) -> np.ndarray:
    raise ValueError("no such law")


def test_what_a_law_of_the_users_raises_is_raised() -> None:
    system = oscillator()
    system.add(UserElement("mine", ["m"], broken))
    with pytest.raises(ValueError, match=r"^no such law$"):
        steady_state(system, 0.1)


def pushed(system: VibrationSystem, dof: str) -> VibrationSystem:
    system.add(HarmonicForce(dof, 1.0))
    return system


def loose() -> VibrationSystem:
    return pushed(VibrationSystem(lumped({"a": 1.0, "b": 0.0}, [("a", None, 1.0, 0.1)])), "a")


def large() -> VibrationSystem:
    names = [f"m{number}" for number in range(1501)]
    system = VibrationSystem(lumped(dict.fromkeys(names, 1.0), [(name, None, 1.0, 0.0) for name in names]))
    return pushed(system, "m0")


@pytest.mark.parametrize(
    ("call", "error", "sentence"),
    [
        (
            lambda: Newmark(periods=0),
            InputError,
            "Newmark: periods is 0; expected a whole number of at least 1",
        ),
        (
            lambda: Newmark(spectral_radius=1.2),
            InputError,
            "Newmark: spectral_radius is 1.2; expected a number from 0 to 1",
        ),
        (
            lambda: Newmark(tolerance=0.0),
            InputError,
            "Newmark: tolerance is 0; expected a number between 0 and 1",
        ),
        (
            lambda: Newmark(stand_in=-1.0),
            InputError,
            "Newmark: stand_in is -1; expected a positive number",
        ),
        (
            lambda: steady_state(oscillator(), -0.1),
            InputError,
            "steady_state: the frequency is -0.1; expected a positive number in Hz",
        ),
        (
            lambda: steady_state(oscillator(), 0.1, way="shoot"),
            InputError,
            "steady_state: unknown way 'shoot'; did you mean 'shooting'?",
        ),
        (
            lambda: steady_state(loose(), 0.1),
            ModelError,
            "the structure has degrees of freedom with neither mass nor stiffness, or with negative ones, and cannot "
            "be integrated in time; give them some mass or a spring",
        ),
        (
            lambda: steady_state(large(), 0.1),
            ModelError,
            "the structure has 1501 degrees of freedom, too many to be integrated in time (at most 1500); reduce it "
            "with craig_bampton",
        ),
        (
            lambda: steady_state(oscillator(), 0.1, Newmark(8)).harmonics("m", 4),
            InputError,
            "The motion has 8 samples of a period, too few for 4 harmonics. Use at least 9 steps of a period",
        ),
        (
            lambda: steady_state(oscillator(), 0.1).motion("a"),
            InputError,
            "unknown observed degree of freedom 'a'; known: m.x",
        ),
        (
            lambda: steady_state(one_mass(), 0.1).loop("slider"),
            InputError,
            "unknown coordinate 'slider'; did you mean 'slider.x'?",
        ),
        (
            lambda: compare_in_time(one_mass(), CURVE, points=[0], frequencies=[0.1]),
            InputError,
            "compare_in_time: both points and frequencies were given; expected one of them",
        ),
        (
            lambda: compare_in_time(one_mass(), CURVE, points=[3]),
            InputError,
            "compare_in_time: there is no point 3 that was found; expected numbers among the 3 found ones, 0 to 2",
        ),
        (
            lambda: compare_in_time(one_mass(), LOST),
            InputError,
            "compare_in_time: no point of the curve was found; see its residuals",
        ),
    ],
)
def test_what_cannot_be_meant_is_told(call, error: type, sentence: str) -> None:
    with pytest.raises(error, match=says(sentence)):
        call()


CURVE = frequency_response(one_mass(), np.array([0.1, 0.11, 0.12]), HarmonicBalance(3, samples=64))
LOST = frequency_response(one_mass(), np.array([0.18]), HarmonicBalance(3, samples=64, iterations=1, halvings=0))
