"""Orders of convergence, as measured rates."""

import numpy as np
import pytest

import dalembert as da

SOURCE = "Arnold & Brüls, Convergence of the generalized-α scheme for constrained mechanical systems (2007)"


def rigid() -> tuple[da.System, list[str]]:
    system = da.System()
    upper = system.add(da.RigidBar("upper", 1.0, 1.0, angle=np.pi / 3))
    lower = system.add(da.RigidBar("lower", 3.0, 2.0, angle=-np.pi / 6, start=upper.end))
    system.add(da.RevoluteJoint("O", system.ground, upper.start))
    system.add(da.RevoluteJoint("A", upper.end, lower.start))
    return system, ["upper", "lower"]


def flexible() -> tuple[da.System, list[str]]:
    section = {"density": 5540.0, "height": 0.4, "width": 0.2}
    system = da.System()
    oa = system.add(da.AncfBeam("upper", 1.0, 1, 2e6, angle=-np.pi / 4, poisson_ratio=0.3, **section))
    ab = system.add(da.AncfCable("lower", 2.0, 2, 2e6, angle=-np.pi / 6, start=oa.end, **section))
    system.add(da.RevoluteJoint("O", system.ground, oa.start))
    system.add(da.RevoluteJoint("A", oa.end, ab.start))
    return system, ["upper", "lower"]


@pytest.mark.parametrize(
    ("mechanism", "radius", "coarsest"),
    [
        *((rigid, 1.0, 8e-3), (rigid, 0.8, 8e-3), (rigid, 0.0, 2e-3)),
        *((flexible, 1.0, 2e-4), (flexible, 0.8, 2e-4), (flexible, 0.0, 5e-5)),
    ],
)
def test_second_order_in_position_and_velocity(record_evidence, mechanism, radius: float, coarsest: float) -> None:
    """Steps fine enough for the order and coarse enough for rounding not to show in it."""
    system, bodies = mechanism()
    names = [f"{body}.end.{entry}" for body in bodies for entry in ("x", "y", "vx", "vy")]

    def state(step: float) -> np.ndarray:
        solver = da.GeneralizedAlpha(step=step, spectral_radius=radius)
        return da.simulate(system, 0.4, solver=solver, times=np.array([0.0, 0.4])).channels(names)[-1]

    coarse, middle, fine = (state(coarsest / factor) for factor in (1, 2, 4))
    for entry, rows in {"position": [0, 1, 4, 5], "velocity": [2, 3, 6, 7]}.items():
        gaps = np.linalg.norm((coarse - middle)[rows]), np.linalg.norm((middle - fine)[rows])
        record_evidence(
            f"generalized-α, spectral radius {radius:g}: order in {entry}, {mechanism.__name__} double pendulum",
            2.0,
            np.log2(gaps[0] / gaps[1]),
            tolerance=0.1,
            topic="Convergence",
            kind="published",
            source=SOURCE,
        )


def test_a_start_without_accelerations_is_of_first_order(record_evidence) -> None:
    """The start that the published tables need; the reason why it is not the default."""
    system, _ = flexible()

    def tip(step: float) -> np.ndarray:
        solver = da.GeneralizedAlpha(step=step, initial_acceleration="zero")
        names = ["lower.end.x", "lower.end.y"]
        return da.simulate(system, 0.4, solver=solver, times=np.array([0.0, 0.4])).channels(names)[-1]

    coarse, middle, fine = (tip(step) for step in (8e-4, 4e-4, 2e-4))
    record_evidence(
        "generalized-α, zero initial accelerations: order in position, flexible double pendulum",
        1.0,
        np.log2(np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine)),
        tolerance=0.2,
        topic="Convergence",
        kind="published",
        source=SOURCE,
    )
