"""Compiled: how a disturbance of a displacement or of a slider changes the force and the slider, sample by sample."""

import numpy as np

from dalembert.kernels.kernel import kernel
from dalembert.kernels.views import stack
from dalembert.kernels.words import Complexes, Reals2, Reals3
from dalembert.vibration.laws.friction_law import update
from dalembert.vibration.laws.friction_period import SWEEPS, largest, settled

STEP = 1e-30


@kernel
def linearise(motion: Reals2, numbers: Complexes, tangents: int, normal: bool, result: Reals3) -> None:
    columns, samples = motion.shape
    size = columns + tangents
    d, z, moved = stack(numbers, 3), stack(numbers, 2), stack(numbers, 2)
    force, before = stack(numbers, 3), stack(numbers, 2)
    scale = largest(motion)
    z[:] = 0.0
    for sweep in range(SWEEPS):
        for i in range(tangents):
            before[i] = z[i]
        for t in range(samples):
            for direction in range(size):
                for i in range(columns):
                    d[i] = motion[i, t]
                for i in range(tangents):
                    moved[i] = z[i]
                if direction < columns:
                    d[direction] += 1j * STEP
                else:
                    moved[direction - columns] += 1j * STEP
                update(d, moved, force, numbers, tangents, normal, True)
                for row in range(columns):
                    result[t, row, direction] = force[row].imag / STEP
                for row in range(tangents):
                    result[t, columns + row, direction] = moved[row].imag / STEP
            for i in range(columns):
                d[i] = motion[i, t]
            update(d, z, force, numbers, tangents, normal, True)
        if sweep > 0 and settled(z, before, tangents, scale):
            break


def linearised(motion: np.ndarray, numbers: np.ndarray, tangents: int, normal: bool) -> np.ndarray:
    """Derivatives of the elastic law at each sample, by complex steps through it.

    Parameters
    ----------
    motion : array, shape (tangents + normal, samples)
        Displacements of one contact.
    numbers : array, shape (5,)

    Returns
    -------
    array, shape (samples, columns + tangents, columns + tangents)
        Of forces and sliders (rows) by displacements and sliders before (columns).
    """
    columns, samples = motion.shape
    result = np.empty((samples, columns + tangents, columns + tangents))
    linearise(motion, numbers.astype(complex), tangents, normal, result)
    return result
