"""Strains at the surface of a body with modes, for the frames that are drawn."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class ModalStrains:
    """Magnitudes of the largest principal strains at corners over time; frames are computed where they are taken.

    Parameters
    ----------
    modes : array, shape (corners, 6, modes)
        Strains xx, yy, zz, yz, zx, xy of each mode.
    coordinates : array, shape (frames, modes)
        Modal coordinates.
    """

    modes: np.ndarray
    coordinates: np.ndarray

    def __getitem__(self, frames: slice | np.ndarray) -> np.ndarray:
        """Magnitudes at some frames, (frames, corners)."""
        corners, components, modes = self.modes.shape
        strains = np.real(self.coordinates)[frames] @ self.modes.reshape(-1, modes).T
        return largest_principal(strains.reshape(-1, corners, components))


def largest_principal(strains: np.ndarray) -> np.ndarray:
    r"""Return the magnitude of the principal strain that is largest in magnitude.

    The principal strains are :math:`m + 2 s \cos(\varphi + 2 \pi k / 3)`. m is their mean, s the root of a sixth of the
    sum of squares of the deviator, and :math:`\cos 3 \varphi` half of its determinant over :math:`s^3`.

    Parameters
    ----------
    strains : array, shape (..., 6)
        xx, yy, zz, yz, zx, xy; shears are half of the changed angles.

    Returns
    -------
    array, shape (...)

    Examples
    --------
    Tension along x, and pure shear:

    >>> largest_principal(np.array([[1e-3, -3e-4, -3e-4, 0, 0, 0], [0, 0, 0, 0, 0, 1e-3]])).round(9).tolist()
    [0.001, 0.001]
    """
    normal, shear = strains[..., :3], strains[..., 3:]
    mean = normal.mean(axis=-1)
    deviator = normal - mean[..., None]
    size = np.sqrt(((deviator**2).sum(axis=-1) + 2 * (shear**2).sum(axis=-1)) / 6)
    determinant = deviator.prod(axis=-1) + 2 * shear.prod(axis=-1) - (deviator * shear**2).sum(axis=-1)
    # Smaller sizes have a cube that underflows.
    cosine = np.divide(determinant, 2 * size**3, out=np.ones_like(size), where=size > 1e-90)
    angle = np.arccos(np.clip(cosine, -1.0, 1.0)) / 3
    ends = [np.abs(mean + 2 * size * np.cos(angle + turn)) for turn in (0.0, 2 * np.pi / 3)]
    return np.maximum(*ends)
