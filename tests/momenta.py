"""Momenta of a motion, by what its kinetic energy gains where all velocities gain those of a rigid motion."""

import numpy as np

import dalembert as da
from dalembert.multibody.model.evaluate import energies


def momenta(trajectory: da.Trajectory) -> np.ndarray:
    """Linear momenta along x and y and the angular momentum about the origin, (samples, 3)."""
    structure, real = trajectory.lowered.structure, trajectory.lowered.real
    x, v, times = trajectory.states.x, trajectory.states.v, trajectory.times
    kinds = np.array([*structure.kinds, *[""] * (x.shape[1] - structure.n)])
    position, angle = np.flatnonzero(kinds == "position"), np.flatnonzero(kinds == "angle")
    found = []
    for motion in ("x", "y", "turn"):
        gained = np.zeros_like(v)
        if motion == "turn":
            vectors = np.flatnonzero((kinds != "angle") & (kinds != ""))
            gained[:, vectors[::2]], gained[:, vectors[1::2]] = -x[:, vectors[1::2]], x[:, vectors[::2]]
            gained[:, angle] = 1.0
        else:
            gained[:, position["xy".index(motion) :: 2]] = 1.0
        ahead, behind = (energies(real, x, v + sign * gained, times, times)[:, 0] for sign in (1, -1))
        found.append((ahead - behind) / 2)
    return np.column_stack(found)
