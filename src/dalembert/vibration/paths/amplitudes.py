"""Sizes of periodic motions of observed degrees of freedom, from their harmonics."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.errors import InputError, require_known, unknown
from dalembert.vibration.fourier import synthesis

PHASES = 4096
"""Instants of a period among which a peak is sought."""
KINDS = "'peak', 'rms', or 'harmonic K' with K among the harmonics kept"


@dataclass(frozen=True)
class Amplitude:
    """A size of a periodic motion: its largest absolute value, its root mean square, or one harmonic's amplitude.

    ``kind``: ``"peak"``, ``"rms"``, or ``"harmonic 1"`` and so on. Raises InputError for another kind.
    """

    kind: str
    orders: tuple[int, ...]

    def __post_init__(self) -> None:
        if self.kind not in ("peak", "rms") and self._order() not in self.orders:
            kept = ", ".join(map(str, self.orders))
            raise InputError(f"the kind of amplitude is {self.kind!r}; expected {KINDS}: {kept}")

    def of(self, coefficients: np.ndarray) -> np.ndarray:
        """Return the sizes of motions with coefficients (..., coefficients)."""
        if self.kind == "peak":
            return np.abs(coefficients @ self._waves.T).max(axis=-1)
        return np.sqrt(coefficients**2 @ self._weights())

    def slope(self, coefficients: np.ndarray) -> np.ndarray:
        """Return the derivative of the size by the coefficients, both (..., coefficients)."""
        if self.kind == "peak":
            waves = self._waves
            samples = coefficients @ waves.T
            largest = np.abs(samples).argmax(axis=-1)
            sign = np.sign(np.take_along_axis(samples, largest[..., None], axis=-1))
            return sign * waves[largest]
        size = self.of(coefficients)[..., None]
        return coefficients * self._weights() / np.where(size > 0, size, 1.0)

    def instant(self, coefficients: np.ndarray) -> float:
        """Phase, rad, at which a motion (coefficients,) is largest, to a 4096th of the period."""
        return float(2 * np.pi * np.abs(self._waves @ coefficients).argmax() / PHASES)

    def _order(self) -> int:
        return _order(self.kind)

    @cached_property
    def _waves(self) -> np.ndarray:
        return synthesis(self.orders, 2 * np.pi * np.arange(PHASES) / PHASES)

    def _weights(self) -> np.ndarray:
        each = np.array([h for h in self.orders for _ in range(1 if h == 0 else 2)])
        if self.kind == "rms":
            return np.where(each == 0, 1.0, 0.5)
        return np.where(each == self._order(), 1.0, 0.0)


def highest_order(*kinds: str) -> int:
    """Return the highest harmonic that kinds of amplitude name; 1 if they name none.
    >>> highest_order("peak", "harmonic 5")
    5
    """
    return max(1, *map(_order, kinds))


def _order(kind: str) -> int:
    """The harmonic that a kind of amplitude names, or -1."""
    word, _, number = kind.partition(" ")
    return int(number) if word == "harmonic" and number.isdigit() else -1


def coordinate_row(coordinates: Sequence[str], name: str) -> int:
    """Return the row of a coordinate that elements see."""
    require_known("coordinate", name, coordinates)
    return coordinates.index(name)


def observed_column(dofs: Sequence[str], dof: str) -> int:
    """Return the column of an observed degree of freedom."""
    of_node = [name for name in dofs if name.rpartition(".")[0] == dof]
    name = of_node[0] if len(of_node) == 1 else dof
    if name not in dofs:
        raise InputError(unknown("observed degree of freedom", dof, dofs))
    return dofs.index(name)
