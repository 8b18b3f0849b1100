"""A response over frequency."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.tables import Table
from dalembert.vibration.fourier import synthesis
from dalembert.vibration.paths.amplitudes import Amplitude, coordinate_row, observed_column
from dalembert.vibration.paths.curve_tables import curve_facts, curve_status, curve_tables
from dalembert.vibration.storage import ConvergedResult, Over


class Peak(NamedTuple):
    """The largest response of a curve: frequency in Hz, and amplitude."""

    frequency: float
    amplitude: float


_ROUNDING = 1e-10  # of the work done in and out in a period: energies below it are none

Points = Annotated[np.ndarray, Over(("point",))]


@dataclass(frozen=True, eq=False)
class FrequencyCurve(ConvergedResult):
    """Periodic responses of a system over frequency, as :func:`frequency_response` returns them.

    Parameters
    ----------
    dofs, coordinates, contacts : tuple of str
        Names of the observed degrees of freedom, of the coordinates that elements see, and of the friction contacts.
    orders : tuple of int
        Harmonics; the coefficients are the mean, if it is kept, then a cosine and a sine for each other one.
    frequencies : array, shape (points,)
        Hz, in the order of the path.
    response : array, shape (points, dofs, coefficients)
        m; NaN where a point was not found.
    displacements, forces : array, shape (points, coordinates, coefficients)
        m and N, of the elements; normal forces are those beyond the preload.
    states : array of uint8, shape (points, contacts, phases)
        0 separated, 1 stuck, 2 slipping, over the period; of several cells the one that gives way most.
    unknowns : array, shape (points, retained, coefficients)
        From which a curve can be restarted.
    iterations : array of int, shape (points,)
    residuals : array, shape (points,)
        Norm of the residual divided by that of the forces; by receptances, by that of the motion of the contacts.
    converged : array of bool, shape (points,)
    fold : array of bool, shape (points,)
        Where the path has a fold in frequency.
    samples : array of int, shape (points,)
        Of a period.
    sampling_errors : array, shape (points,)
        Change of the residual with twice as many, as part of the forces.
    stable : array of int8, shape (points,)
        1 stable, 0 unstable, -1 where it was not asked for, the point was not found, or a stop is touched and twice
        the harmonics change the largest growth by more than this growth, or a fold lies between the motion and the
        one with more harmonics, by which the stability is judged. A fold has what comes before.
    load_factors : array, shape (points,)
        Of the varying forces; 1 where no amplitude is held.
    markers : tuple of (str, int)
        Bifurcations and their points: ``"fold"``, and where stability was asked for ``"torus"``, ``"period doubling"``
        and ``"branch point"``.
    provenance : mapping
        Versions, method, settings.
    findings : tuple of Finding
        ``"unbalanced-mean"``, ``"force-not-finite"``, ``"undamped-resonance"`` or ``"points-not-found"`` where points
        were not found; ``"end-not-reached"`` where a path between two frequencies did not come to the second;
        ``"left-range"`` where it has a part outside; ``"few-harmonics"`` or ``"unchecked-harmonics"``;
        ``"harmonics-chosen"``; ``"stability-near-fold"`` where a fold moves with more harmonics;
        ``"free-mean-position"`` where nothing holds a mean position.
    """

    FORMAT: ClassVar[str] = "dalembert frequency curve 2"
    TITLE: ClassVar[str] = "Forced response"

    dofs: tuple[str, ...]
    coordinates: tuple[str, ...]
    contacts: tuple[str, ...]
    orders: tuple[int, ...]
    frequencies: Annotated[np.ndarray, Over(("point",), "Hz")]
    response: Annotated[np.ndarray, Over(("point", "dof", "coefficient"), "m")]
    displacements: Annotated[np.ndarray, Over(("point", "coordinate", "coefficient"), "m")]
    forces: Annotated[np.ndarray, Over(("point", "coordinate", "coefficient"), "N")]
    states: Annotated[np.ndarray, Over(("point", "contact", "phase"))]
    unknowns: Annotated[np.ndarray, Over(("point", "retained", "coefficient"), "m")]
    iterations: Points
    residuals: Points
    converged: Points
    fold: Points
    samples: Points
    sampling_errors: Points
    stable: Points
    load_factors: Points
    markers: tuple[tuple[str, int], ...]
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    def harmonics(self, dof: str) -> np.ndarray:
        """Coefficients of an observed degree of freedom or of a node with only one, (points, coefficients).

        Raises
        ------
        InputError
            For one that was not observed.
        """
        return self.response[:, observed_column(self.dofs, dof)]

    def amplitude(self, dof: str, kind: str = "peak") -> np.ndarray:
        """Size of the motion at each point, m, (points,): ``"peak"``, ``"rms"`` or ``"harmonic 1"`` and so on.

        Raises
        ------
        InputError
            For another kind, or a degree of freedom that was not observed.
        """
        return Amplitude(kind, self.orders).of(self.harmonics(dof))

    def motion(self, dof: str, point: int, phases: np.ndarray) -> np.ndarray:
        """Displacement, m, at phases of the period (rad), (phases,)."""
        return synthesis(self.orders, np.asarray(phases, dtype=float)) @ self.harmonics(dof)[point]

    def loop(self, coordinate: str, point: int, count: int = 256) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (m) and force (N) of an element's coordinate over a period, (count + 1,) each."""
        row = coordinate_row(self.coordinates, coordinate)
        waves = synthesis(self.orders, np.linspace(0, 2 * np.pi, count + 1))
        return waves @ self.displacements[point, row], waves @ self.forces[point, row]

    def dissipated(self, coordinate: str) -> np.ndarray:
        """Energy that an element dissipates in a period along a coordinate, J, (points,).

        ∮ λ du, which of all harmonics of the force takes those that the displacement has too; 0 where it is rounding.
        """
        row = coordinate_row(self.coordinates, coordinate)
        u, force = self.displacements[:, row], self.forces[:, row]
        total, size = np.zeros(len(self)), np.zeros(len(self))
        mean = int(self.orders[0] == 0)
        for number, order in enumerate(self.orders[mean:]):
            # ∮ λ du = π Σ h (Λ_c U_s - Λ_s U_c), where the mean does no work.
            c = mean + 2 * number
            ahead, behind = np.pi * order * force[:, c] * u[:, c + 1], np.pi * order * force[:, c + 1] * u[:, c]
            total, size = total + ahead - behind, size + np.abs(ahead) + np.abs(behind)
        return np.where(np.abs(total) > _ROUNDING * size, total, 0.0)

    @property
    def folds(self) -> np.ndarray:
        """Frequencies of the folds, Hz, (folds,)."""
        return self.frequencies[self.fold]

    def peak(self, dof: str, kind: str = "peak") -> Peak:
        """Return the largest response, interpolated by a cubic spline of the harmonics along the path.

        Raises
        ------
        InputError
            For another kind, a degree of freedom that was not observed, or a curve without any point.
        """
        size, harmonics = Amplitude(kind, self.orders), self.harmonics(dof)[self.converged]
        amplitude, frequency = size.of(harmonics), self.frequencies[self.converged]
        if not len(amplitude):
            raise InputError("no point of the curve was found, so it has no peak; see its residuals")
        top = int(amplitude.argmax())
        if not 0 < top < len(amplitude) - 1:
            return Peak(float(frequency[top]), float(amplitude[top]))
        rows = slice(max(top - 4, 0), top + 5)
        near = np.column_stack([frequency[rows], harmonics[rows]])
        # A spline over the length of the path in its harmonics, not over frequency: near a fold a curve has several
        # values.
        lengths = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(harmonics[rows], axis=0), axis=1)))
        lengths = lengths / (lengths[-1] or 1.0)  # as parts of the way: a spline through few points solves for them
        kept = np.append(True, np.diff(lengths) > 0)
        spline, place = CubicSpline(lengths[kept], near[kept]), lengths[top - rows.start]
        inner = lengths[top - rows.start - 1], lengths[top - rows.start + 1]
        optimum: Any = minimize_scalar(lambda s: -size.of(spline(s)[1:]), bounds=inner, method="bounded")
        best = spline(optimum.x if -optimum.fun > amplitude[top] else place)
        return Peak(float(best[0]), float(size.of(best[1:])))

    @property
    def verdict(self) -> str:
        return super().verdict if self.converged.any() else "not found"

    @property
    def status(self) -> str:
        """How many points were found, in a sentence."""
        return curve_status(self)

    def facts(self, dofs: Sequence[str] = (), kind: str = "peak") -> dict[str, str]:
        """Return the peak of the degree of freedom that moves most, of ``dofs`` if given, and effort."""
        return curve_facts(self, dofs, kind)

    def tables(self, dofs: Sequence[str] = (), kind: str = "peak") -> tuple[Table, ...]:
        """Return peaks, marked points, points that were not found, contacts, springs, harmonics and diagnostics.

        Parameters
        ----------
        dofs : sequence of str
            Degrees of freedom; those that move most if not given.
        kind : str
            Of amplitude: ``"peak"``, ``"rms"`` or ``"harmonic 1"`` and so on.
        """
        return tuple(curve_tables(self, dofs, kind))
