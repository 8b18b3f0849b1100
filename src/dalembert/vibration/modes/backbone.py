"""The result of following a nonlinear mode."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.units import unit_of
from dalembert.vibration.paths.amplitudes import Amplitude, observed_column
from dalembert.vibration.storage import ConvergedResult, Over

Points = Annotated[np.ndarray, Over(("point",))]


@dataclass(frozen=True, eq=False)
class Backbone(ConvergedResult):
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
    amplitudes: Annotated[np.ndarray, Over(("point",), lambda own: unit_of(own.dof))]
    frequencies: Annotated[np.ndarray, Over(("point",), "Hz")]
    damping: Points
    energies: Annotated[np.ndarray, Over(("point",), "J")]
    forces: Annotated[np.ndarray, Over(("point",), "N")]
    shapes: Annotated[np.ndarray, Over(("point", "dof", "coefficient"), "m")]
    iterations: Points
    residuals: Points
    converged: Points
    samples: Points
    provenance: Mapping[str, Any]

    def amplitude(self, dof: str, kind: str = "peak") -> np.ndarray:
        """Size of the motion of a degree of freedom, m, (points,): ``"peak"``, ``"rms"`` or ``"harmonic 1"`` and so on.

        Raises
        ------
        InputError
            For another kind, or an unknown degree of freedom.
        """
        return Amplitude(kind, self.orders).of(self.shapes[:, observed_column(self.dofs, dof)])

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
