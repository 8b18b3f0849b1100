"""Momenta of a motion, by what its kinetic energy gains where all velocities gain those of a rigid motion."""

import numpy as np

import dalembert as da
from dalembert.multibody.model.evaluate import energies

VECTORS = ("position", "director", "gradient")


def momenta(trajectory: da.Trajectory) -> np.ndarray:
    """Linear momenta along the axes and angular momenta about the origin, (samples, 3), or (samples, 6) in space."""
    structure, real = trajectory.lowered.structure, trajectory.lowered.real
    x, v, times = trajectory.states.x, trajectory.states.v, trajectory.times
    dimension = trajectory.lowered.dimension
    kinds = np.array([*structure.kinds, *[""] * (x.shape[1] - structure.n)])
    position, vectors = np.flatnonzero(kinds == "position"), np.flatnonzero(np.isin(kinds, VECTORS))
    turns = [(0, 1)] if dimension == 2 else [(1, 2), (2, 0), (0, 1)]
    found = []
    for motion in (*range(dimension), *turns):
        gained = np.zeros_like(v)
        if isinstance(motion, tuple):
            first, second = (vectors[axis::dimension] for axis in motion)
            gained[:, first], gained[:, second] = -x[:, second], x[:, first]
            gained[:, (kinds == "angle") & (dimension == 2)] = 1.0
        else:
            gained[:, position[motion::dimension]] = 1.0
        ahead, behind = (energies(real, x, v + sign * gained, times, times)[:, 0] for sign in (1, -1))
        found.append((ahead - behind) / 2)
    return np.column_stack(found)
