"""A periodic motion in time."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.errors import InputError
from dalembert.tables import Table, counted, shown
from dalembert.units import unit_of
from dalembert.vibration.paths.amplitudes import PHASES, Amplitude, coordinate_row, observed_column
from dalembert.vibration.storage import Over, VibrationResult


@dataclass(frozen=True, eq=False)
class PeriodicMotion(VibrationResult):
    """One period of a motion in time, as :func:`steady_state` returns it.

    Parameters
    ----------
    dofs, coordinates, contacts : tuple of str
        Names of the observed degrees of freedom, of the coordinates that elements see, and of the friction contacts.
    frequency : float
        Hz.
    times : array, shape (times,)
        s, from 0 to a step before the end of the period.
    displacements : array, shape (times, dofs)
        m.
    relative, forces : array, shape (times, coordinates)
        m and N, of the elements; normal forces are those beyond the preload.
    states : array of uint8, shape (times, contacts)
        0 separated, 1 stuck, 2 slipping; of several cells the one that gives way most.
    periods : int
        How many were gone through.
    residual : float
        Change of the motion over the last period, as part of its size.
    converged : bool
        Whether that is within the tolerance.
    provenance : mapping
        Versions, method, settings.
    """

    FORMAT: ClassVar[str] = "dalembert periodic motion 1"
    TITLE: ClassVar[str] = "Periodic motion"
    VERDICTS: ClassVar[tuple[str, str]] = ("periodic", "not periodic")

    dofs: tuple[str, ...]
    coordinates: tuple[str, ...]
    contacts: tuple[str, ...]
    frequency: float
    times: Annotated[np.ndarray, Over(("time",), "s")]
    displacements: Annotated[np.ndarray, Over(("time", "dof"), "m")]
    relative: Annotated[np.ndarray, Over(("time", "coordinate"), "m")]
    forces: Annotated[np.ndarray, Over(("time", "coordinate"), "N")]
    states: Annotated[np.ndarray, Over(("time", "contact"))]
    periods: int
    residual: float
    converged: bool
    provenance: Mapping[str, Any]

    def motion(self, dof: str) -> np.ndarray:
        """Displacement of an observed degree of freedom, m, (times,); a node with only one may stand alone.

        Raises
        ------
        InputError
            For one that was not observed.
        """
        return self.displacements[:, observed_column(self.dofs, dof)]

    def harmonics(self, dof: str, highest: int) -> np.ndarray:
        """Coefficients of the harmonics 0, 1, ... up to a highest: the mean, then a cosine and a sine each."""
        return _coefficients(self.motion(dof), highest)

    def amplitude(self, dof: str, kind: str = "peak") -> float:
        """Size of the motion, m: ``"peak"``, ``"rms"`` or ``"harmonic 1"`` and so on.

        The peak is sought on the trigonometric polynomial through the samples.

        Raises
        ------
        InputError
            For another kind, or a degree of freedom that was not observed.
        """
        highest = (len(self.times) - 1) // 2
        size, samples = Amplitude(kind, tuple(range(highest + 1))), self.motion(dof)
        if kind == "peak":
            # The trigonometric polynomial through the samples, at 4096 instants: steps are too long to contain the
            # peak.
            return float(np.abs(np.fft.irfft(np.fft.rfft(samples, norm="forward"), PHASES, norm="forward")).max())
        return float(size.of(_coefficients(samples, highest)))

    def loop(self, coordinate: str) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (m) and force (N) of an element's coordinate over the period, closed, (times + 1,) each."""
        row = coordinate_row(self.coordinates, coordinate)
        closed = np.arange(len(self.times) + 1) % len(self.times)
        return self.relative[closed, row], self.forces[closed, row]

    def dissipated(self, coordinate: str) -> float:
        """Energy that an element takes from the motion in the period along a coordinate, J: ∮ λ du by trapezia."""
        u, force = self.loop(coordinate)
        # ∮ λ du by trapezia.
        return float(np.diff(u) @ (force[1:] + force[:-1]) / 2)

    @property
    def success(self) -> bool:
        """Whether the motion repeats itself within the tolerance."""
        return self.converged

    @property
    def status(self) -> str:
        """Whether the motion repeats itself, in a sentence."""
        return "The motion repeats itself." if self.converged else "The motion does not repeat itself yet."

    def facts(self) -> dict[str, str]:
        return {
            "frequency": f"{shown(self.frequency)} Hz",
            "periods": counted(self.periods),
            "change over the last one": shown(self.residual, digits=2),
            "steps of a period": counted(len(self.times)),
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the sizes of the motion."""
        columns = {
            "degree of freedom": self.dofs,
            "largest amplitude": [self.amplitude(dof) for dof in self.dofs],
            "rms": [self.amplitude(dof, "rms") for dof in self.dofs],
            "unit": map(unit_of, self.dofs),
        }
        return (Table.of("sizes", "Sizes of the motion", columns),)


def _coefficients(samples: np.ndarray, highest: int) -> np.ndarray:
    """Real Fourier coefficients 0..highest of equally spaced samples of a period."""
    if 2 * highest >= len(samples):
        raise InputError(
            f"The motion has {len(samples)} samples of a period, too few for {highest} harmonics. Use at least "
            f"{2 * highest + 1} steps of a period"
        )
    # X_c - i X_s is twice the coefficient of a real transform, except for the mean.
    phasors = np.fft.rfft(samples, norm="forward")[: highest + 1]
    pairs = np.column_stack([2 * phasors.real, -2 * phasors.imag]).ravel()
    return np.append(phasors[0].real, pairs[2:])
