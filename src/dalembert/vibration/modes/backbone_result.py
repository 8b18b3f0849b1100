"""The result of following a nonlinear mode over its amplitude."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.errors import counted
from dalembert.findings import Finding
from dalembert.tables import Table, cells, labelled, noted, percent, shown, unless
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
        Amplitudes of the harmonic force on ``dof``, 90° ahead of its displacement, that balances the damping, N.
    shapes : array, shape (points, dofs, coefficients)
        The motions, m.
    iterations : array of int, shape (points,)
    residuals : array, shape (points,)
        Norm of the residual divided by that of the forces.
    converged : array of bool, shape (points,)
    samples : array of int, shape (points,)
        Of a period.
    provenance : mapping
        Versions, method, settings.
    findings : tuple of Finding
        ``"end-not-reached"`` where a path between two amplitudes did not come to the second;
        ``"harmonics-chosen"`` or ``"few-harmonics"`` where the number of harmonics was chosen.
    """

    FORMAT: ClassVar[str] = "dalembert backbone 1"
    TITLE: ClassVar[str] = "Nonlinear mode"

    mode: int
    dof: str
    dofs: tuple[str, ...]
    orders: tuple[int, ...]
    amplitudes: Annotated[np.ndarray, Over(("point",), lambda curve: unit_of(curve.dof))]
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
    findings: tuple[Finding, ...] = ()

    def amplitude(self, dof: str, kind: str = "peak") -> np.ndarray:
        """Size of the motion of a degree of freedom, m, (points,): ``"peak"``, ``"rms"`` or ``"harmonic 1"`` and so on.

        Raises
        ------
        InputError
            For another kind, or an unknown degree of freedom.
        """
        return Amplitude(kind, self.orders).of(self.shapes[:, observed_column(self.dofs, dof)])

    @property
    def status(self) -> str:
        """How many motions were found, and how far a path came that did not reach its end."""
        count = int(self.converged.sum())
        short = next((finding.values for finding in self.findings if finding.code == "end-not-reached"), None)
        if short is None:
            return f"Mode {self.mode} was found at {count} of {len(self)} amplitudes of {self.dof}."
        unit = unit_of(self.dof)
        came = f"came to {short['farthest']:.6g} {unit} and not to {short['end']:.6g} {unit}"
        points = f"{counted(count, 'point')} of a path over the amplitude of {self.dof}"
        return f"Mode {self.mode} was found at {points}, which {came}."

    def facts(self) -> dict[str, str]:
        facts = {"points": f"{int(self.converged.sum())} of {len(self)}"}
        if self.converged.any():
            for name, values, unit in (
                ("amplitude", self.amplitudes, unit_of(self.dof)),
                ("frequency", self.frequencies, "Hz"),
                ("kinetic energy", self.energies, "J"),
            ):
                ends = [shown(float(values[self.converged][end])) for end in (0, -1)]
                facts[name] = f"{' to '.join(dict.fromkeys(ends))} {unit}"
            facts["largest damping ratio"] = percent(self.damping[self.converged].max())
        return facts

    def tables(self) -> tuple[Table, ...]:
        """Return frequency, damping, energy and force over the amplitude."""
        columns = {
            labelled(f"amplitude of {self.dof}", unit_of(self.dof)): self.amplitudes,
            "frequency (Hz)": self.frequencies,
            "damping ratio (%)": cells(100 * np.asarray(self.damping), 4),
            "kinetic energy, largest (J)": cells(self.energies, 4),
            "force at resonance (N)": cells(self.forces, 4),
            "note": unless(self.converged, "not found"),
        }
        return (noted(Table.of("backbone", f"Mode {self.mode} over its amplitude", columns)),)
