"""Stability, nonlinear modes and resonance tracks against time integration, closed forms and whole curves."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root
from scipy.special import ellipk

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
    backbone,
    floquet_multipliers,
    frequency_response,
    track_resonance,
)
from vibrating_systems import duffing, one_mass, two_masses

TOPIC = "Paths and stability in frequency"
TIME = "shooting and variational equations in time (SciPy, DOP853)"
TURN = 2 * np.pi
Slope = Callable[[float, np.ndarray], np.ndarray]


def monodromy(rate: Slope, slope: Slope, omega: float, guess: np.ndarray) -> np.ndarray:
    """Monodromy matrix of the periodic motion near a guess, by shooting; another way than the package's."""
    size, period = len(guess), TURN / omega

    def both(t: float, state: np.ndarray) -> np.ndarray:
        place, tangent = state[:size], state[size:].reshape(size, size)
        return np.append(rate(t, place), slope(t, place) @ tangent)

    def after(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        begin = np.append(place, np.eye(size).ravel())
        end = solve_ivp(both, (0.0, period), begin, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        return end[:size] - place, end[size:].reshape(size, size) - np.eye(size)

    found = root(after, guess, jac=True, tol=1e-12)
    assert np.linalg.norm(after(found.x)[0]) < 1e-9
    return after(found.x)[1] + np.eye(size)


def begin(curve: FrequencyCurve, point: int) -> np.ndarray:
    """Displacements and velocities of a point of a curve where the force is largest."""
    omega = TURN * curve.frequencies[point]
    places = np.array([curve.motion(dof, point, np.zeros(1))[0] for dof in curve.dofs])
    step = np.array([-1e-5, 1e-5])
    speeds = [omega * np.diff(curve.motion(dof, point, step))[0] / 2e-5 for dof in curve.dofs]
    return np.append(places, speeds)


def cubic(
    linear: float, damping: float, third: float, static: float, force: float, omega: float
) -> tuple[Slope, Slope]:
    def rate(t: float, s: np.ndarray) -> np.ndarray:
        return np.array([s[1], static + force * np.cos(omega * t) - damping * s[1] - linear * s[0] - third * s[0] ** 3])

    def slope(t: float, s: np.ndarray) -> np.ndarray:
        return np.array([[0.0, 1.0], [-linear - 3 * third * s[0] ** 2, -damping]])

    return rate, slope


def sorted_values(values: np.ndarray) -> np.ndarray:
    return np.array(sorted(values, key=lambda one: (-round(abs(one), 6), one.imag)))


def test_duffing_oscillator_is_unstable_between_its_folds(record_evidence) -> None:
    method = HarmonicBalance(15, odd_only=True, resolution=0.02)
    ends = (1.0 / TURN, 1.5 / TURN)
    curve = frequency_response(duffing(), ends, method, continuation="arc-length", stability=True)
    first, last = np.flatnonzero(curve.fold)
    assert np.all(curve.stable[first + 1 : last + 1] == 0)
    assert np.all(curve.stable[: first + 1] == 1)
    assert np.all(curve.stable[last + 1 :] == 1)
    differences = []
    for point in (first // 2, (first + last) // 2, last - 3, last + 3):
        omega = TURN * curve.frequencies[point]
        exact = np.linalg.eigvals(monodromy(*cubic(1.0, 0.05, 0.1, 0.0, 0.18, omega), omega, begin(curve, point)))
        differences.append(np.abs(sorted_values(floquet_multipliers(duffing(), curve, point)) - sorted_values(exact)))
    record_evidence(
        "Duffing oscillator: Floquet multipliers by Hill's method, before, between and behind the folds",
        0.0, np.max(differences), tolerance=1e-7, topic=TOPIC, kind="other code", source=TIME, noisy=True,
    )  # fmt: skip
    for number, fold in enumerate((first, last)):
        multipliers = floquet_multipliers(duffing(), curve, fold)
        record_evidence(
            f"Duffing oscillator: Floquet multiplier at fold {number + 1}", 1.0,
            multipliers[np.argmin(np.abs(multipliers - 1))].real, tolerance=1e-4, topic=TOPIC, kind="closed form", source="a fold's own",
        )  # fmt: skip


def pushed(static: float = 0.03, force: float = 0.16, damping: float = 0.05) -> VibrationSystem:
    """A mass on a cubic spring alone, pushed to one side (after Szemplińska-Stupnicka and Bajkowski, 1986)."""
    structure = Structure(np.eye(1), np.zeros((1, 1)), Dofs(("m.x",)), damping=np.array([[damping]]))
    system = VibrationSystem(structure)
    system.add(StaticForce("m", static))
    system.add(HarmonicForce("m", force))
    system.add(CubicSpring("cubic", "m", stiffness=1.0))
    return system


def test_period_doublings_of_an_oscillator_pushed_to_one_side(record_evidence) -> None:
    method = HarmonicBalance(15, resolution=0.02)
    curve = frequency_response(pushed(), (1.6 / TURN, 0.6 / TURN), method, continuation="arc-length", stability=True)
    kinds, points = zip(*curve.markers, strict=True)
    assert kinds == ("period doubling", "period doubling", "fold")
    assert np.all(curve.stable[points[0] + 1 : points[1]] == 0)
    for number, point in enumerate(points[:2]):
        omega = TURN * curve.frequencies[point]
        exact = np.linalg.eigvals(monodromy(*cubic(0.0, 0.05, 1.0, 0.03, 0.16, omega), omega, begin(curve, point)))
        record_evidence(
            f"oscillator pushed to one side: Floquet multiplier at period doubling {number + 1}, at "
            f"{omega:.4f} rad/s", -1.0, np.min(exact.real), tolerance=1e-3, topic=TOPIC, kind="other code", source=TIME,
        )  # fmt: skip


def with_absorber(force: float) -> VibrationSystem:
    """A nonlinear oscillator with a nonlinear absorber (after Detroux, Habib, Masset and Kerschen, 2015)."""
    springs = [("m1", None, 1.0, 0.002), ("m1", "m2", 0.0454, 0.0128)]
    system = VibrationSystem(lumped({"m1": 1.0, "m2": 0.05}, springs))
    system.add(HarmonicForce("m1", force))
    system.add(CubicSpring("host", "m1", stiffness=1.0))
    system.add(CubicSpring("absorber", "m1", "m2", stiffness=0.0042))
    return system


def test_tori_of_an_oscillator_with_an_absorber(record_evidence) -> None:
    force = 0.12
    method = HarmonicBalance(7, resolution=0.01)
    ends = (0.9 / TURN, 1.4 / TURN)
    curve = frequency_response(with_absorber(force), ends, method, continuation="arc-length", stability=True)
    assert [kind for kind, _ in curve.markers] == ["torus", "torus", "fold", "fold"]
    inverse = np.array([1.0, 20.0])
    stiffness = np.array([[1.0454, -0.0454], [-0.0454, 0.0454]])
    damping = np.array([[0.0148, -0.0128], [-0.0128, 0.0128]])
    for number, (_, point) in enumerate(curve.markers[:2]):
        omega = TURN * curve.frequencies[point]

        def rate(t: float, s: np.ndarray, omega: float = omega) -> np.ndarray:
            x, v, between = s[:2], s[2:], 0.0042 * (s[0] - s[1]) ** 3
            load = np.array([force * np.cos(omega * t) - x[0] ** 3 - between, between])
            return np.append(v, inverse * (load - stiffness @ x - damping @ v))

        def slope(t: float, s: np.ndarray) -> np.ndarray:
            between = 3 * 0.0042 * (s[0] - s[1]) ** 2
            tangent = stiffness + np.array([[3 * s[0] ** 2 + between, -between], [-between, between]])
            return np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse[:, None] * tangent, -inverse[:, None] * damping]])

        exact = np.linalg.eigvals(monodromy(rate, slope, omega, begin(curve, point)))
        largest = exact[np.argmax(np.abs(exact))]
        assert abs(largest.imag) > 0.1
        record_evidence(
            f"oscillator with an absorber: magnitude of the Floquet multipliers at torus {number + 1}, at "
            f"{omega:.4f} rad/s", 1.0, abs(largest), tolerance=1e-3, topic=TOPIC, kind="other code", source=TIME,
        )  # fmt: skip


def test_the_time_map_is_of_second_order(record_evidence) -> None:
    differences = []
    for samples in (512, 1024, 2048):
        curve = frequency_response(duffing(), np.array([1.2]) / TURN, HarmonicBalance(9, samples=samples))
        hill, steps = (sorted_values(floquet_multipliers(duffing(), curve, 0, way)) for way in ("hill", "time map"))
        differences.append(np.abs(hill - steps).max())
    record_evidence(
        "Floquet multipliers by steps in time against Hill's method: order in the step", 2.0,
        np.log2(differences[1] / differences[2]), tolerance=0.05, topic=TOPIC, kind="closed form", source="trapezoidal rule",
    )  # fmt: skip


MASSES, SMOOTHED, STOP = np.array([1.1174, 0.7841, 1.3468]), (0.05759, 0.2278), (5.833, 0.5082)
CUBIC, DRIVING, STATIC = 2.338, 0.4563, -0.08195


def smoothed(u: np.ndarray, v: np.ndarray, z: np.ndarray, numbers: np.ndarray, force: np.ndarray) -> None:
    """Friction f tanh(v/w)."""
    force[0] = numbers[0] * (2 / (1 + np.exp(-2 * v[0] / numbers[1])) - 1)


def with_a_stop() -> VibrationSystem:
    """Three masses with a cubic spring, smoothed friction and a stop: a random system, rounded."""
    springs = [
        ("m0", None, 0.4362, 0.0165), ("m0", "m1", 1.3075, 0.0537), ("m1", None, 0.4368, 0.0172),
        ("m1", "m2", 1.8426, 0.0231), ("m2", None, 0.4540, 0.0159),
    ]  # fmt: skip
    system = VibrationSystem(lumped(dict(zip(("m0", "m1", "m2"), MASSES.tolist(), strict=True)), springs))
    system.add(HarmonicForce("m0", DRIVING))
    system.add(StaticForce("m1", STATIC))
    system.add(CubicSpring("cubic", "m1", stiffness=CUBIC))
    system.add(UserLaw("friction", "m2", function=smoothed, values=list(SMOOTHED)))
    system.add(BilinearStop("stop", "m2", "m1", stiffness=STOP[0], gap=STOP[1]))
    return system


def with_a_stop_in_time(system: VibrationSystem, omega: float) -> tuple[Slope, Slope]:
    """Rates of the states of the same system, and their slopes."""
    stiffness, damping = system.structure.stiffness, system.structure.damping
    across, (stiff, gap), (limit, width) = np.array([0.0, -1.0, 1.0]), STOP, SMOOTHED

    def rate(t: float, state: np.ndarray) -> np.ndarray:
        x, v = state[:3], state[3:]
        force = np.array([DRIVING * np.cos(omega * t), STATIC - CUBIC * x[1] ** 3, -limit * np.tanh(v[2] / width)])
        relative = across @ x
        pushed = stiff * (relative - np.clip(relative, -gap, gap))
        return np.append(v, (force - stiffness @ x - damping @ v - pushed * across) / MASSES)

    def slope(t: float, state: np.ndarray) -> np.ndarray:
        x, v = state[:3], state[3:]
        pushed = stiff * float(abs(across @ x) > gap) * np.outer(across, across)
        by_place = stiffness + np.diag([0.0, 3 * CUBIC * x[1] ** 2, 0.0]) + pushed
        by_speed = damping + np.diag([0.0, 0.0, limit / width / np.cosh(v[2] / width) ** 2])
        below = np.hstack([-by_place, -by_speed]) / MASSES[:, None]
        return np.vstack([np.hstack([np.zeros((3, 3)), np.eye(3)]), below])

    return rate, slope


def factors_in_time(system: VibrationSystem, omega: float, guess: np.ndarray) -> np.ndarray:
    """Multipliers of the periodic motion that Newton's method finds from a guess, the largest first."""
    rate, slope = with_a_stop_in_time(system, omega)

    def both(t: float, state: np.ndarray) -> np.ndarray:
        return np.append(rate(t, state[:6]), slope(t, state[:6]) @ state[6:].reshape(6, 6))

    for _ in range(10):
        begun = np.append(guess, np.eye(6).ravel())
        end = solve_ivp(both, (0.0, TURN / omega), begun, method="DOP853", rtol=1e-9, atol=1e-10).y[:, -1]
        moved, change = end[:6] - guess, end[6:].reshape(6, 6)
        if np.linalg.norm(moved) < 1e-8:
            return np.array(sorted(np.linalg.eigvals(change), key=abs, reverse=True))
        guess = guess - np.linalg.solve(change - np.eye(6), moved)
    raise AssertionError("no periodic motion")


@pytest.mark.slow
def test_points_between_the_folds_of_two_numbers_of_harmonics_are_judged_on_the_path(record_evidence) -> None:
    """Behind the fold with nine harmonics, the multipliers with more harmonics are those of a motion before the fold."""
    system, method = with_a_stop(), HarmonicBalance(9)
    ends = 0.84 / TURN, 1.13 / TURN
    path = frequency_response(system, ends, method, continuation="arc-length", check=False)
    fold = next(point for point in np.flatnonzero(path.fold) if abs(TURN * path.frequencies[point] - 1.1148) < 1e-3)
    labels, largest = [], []
    for point in (fold - 2, fold + 1, fold + 2, fold + 3):
        frequency, start = path.frequencies[[point]], (path, int(point))
        curve = frequency_response(system, frequency, method, stability=True, check=False, start=start)
        labels.append(int(curve.stable[0]))
        assert "stability-near-fold" not in {finding.code for finding in curve.findings}
        largest.append(float(abs(factors_in_time(system, TURN * float(frequency[0]), begin(path, point))[0])))
    assert labels == [1, 0, 0, 0]
    wrong = sum(bool(label) != (size < 1) for label, size in zip(labels, largest, strict=True))
    record_evidence(
        "three masses with a stop, 9 harmonics, about a fold: wrong labels of 4 points, of which 3 are behind the fold",
        0, wrong, tolerance=0, topic=TOPIC, kind="other method", source=TIME,
    )  # fmt: skip


def simulated(state: np.ndarray, omega: float, periods: int, steps: int = 20_000) -> np.ndarray:
    """One mass with a slider in time, by velocity Verlet with the damping in the middle; (x, v, z)."""
    x, v, z = state
    h = TURN / omega / steps
    for step in range(periods * steps):
        force = np.cos(omega * h * step) - 0.04 * v - x - 0.8 * (x - z)
        middle = v + 0.5 * h * force
        x += h * middle
        z = min(max(z, x - 1.25), x + 1.25)  # limit 1 N over 0.8 N/m
        v = (middle + 0.5 * h * (np.cos(omega * h * (step + 1)) - x - 0.8 * (x - z))) / (1 + 0.02 * h)
    return np.array([x, v, z])


@pytest.mark.slow
def test_a_slider_forgets_in_its_own_time(record_evidence) -> None:
    """Disturbances of a simulated motion, with the slider's place among them, beside the linearised map."""
    omega = 1.12
    curve = frequency_response(one_mass(), np.array([omega]) / TURN, HarmonicBalance(31, samples=4096), stability=True)
    assert curve.stable[0] == 1
    state = simulated(np.append(begin(curve, 0), 0.0), omega, 12)
    step = 1e-3
    columns = [
        (simulated(state + step * unit, omega, 1) - simulated(state - step * unit, omega, 1)) / (2 * step)
        for unit in np.eye(3)
    ]
    exact = np.sort(np.abs(np.linalg.eigvals(np.array(columns).T)))[::-1]
    ours = np.sort(np.abs(floquet_multipliers(one_mass(), curve, 0)))[::-1]
    assert exact[2] < 1e-9  # the place of the slider is forgotten within a period
    for number in range(2):
        record_evidence(
            f"one mass with a slider: Floquet multiplier {number + 1}", exact[number], ours[number],
            tolerance=2e-3, topic=TOPIC, kind="other method", source="disturbed simulations, 20,000 steps a period",
        )  # fmt: skip


def test_a_rigid_contact_of_a_massless_foot_is_as_stable_as_the_elastic_one(record_evidence) -> None:
    springs = [("m", None, 1.0, 0.04), ("m", "foot", 0.8, 0.0)]
    foot = VibrationSystem(lumped({"m": 1.0, "foot": 0.0}, springs))
    foot.add(HarmonicForce("m", 1.0))
    foot.add(FrictionContact("slider", "foot", friction=0.5, preload=2.0, law=Rigid()))
    method, frequencies = HarmonicBalance(7, samples=512), np.array([1.12, 1.3]) / TURN
    rigid, elastic = (frequency_response(system, frequencies, method) for system in (foot, one_mass()))
    differences = [
        np.abs(floquet_multipliers(foot, rigid, point)[:2] - floquet_multipliers(one_mass(), elastic, point)[:2])
        for point in range(2)
    ]
    record_evidence(
        "rigid contact of a massless foot against the elastic law: Floquet multipliers", 0.0, np.max(differences),
        tolerance=1e-9, topic=TOPIC, kind="other method", source="elastic law with the same stiffness", noisy=True,
    )  # fmt: skip


@pytest.mark.parametrize("law", [ElasticSlider(1.5), Rigid()], ids=["elastic", "rigid"])
def test_a_structure_that_only_friction_makes_nonlinear_is_stable_everywhere(law: ElasticSlider | Rigid) -> None:
    """Friction takes energy from any disturbance: two motions of one system under one force come no farther apart."""
    curve = frequency_response(two_masses(law), np.linspace(0.08, 0.35, 28), HarmonicBalance(7), stability=True)
    assert curve.converged.all()
    assert np.all(curve.stable == 1)
    assert curve.markers == ()


def test_backbone_of_the_duffing_oscillator(record_evidence) -> None:
    r"""ω = π/2 √(1 + εA²)/K(m), with m = εA²/(2 (1 + εA²)), for ẍ + x + εx³ = 0."""
    found = backbone(duffing(), np.geomspace(0.01, 10.0, 13), method=HarmonicBalance(15, odd_only=True))
    part = 0.1 * found.amplitude("m") ** 2
    record_evidence(
        "Duffing oscillator: frequencies of the mode up to ten times the linear stiffness",
        np.pi / 2 * np.sqrt(1 + part) / ellipk(part / 2 / (1 + part)), TURN * found.frequencies,
        tolerance=1e-8, topic=TOPIC, kind="closed form", source="Jacobi's elliptic functions", unit="rad/s", noisy=True,
    )  # fmt: skip
    size = found.amplitude("m")
    record_evidence(
        "Duffing oscillator: energies of the mode", size**2 / 2 + 0.1 * size**4 / 4, found.energies,
        tolerance=1e-8, topic=TOPIC, kind="closed form", source="x²/2 + εx⁴/4", unit="J", relative=True, noisy=True,
    )  # fmt: skip
    np.testing.assert_allclose(found.damping * 2 * TURN * found.frequencies, 0.05, rtol=1e-9)  # c = 2 ζ ω m


def test_damping_of_a_slider_with_one_harmonic(record_evidence) -> None:
    r"""Loop of Jenkins: with cos θ = 1 - 2 μN/(k A), Λc = kA/π (θ - sin θ cos θ), Λs = (4 μN/π) (1 - μN/(k A))."""
    found = backbone(one_mass(), np.geomspace(1.3, 1000.0, 25), method=HarmonicBalance(1, samples=8192))
    size, limit, stiffness = found.amplitudes, 1.0, 0.8
    theta = np.arccos(1 - 2 * limit / (stiffness * size))
    omega = np.sqrt(1 + stiffness / np.pi * (theta - np.sin(theta) * np.cos(theta)))
    loss = 4 * limit / np.pi * (1 - limit / (stiffness * size))
    record_evidence(
        "one mass with a slider, one harmonic: frequencies of the mode", omega, TURN * found.frequencies,
        tolerance=1e-6, topic=TOPIC, kind="closed form", source="Jenkins' element", unit="rad/s",
    )  # fmt: skip
    record_evidence(
        "one mass with a slider, one harmonic: damping ratios of the mode",
        0.02 / omega + loss / (2 * omega**2 * size), found.damping,
        tolerance=1e-6, topic=TOPIC, kind="closed form", source="Jenkins' element",
    )  # fmt: skip


def test_a_force_at_the_frequency_of_the_mode_keeps_its_motion(record_evidence) -> None:
    """With one degree of freedom and harmonic, a force in phase with the velocity is the negative damping itself."""
    method = HarmonicBalance(1, samples=1024)
    found = backbone(one_mass(), np.array([1.5, 3.0, 6.0]), method=method)
    forced = []
    for force, frequency in zip(found.forces, found.frequencies, strict=True):
        system = one_mass()
        system.forces[:] = [HarmonicForce("m", force)]
        forced.append(frequency_response(system, np.array([frequency]), method).amplitude("m", "harmonic 1")[0])
    record_evidence(
        "one mass with a slider, one harmonic: forced response at the mode's frequency and force",
        found.amplitudes, forced, tolerance=1e-8, topic=TOPIC, kind="other method", source="the mode's amplitude", unit="m", noisy=True,
    )  # fmt: skip


def test_the_mode_predicts_forced_peaks_with_friction(record_evidence) -> None:
    """Two masses with a slider: another mode is there, and the peak is not at the phase of the mode."""
    method = HarmonicBalance(7, samples=512)
    sizes = np.array([1.0, 2.0, 5.0, 10.0])
    found = backbone(two_masses(), sizes, method=method, dof="m2")
    peaks = []
    for force, frequency in zip(found.forces, found.frequencies, strict=True):
        system = two_masses()
        system.forces[:] = [HarmonicForce("m2", force)]
        curve = frequency_response(system, np.linspace(0.8, 1.2, 81) * frequency, method)
        peaks.append(curve.peak("m2", "harmonic 1"))
    record_evidence(
        "two masses with a slider: amplitudes of forced peaks from the mode", sizes,
        [peak.amplitude for peak in peaks], tolerance=0.01, topic=TOPIC,
        kind="other method", source="the mode at the force that its damping needs", unit="m", relative=True,
    )  # fmt: skip
    record_evidence(
        "two masses with a slider: frequencies of forced peaks from the mode", found.frequencies,
        [peak.frequency for peak in peaks], tolerance=0.02, topic=TOPIC,
        kind="other method", source="the mode at the force that its damping needs", unit="Hz", relative=True,
    )  # fmt: skip


def hardening(force: float) -> VibrationSystem:
    system = duffing()
    system.forces[:] = [HarmonicForce("m", force)]
    return system


def rubbing(preload: float) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("slider", "m", friction=0.5, preload=preload, law=ElasticSlider(0.8)))
    return system


def test_a_track_over_forces_is_that_of_whole_curves(record_evidence) -> None:
    method, forces = HarmonicBalance(7), np.linspace(0.02, 0.3, 15)
    track = track_resonance(hardening, "force", forces, (0.1, 0.3), method, dof="m", kind="harmonic 1", unit="N")
    assert track.converged.all()
    fine = HarmonicBalance(7, resolution=0.002)
    peaks, points = [], 0
    for force, frequency in zip(forces[::7], track.frequencies[::7], strict=True):
        ends = (0.13, 1.1 * frequency)  # from where there is one motion alone
        curve = frequency_response(hardening(force), ends, fine, continuation="arc-length")
        peaks.append(curve.peak("m", "harmonic 1"))
        points += len(curve)
    source = "largest points of whole curves, by splines"
    record_evidence(
        "Duffing oscillator: peaks over the force", [peak.amplitude for peak in peaks], track.amplitudes[::7],
        tolerance=1e-6, topic=TOPIC, kind="other method", source=source, unit="m", relative=True, noisy=True,
    )  # fmt: skip
    record_evidence(
        "Duffing oscillator: frequencies of the peaks over the force", [peak.frequency for peak in peaks],
        track.frequencies[::7], tolerance=1e-6, topic=TOPIC, kind="other method", source=source, unit="Hz", relative=True, noisy=True,
    )  # fmt: skip
    assert np.all(track.solves[1:] <= 8)
    assert track.solves[1:].mean() * len(peaks) < 0.05 * points


@pytest.mark.slow
def test_a_track_over_preloads_is_that_of_whole_curves(record_evidence) -> None:
    """With 8192 samples: a slider's curve has as many small edges as it has samples, and each may be a peak."""
    method, preloads = HarmonicBalance(5, samples=8192), np.geomspace(0.5, 8.0, 7)
    track = track_resonance(rubbing, "preload", preloads, (0.12, 0.25), method, dof="m", kind="harmonic 1", unit="N")
    assert track.converged.all()
    peaks, points = [], 0
    for preload, frequency in zip(preloads, track.frequencies, strict=True):
        near = frequency * (1 + 0.05 * np.linspace(-1, 1, 101))
        curve = frequency_response(rubbing(preload), near, method)
        peaks.append(curve.peak("m", "harmonic 1").amplitude)
        points += len(curve)
    record_evidence(
        "one mass with a slider: peaks over the preload", peaks, track.amplitudes, tolerance=1e-6, topic=TOPIC,
        kind="other method", source="largest points of whole curves, by splines", unit="m", relative=True, noisy=True,
    )  # fmt: skip
    assert track.solves[1:].sum() < 0.2 * points
