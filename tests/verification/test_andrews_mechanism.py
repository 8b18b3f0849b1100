"""Andrews' squeezing mechanism: seven bodies, ten joints, thousands of radians a second."""

import numpy as np
from numpy.typing import ArrayLike

import dalembert as da
from rigid_mechanisms import andrews, read

ROWS = {
    "q": ("seven angles", "rad"),
    "velocity": ("seven angular velocities", "rad/s"),
    "acceleration": ("seven angular accelerations", "rad/s²"),
    "multipliers": ("six joint forces", "N"),
}


def demanded_in(data: dict, q: ArrayLike, rates: ArrayLike = (0.0,) * 7) -> dict[str, np.ndarray]:
    """The accelerations and joint forces that the equations of motion demand in a state."""
    trajectory = da.simulate(andrews(data, q, rates), 1e-6, solver=da.GeneralizedAlpha(step=1e-6))
    return read(data, trajectory, 0)


def test_end_values_of_the_test_set(reference, record_evidence) -> None:
    """Angles and velocities gain from a fine step; accelerations of index 3 carry the rounding over its square.

    So the accelerations and forces to six digits are those that the equations of motion demand in the end state, and
    those of the integrator itself are compared at a step at which rounding does not show.
    """
    data = reference("andrews")
    end = data["end"]

    def last(step: float, radius: float) -> dict[str, np.ndarray]:
        solver = da.GeneralizedAlpha(step=step, spectral_radius=radius)
        system = andrews(data, data["initial"]["q"])
        times = np.array([0.0, end["time"]])
        return read(data, da.simulate(system, end["time"], solver=solver, times=times), -1)

    def record(entry: str, ours: np.ndarray, tolerance: float, how: str = "") -> None:
        quantity, unit = ROWS[entry]
        record_evidence(
            f"Andrews' mechanism, {quantity} at 0.03 s{how}",
            end[entry],
            ours,
            unit=unit,
            tolerance=tolerance,
            relative=True,
            topic="Rigid mechanisms",
            kind=data["kind"],
            source=data["source"],
        )

    fine, coarse = last(5e-7, 0.95), last(2.5e-6, 0.8)
    demanded = demanded_in(data, fine["q"], fine["velocity"])
    for entry in ("q", "velocity"):
        record(entry, fine[entry], 1e-6)
    for entry in ("acceleration", "multipliers"):
        record(entry, demanded[entry], 1e-6, " (demanded by the end state)")
        record(entry, coarse[entry], 2e-5, " (the integrator's own, h = 2.5 µs)")


def test_initial_accelerations_and_joint_forces(reference, record_evidence) -> None:
    data = reference("andrews")
    initial = data["initial"]
    ours = demanded_in(data, initial["q"])
    for entry in ("acceleration", "multipliers"):
        quantity, unit = ROWS[entry]
        record_evidence(
            f"Andrews' mechanism, {quantity} at first",
            initial[entry],
            ours[entry],
            unit=unit,
            tolerance=1e-10,
            relative=True,
            noisy=True,
            topic="Rigid mechanisms",
            kind=data["kind"],
            source=data["source"],
        )
