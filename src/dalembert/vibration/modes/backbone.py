"""The result of following a nonlinear mode."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from dalembert.contents import Contents
from dalembert.results import Result
from dalembert.units import unit_of
from dalembert.vibration.paths.amplitudes import Amplitude, observed_column
from dalembert.vibration.storage import fields_of, stored

if TYPE_CHECKING:
    from xarray import Dataset

_DIMENSIONS = {
    "amplitudes": ("point",),
    "frequencies": ("point",),
    "damping": ("point",),
    "energies": ("point",),
    "forces": ("point",),
    "iterations": ("point",),
    "residuals": ("point",),
    "converged": ("point",),
    "samples": ("point",),
    "shapes": ("point", "dof", "coefficient"),
}
_UNITS = {"amplitudes": "m", "frequencies": "Hz", "energies": "J", "forces": "N", "shapes": "m"}
_NAMES = ("mode", "dof", "dofs", "orders")


@dataclass(frozen=True, eq=False)
class Backbone(Result):
    """Frequency, damping and shape of a nonlinear mode over its amplitude, as :func:`backbone` returns them.

    Parameters
    ----------
    mode : int
        Its number among the linear modes of the system at rest, from 1.
    dof : str
        Degree of freedom by which the amplitude is measured.
    dofs : tuple of str
    orders : tuple of int
        Harmonics; the coefficients are the mean, if it is kept, then a cosine and a sine for each other one.
    amplitudes : array, shape (points,)
        Of the first harmonic of ``dof``, m.
    frequencies : array, shape (points,)
        Hz; NaN, as what follows, where a point was not found.
    damping : array, shape (points,)
        Damping ratios.
    energies : array, shape (points,)
        Largest kinetic energies of the period, J.
    forces : array, shape (points,)
        Amplitudes of a force on ``dof`` that a quarter of a period ahead of it keeps the motion going, N.
    shapes : array, shape (points, dofs, coefficients)
        The motions, m.
    iterations : array of int, shape (points,)
    residuals : array, shape (points,)
        As part of the forces.
    converged : array of bool, shape (points,)
    samples : array of int, shape (points,)
        Of a period.
    provenance : mapping
        Versions, method, settings.
    """

    FORMAT: ClassVar[str] = "dalembert backbone 1"

    mode: int
    dof: str
    dofs: tuple[str, ...]
    orders: tuple[int, ...]
    amplitudes: np.ndarray
    frequencies: np.ndarray
    damping: np.ndarray
    energies: np.ndarray
    forces: np.ndarray
    shapes: np.ndarray
    iterations: np.ndarray
    residuals: np.ndarray
    converged: np.ndarray
    samples: np.ndarray
    provenance: Mapping[str, Any]

    def __len__(self) -> int:
        return len(self.amplitudes)

    def amplitude(self, dof: str, kind: str = "peak") -> np.ndarray:
        """Size of the motion of a degree of freedom, m, (points,): ``"peak"``, ``"rms"`` or ``"harmonic 1"`` and so on.

        Raises
        ------
        InputError
            For another kind, or an unknown degree of freedom.
        """
        return Amplitude(kind, self.orders).of(self.shapes[:, observed_column(self.dofs, dof)])

    @property
    def success(self) -> bool:
        """Whether every motion is converged."""
        return bool(self.converged.all())

    @property
    def status(self) -> str:
        """How many were found, in a sentence."""
        return self.summary().partition("\n")[0]

    def summary(self) -> str:
        """A few lines: points, and the ranges of frequency, damping and energy."""
        found = self.converged
        lines = [f"mode {self.mode} at {found.sum()} of {len(self)} amplitudes of {self.dof}"]
        if found.any():
            ranges = [
                f"{name} {values[found].min():.6g} to {values[found].max():.6g}{unit}"
                for name, values, unit in (
                    ("amplitudes", self.amplitudes, f" {unit_of(self.dof)}"),
                    ("frequencies", self.frequencies, " Hz"),
                    ("damping ratios", self.damping, ""),
                    ("energies", self.energies, " J"),
                )
            ]
            lines.append(", ".join(ranges))
        if not found.all():
            lost = ", ".join(f"{value:.6g} {unit_of(self.dof)}" for value in self.amplitudes[~found][:5])
            lines.append(f"not found: {lost}")
        return "\n".join(lines)

    def contents(self) -> Contents:
        return stored(self, _DIMENSIONS, {**_UNITS, "amplitudes": unit_of(self.dof)}, _NAMES)

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> "Backbone":
        """The backbone that :meth:`to_xarray` turned into a dataset."""
        return cls(**fields_of(dataset, _DIMENSIONS, ("converged",)))
