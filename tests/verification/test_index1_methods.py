"""The methods for the equations of index 1 against published motions, closed problems and rates."""

import re

import numpy as np
import pytest

import dalembert as da
from rigid_mechanisms import andrews, n_four_bar, read, two_link_arm

TOPIC = "Index-1 methods"
SOURCE = "Hairer, Nørsett & Wanner, Solving ordinary differential equations I (1993), the classical method of order 4"
WAYS = {
    "augmented": da.Augmented(),
    "Baumgarte (α = β = 10/s)": da.Baumgarte(10.0, 10.0),
    "projection": da.Projection(),
    "partitioning": da.Partitioning(),
}


@pytest.mark.parametrize("way", WAYS)
def test_fourth_order_of_runge_kutta(reference, record_evidence, way: str) -> None:
    system = two_link_arm(reference("two_link_arm")["model"])
    names = [f"{body}.end.{entry}" for body in ("upper", "lower") for entry in ("x", "y", "vx", "vy")]

    def state(step: float) -> np.ndarray:
        solver = da.RungeKutta4(step, WAYS[way])
        return da.simulate(system, 0.8, solver=solver, times=np.array([0.0, 0.8])).channels(names)[-1]

    coarse, middle, fine = (state(step) for step in (2e-3, 1e-3, 5e-4))
    for entry, rows in {"position": [0, 1, 4, 5], "velocity": [2, 3, 6, 7]}.items():
        gaps = np.linalg.norm((coarse - middle)[rows]), np.linalg.norm((middle - fine)[rows])
        record_evidence(
            f"Runge–Kutta 4, {way}: order in {entry}, two-link arm",
            4.0,
            np.log2(gaps[0] / gaps[1]),
            tolerance=0.25,
            topic=TOPIC,
            kind="published",
            source=SOURCE,
        )


def test_dense_output_keeps_the_order(reference, record_evidence) -> None:
    """Largest error in the middles of the steps, against a method of order 8."""
    system = two_link_arm(reference("two_link_arm")["model"])

    def error(step: float) -> float:
        middles = np.arange(0.5, round(0.8 / step)) * step
        ours, exact = (
            da.simulate(system, 0.8, solver=solver, times=middles).channels(["lower.end.x", "lower.end.vy"])
            for solver in (da.RungeKutta4(step), da.OdeSolver("DOP853", 1e-12, 1e-13))
        )
        return np.max(np.abs(ours - exact))

    errors = [error(step) for step in (4e-3, 2e-3)]
    record_evidence(
        "Runge–Kutta 4, projection: order of the motion between the steps, two-link arm",
        4.0,
        np.log2(errors[0] / errors[1]),
        tolerance=0.25,
        topic=TOPIC,
        kind="published",
        source=SOURCE,
    )


@pytest.mark.parametrize(
    ("solver", "name"),
    [
        (da.RungeKutta4(2e-3), "Runge–Kutta 4, projection"),
        # At one of five tolerances tried, 1e-10, a step ends in a singular position; see below.
        (da.OdeSolver("DOP853", 1e-9, 1e-11, da.Partitioning()), "DOP853, partitioning"),
    ],
    ids=["RK4", "DOP853"],
)
def test_four_bar_through_its_singular_positions(reference, record_evidence, solver, name: str) -> None:
    data = reference("n_four_bar")
    time = data["values"]["time"]
    trajectory = da.simulate(n_four_bar(data["model"], 1), time, solver=solver, times=np.array([0.0, time]))
    record_evidence(
        f"four-bar mechanism (A02), x and y of B0 at 10 s, {name}",
        data["values"]["position"][0],
        trajectory.channels(["U0.end.x", "U0.end.y"])[-1],
        unit="m",
        tolerance=1e-6,
        relative=True,
        topic=TOPIC,
        kind=data["kind"],
        source=data["source"],
    )
    assert all(np.max(level) < 1e-12 for level in trajectory.violations.values())


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_auto_passes_the_flat_four_bar(reference, record_evidence, tolerance: float) -> None:
    """Radau IIA stops in the singular position; the method that passes it runs the motion again."""
    data = reference("n_four_bar")
    time = data["values"]["time"]
    times = np.array([0.0, time])
    system, model = n_four_bar(data["model"], 1), {**data["model"]}
    trajectory = da.simulate(system, time, da.Automatic(tolerance), times)
    assert isinstance(trajectory.solver, da.OdeSolver)
    names = ["U0.end.x", "U0.end.y"]
    ours = trajectory.channels(names)[-1]
    record_evidence(
        f"four-bar mechanism (A02), x and y of B0 at 10 s, auto with a tolerance of {tolerance:g}",
        data["values"]["position"][0],
        ours,
        unit="m",
        tolerance=100 * tolerance,
        topic=TOPIC,
        kind=data["kind"],
        source=data["source"],
    )
    response = da.TimeResponse(
        lambda gravity: n_four_bar({**model, "gravity": gravity}, 1), {"gravity": (9.0, 10.0)}, names, times,
        da.Automatic(tolerance),
    )  # fmt: skip
    np.testing.assert_array_equal(response.evaluate(np.array([[model["gravity"]]])).only()[0, -1], ours)


@pytest.mark.slow
def test_a_run_that_stays_in_a_singular_position_ends(reference) -> None:
    """A step may end there to rounding: the accelerations cannot be resolved, and the steps become rounding.

    Rounding decides in which of the flat positions, and whether in any. A run is never wrong without a message.
    """
    data = reference("n_four_bar")
    system, times = n_four_bar(data["model"], 1), np.linspace(0.0, 10.0, 20_001)
    height = da.simulate(system, 10.0, da.GeneralizedAlpha(5e-4, 0.95), times).channels(["U0.end.y"])[:, 0]
    flat = times[1:][np.diff(np.sign(height)) != 0]
    for tolerance in (1e-10, 1e-11):
        solver = da.OdeSolver("DOP853", tolerance, 0.01 * tolerance, da.Partitioning())
        try:
            end = da.simulate(system, 10.0, solver, times[[0, -1]]).channels(["U0.end.x", "U0.end.y"])[-1]
            # Errors of the steps grow on the way: by a factor of up to 600 where a run passes all flat positions.
            np.testing.assert_allclose(end, data["values"]["position"][0], rtol=0.0, atol=1e3 * tolerance)
        except da.SolveError as error:
            found = re.match(r"singular position: the joints 'foot0', .* lose independence at t = (\S+) s", str(error))
            assert found
            assert np.abs(flat - float(found[1])).min() < 1e-3


PUBLISHED = "Zhang & Ding, Firefly algorithm for solving multibody dynamics differential-algebraic equations (2021)"


def test_published_drift_of_the_augmented_equations(reference, record_evidence) -> None:
    """Published: energy 9.08e-2, position 4.0e-2, velocity 4.2e-3, acceleration 7.8e-14 over 20 s at h = 0.01 s.

    The motion is chaotic, so that only the sizes can come back: our drift is half of it. What a stabilisation gains
    is exact, whatever the digits.
    """
    system = two_link_arm(reference("two_link_arm")["model"])
    runs = {way: da.simulate(system, 20.0, da.RungeKutta4(0.01, WAYS[way])) for way in WAYS}
    errors = {way: np.max(np.abs(run.energies["total"] / run.energies["total"][0] - 1)) for way, run in runs.items()}
    drift = {way: run.violations["position"].max() for way, run in runs.items()}
    for quantity, published, ours in (
        ("energy", 9.08e-2, errors["augmented"]),
        ("position", 4.0e-2, drift["augmented"]),
        ("velocity", 4.2e-3, runs["augmented"].violations["velocity"].max()),
    ):
        record_evidence(
            f"two-link arm, Runge–Kutta 4 without stabilisation, h = 0.01 s: decimal power of the {quantity}'s error",
            np.log10(published),
            np.log10(ours),
            tolerance=0.6,
            topic=TOPIC,
            kind="published",
            source=PUBLISHED,
        )
    assert drift["Baumgarte (α = β = 10/s)"] < 0.05 * drift["augmented"]
    for way in ("projection", "partitioning"):
        assert errors[way] < 0.05 * errors["augmented"]
        assert all(np.max(level) < 1e-12 for level in runs[way].violations.values())


def test_flexible_pendulum(record_evidence) -> None:
    """A soft one: its fastest vibration allows the explicit method steps of 20 µs."""
    section = {"density": 1000.0, "height": 0.1, "width": 0.1}
    system = da.System()
    upper = system.add(da.RigidBar("upper", 1.0, 5.0, angle=-np.pi / 4))
    lower = system.add(da.AncfCable("lower", 1.0, 2, 2e5, angle=-np.pi / 6, start=upper.end, **section))
    system.add(da.RevoluteJoint("O", system.ground, upper.start))
    system.add(da.RevoluteJoint("A", upper.end, lower.start))
    times = np.array([0.0, 0.25, 0.5])
    alpha = da.simulate(system, 0.5, da.GeneralizedAlpha(1e-5, spectral_radius=0.95), times)
    names = ["lower.end.x", "lower.end.y"]
    for name, solver in {
        "Runge–Kutta 4, projection": da.RungeKutta4(5e-4),
        "Radau, partitioning": da.OdeSolver("Radau", 1e-8, 1e-9, da.Partitioning()),
    }.items():
        record_evidence(
            f"soft flexible pendulum, tip at 0.25 and 0.5 s, {name} against generalized-α",
            alpha.channels(names)[1:],
            da.simulate(system, 0.5, solver, times).channels(names)[1:],
            unit="m",
            tolerance=1e-5,
            relative=True,
            topic=TOPIC,
            kind="other method",
            source="generalized-α at a fine step",
        )


@pytest.mark.parametrize(
    ("solver", "name"),
    [
        (da.OdeSolver("DOP853", 1e-10, 1e-12), "DOP853, projection"),
        (da.RungeKutta4(1e-5), "Runge–Kutta 4, projection, h = 10 µs"),
    ],
    ids=["DOP853", "RK4"],
)
def test_andrews_mechanism(reference, record_evidence, solver, name: str) -> None:
    """Accelerations and forces of the test set carry fewer digits than its coordinates: our methods agree in more."""
    data = reference("andrews")
    end = data["end"]
    system = andrews(data, data["initial"]["q"])
    trajectory = da.simulate(system, end["time"], solver=solver, times=np.array([0.0, end["time"]]))
    ours = read(data, trajectory, -1)
    units = {"q": "rad", "velocity": "rad/s", "acceleration": "rad/s²", "multipliers": "N"}
    for entry, tolerance in {"q": 1e-8, "velocity": 1e-8, "acceleration": 1e-6, "multipliers": 1e-6}.items():
        record_evidence(
            f"Andrews' mechanism, {entry} at 0.03 s, {name}",
            end[entry],
            ours[entry],
            unit=units[entry],
            tolerance=tolerance,
            relative=True,
            topic=TOPIC,
            kind=data["kind"],
            source=data["source"],
        )
