"""Radau IIA: orders, accuracy, constraints, energy, outputs between the steps."""

import numpy as np
import pytest

import dalembert as da
from dalembert.multibody.integrators.shared.integrator import Integrator
from damped_slider_crank import damped_slider_crank
from flexible_pendulum import pendulum
from rigid_mechanisms import andrews, n_four_bar, read, two_link_arm
from soft_pendulum import soft

TOPIC = "Radau IIA"
SOURCE = "Hairer & Wanner, Solving Ordinary Differential Equations II (1996), IV.8 and VII.4"


@pytest.mark.parametrize(("mechanism", "coarsest"), [("rigid", 1.25e-2), ("soft", 2e-3)])
def test_fifth_order_in_position_and_velocity(reference, record_evidence, mechanism: str, coarsest: float) -> None:
    system = two_link_arm(reference("two_link_arm")["model"]) if mechanism == "rigid" else soft()
    names = [f"{body}.end.{entry}" for body in ("upper", "lower") for entry in ("x", "y", "vx", "vy")]

    def state(step: float) -> np.ndarray:
        return da.simulate(system, 0.4, solver=da.RadauIIA(step=step, stages=3), times=np.array([0.0, 0.4])).channels(
            names
        )[-1]

    coarse, middle, fine = (state(coarsest / factor) for factor in (1, 2, 4))
    for entry, rows in {"position": [0, 1, 4, 5], "velocity": [2, 3, 6, 7]}.items():
        gaps = np.linalg.norm((coarse - middle)[rows]), np.linalg.norm((middle - fine)[rows])
        record_evidence(
            f"Radau IIA: order in {entry}, {mechanism} double pendulum",
            5.0,
            np.log2(gaps[0] / gaps[1]),
            tolerance=0.4,
            topic=TOPIC,
            kind="published",
            source=SOURCE,
        )


@pytest.mark.parametrize(("stages", "coarse"), [(3, 12), (5, 8), (7, 6)])
def test_orders_of_all_stages(record_evidence, stages: int, coarse: int) -> None:
    """A mass that a spring without free length holds goes round an ellipse; no step is cut down, however long."""
    end = 12.0
    system = da.System(gravity=(0.0, 0.0))
    mass = system.add(da.PointMass("mass", 1.0, (1.0, 0.0), velocity=(0.0, 0.5)))
    system.add(da.Spring("spring", mass.centre, system.ground.point(0.0, 0.0), stiffness=1.0, free_length=0.0))
    exact = [np.cos(end), 0.5 * np.sin(end), -np.sin(end), 0.5 * np.cos(end)]

    def error(steps: int) -> float:
        solver = da.RadauIIA(step=end / steps, stages=stages)
        trajectory = da.simulate(system, end, solver=solver, times=np.array([0.0, end]))
        ours = trajectory.channels(["mass.centre.x", "mass.centre.y", "mass.centre.vx", "mass.centre.vy"])[-1]
        return float(np.abs(ours - exact).max())

    record_evidence(
        f"Radau IIA, {stages} stages: order, {coarse} and {2 * coarse} steps for two rounds of an oscillator",
        2 * stages - 1,
        np.log2(error(coarse) / error(2 * coarse)),
        tolerance=0.1,
        topic=TOPIC,
        kind="published",
        source="Hairer & Wanner, Stiff differential equations solved by Radau methods (1999)",
    )


def test_ninth_order_with_constraints(reference, record_evidence) -> None:
    system = two_link_arm(reference("two_link_arm")["model"])
    names = [f"{body}.end.{entry}" for body in ("upper", "lower") for entry in ("x", "y", "vx", "vy")]

    def state(step: float) -> np.ndarray:
        return da.simulate(system, 0.4, solver=da.RadauIIA(step=step), times=np.array([0.0, 0.4])).channels(names)[-1]

    coarse, middle, fine = (state(step) for step in (0.1, 0.05, 0.025))
    record_evidence(
        "Radau IIA, 5 stages: order in position and velocity, rigid double pendulum in 4, 8 and 16 steps",
        9.0,
        np.log2(np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine)),
        tolerance=0.4,
        topic=TOPIC,
        kind="published",
        source=SOURCE,
    )


@pytest.mark.parametrize(("stages", "tolerance"), [(3, 3e-10), (5, 3e-8), (7, 1e-9)])
def test_two_link_arm_to_ten_digits(reference, record_evidence, stages: int, tolerance: float) -> None:
    data = reference("two_link_arm")
    exact = data["extrapolated"]
    solver = da.RadauIIA(tolerance, stages=stages)
    trajectory = da.simulate(two_link_arm(data["model"]), 5.0, solver=solver, times=np.array([0.0, *exact["times"]]))
    angles = trajectory.channels(["upper.centre.angle", "lower.centre.angle"])[1:]
    for time, expected, ours in zip(exact["times"], exact["angles"], angles, strict=True):
        record_evidence(
            f"two-link arm, both angles at {time:g} s ({stages} stages, tolerance {tolerance:g})",
            expected,
            ours,
            unit="rad",
            tolerance=1e-10,
            relative=True,
            topic=TOPIC,
            kind="other method",
            source="explicit midpoint rule, extrapolated in extended precision",
        )


def test_two_link_arm_over_twenty_seconds(reference, record_evidence) -> None:
    """What the published minimisation by fireflies reaches at its finest step is the mark to beat."""
    trajectory = da.simulate(two_link_arm(reference("two_link_arm")["model"]), 20.0, solver=da.RadauIIA(tolerance=1e-6))
    total = trajectory.energies["total"]
    record_evidence(
        "two-link arm, largest relative error of the energy over 20 s (tolerance 1e-6)",
        0.0,
        np.abs(total / total[0] - 1).max(),
        tolerance=2.8e-4,
        topic=TOPIC,
        kind="published",
        source="below the published 2.88e-4 of the firefly algorithm at h = 2 ms",
    )
    for level, violation in trajectory.violations.items():
        record_evidence(
            f"two-link arm, constraints at the level of {level} over 20 s",
            np.zeros(len(violation)),
            violation,
            tolerance=1e-12,
            topic=TOPIC,
            kind="conservation law",
            source="constraints",
            noisy=True,
        )


def test_outputs_between_the_steps_are_as_exact(reference) -> None:
    system, times = two_link_arm(reference("two_link_arm")["model"]), np.linspace(0.0, 2.0, 777)
    names = ["lower.end.x", "lower.end.vy", "lower.end.ay", "O.force_x"]
    ours, exact = (
        da.simulate(system, 2.0, solver=solver, times=times).channels(names)
        for solver in (da.RadauIIA(3e-8), da.RadauIIA(1e-11, stages=3))
    )
    assert np.all(np.abs(ours - exact).max(axis=0) < [1e-9, 1e-8, 1e-7, 1e-7])


def test_constraints_hold_between_the_steps(reference) -> None:
    times = np.linspace(0.0, 1.0, 77)
    system = two_link_arm(reference("two_link_arm")["model"])
    coarse, fine = (da.simulate(system, 1.0, solver=da.RadauIIA(step=step), times=times) for step in (2e-2, 1e-3))
    assert max(violation.max() for violation in coarse.violations.values()) < 1e-12
    names = ["lower.end.x", "lower.end.vy", "lower.end.ay", "O.force_x"]
    gap = np.abs(coarse.channels(names) - fine.channels(names)).max(axis=0)
    assert np.all(gap < [1e-4, 1e-3, 1e-2, 1e-2])


def test_andrews_mechanism(reference, record_evidence) -> None:
    data = reference("andrews")
    end = data["end"]
    times = np.array([0.0, end["time"]])
    trajectory = da.simulate(
        andrews(data, data["initial"]["q"]), end["time"], solver=da.RadauIIA(tolerance=1e-9), times=times
    )
    ours = read(data, trajectory, -1)
    for entry, tolerance in {"q": 1e-8, "velocity": 1e-8, "acceleration": 1e-6, "multipliers": 1e-6}.items():
        record_evidence(
            f"Andrews' mechanism, {entry} at 0.03 s by Radau IIA",
            end[entry],
            ours[entry],
            tolerance=tolerance,
            relative=True,
            topic=TOPIC,
            kind=data["kind"],
            source=data["source"],
        )


def test_a_singular_position_is_named(reference) -> None:
    """Where the flat four-bar loses a constraint, its rates cannot be met: said with joints, time and what passes."""
    system = n_four_bar(reference("n_four_bar")["model"], 1)
    sentence = (
        r"^singular position: the joints 'foot0', 'foot1', 'left1', 'right1' lose independence at t = 0\.708\d* s.*"
        "GeneralizedAlpha and RungeKutta4 pass"
    )
    with pytest.raises(da.SolveError, match=sentence):
        da.simulate(system, 1.0, solver=da.RadauIIA(tolerance=1e-8))


def test_flexible_pendulum_agrees_with_generalized_alpha(record_evidence) -> None:
    system, times = pendulum(np.pi / 4, np.pi / 6), np.linspace(0.0, 0.5, 11)
    names = ["AB.end.x", "AB.end.y"]
    ours = da.simulate(system, 0.5, solver=da.RadauIIA(tolerance=1e-6), times=times).channels(names)
    other = da.simulate(system, 0.5, solver=da.GeneralizedAlpha(step=2e-5), times=times).channels(names)
    record_evidence(
        "flexible double pendulum, tip over 0.5 s, against generalized-α (h = 0.02 ms)",
        other,
        ours,
        unit="m",
        tolerance=1e-5,
        topic=TOPIC,
        kind="other method",
        source="generalized-α",
    )


@pytest.mark.parametrize(("damping", "span"), [(0.0, 0.002), (1e-4, 0.002), (1e-3, 0.0005)])
@pytest.mark.slow
def test_errors_of_a_stiff_slider_crank_fall_with_the_tolerance(record_evidence, damping: float, span: float) -> None:
    """Its rod is flexible and has material damping; the last row is near rounding."""
    system, times = damped_slider_crank(damping), np.array([0.0, span])
    names = [f"{place}.{entry}" for place in ("crank.end", "rod.end") for entry in ("x", "y", "vx", "vy")]

    def end(solver: Integrator) -> np.ndarray:
        return da.simulate(system, span, solver=solver, times=times).channels(names)[-1]

    exact = end(da.OdeSolver("DOP853", 1e-12, 1e-13, da.Partitioning()))
    for tolerance, bound in ((1e-6, 2e-7), (1e-8, 2e-10), (1e-10, 2e-12)):
        record_evidence(
            f"slider-crank, flexible rod (damping {damping:g} s), positions and velocities (tolerance {tolerance:g})",
            exact,
            end(da.RadauIIA(tolerance)),
            unit="m, m/s",
            tolerance=bound,
            topic=TOPIC,
            kind="other method",
            source="DOP853 with coordinate partitioning, relative tolerance 1e-12",
            noisy=True,
        )


def test_outputs_leave_the_motion_alone(reference) -> None:
    system = two_link_arm(reference("two_link_arm")["model"])
    few, many = (
        da.simulate(system, 1.0, solver=da.RadauIIA(tolerance=1e-8), times=np.linspace(0.0, 1.0, count))
        for count in (2, 500)
    )
    names = ["lower.end.x", "lower.end.vy"]
    np.testing.assert_array_equal(few.run.ends, many.run.ends)
    np.testing.assert_array_equal(few.channels(names)[-1], many.channels(names)[-1])
