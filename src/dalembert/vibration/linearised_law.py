"""Compiled: how a disturbance of a displacement or of a slider changes the force and the slider, sample by sample."""

import numpy as np

from dalembert.vibration.compiled import compiled
from dalembert.vibration.friction_law import SETTLED, SWEEPS, update

STEP = 1e-30


@compiled
def linearised(motion, numbers, tangents, normal):
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
    size = columns + tangents
    result = np.zeros((samples, size, size))
    own = numbers.astype(np.complex128)
    d, z = np.zeros(columns, dtype=np.complex128), np.zeros(columns, dtype=np.complex128)
    moved = np.zeros(columns, dtype=np.complex128)
    force, before = np.zeros(columns, dtype=np.complex128), np.zeros(columns, dtype=np.complex128)
    scale = np.max(np.abs(motion))
    for sweep in range(SWEEPS):
        before[:] = z
        for t in range(samples):
            for direction in range(size):
                d[:] = motion[:, t]
                moved[:] = z
                if direction < columns:
                    d[direction] += 1j * STEP
                else:
                    moved[direction - columns] += 1j * STEP
                update(d, moved, force, own, tangents, normal, True)
                for row in range(columns):
                    result[t, row, direction] = force[row].imag / STEP
                for row in range(tangents):
                    result[t, columns + row, direction] = moved[row].imag / STEP
            d[:] = motion[:, t]
            update(d, z, force, own, tangents, normal, True)
        if sweep > 0 and np.max(np.abs(z - before)) <= SETTLED * scale:
            break
    return result
