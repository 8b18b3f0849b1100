"""A ring around a rotor, with friction against its turning."""

import numpy as np

CLEARANCE = 0.3e-3  # m
STIFFNESS = 120e3  # N/m
FRICTION = 0.05


def ring(motion):
    """Forces on the disc along x and y, N, (2, samples), at displacements (2, samples)."""
    x, y = motion
    radius = np.sqrt(x * x + y * y)
    touched = np.real(radius) > CLEARANCE
    # The normal force k (r - c) acts along the radius, and friction across it, against the rotation from x to y.
    share = STIFFNESS * np.where(touched, 1 - CLEARANCE / np.where(touched, radius, 1.0), 0.0)
    return np.stack([share * (x - FRICTION * y), share * (y + FRICTION * x)])
