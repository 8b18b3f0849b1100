"""The result of a ring-down: frequency and damping of a mode over its amplitude, from its free decay."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.data import Measurements
from dalembert.findings import Finding
from dalembert.forward import Coordinate
from dalembert.inverse.decays.record_windows import OVERLAP
from dalembert.results import Result
from dalembert.stored_fields import Labels, Over
from dalembert.tables import Table, cells, counted, labelled, percent, shown

UNUSUAL = 3.0
"""Deviation over the median one from which a point is no data of a model."""

Points = Annotated[np.ndarray, Over("point")]


@dataclass(frozen=True, eq=False)
class RingDown(Result):
    """Frequency and damping of a mode over its amplitude, as :func:`ring_down` returns them.

    Frequencies and damping ratios are those of the periodic motion with the same amplitude, as :func:`backbone`
    computes them. Those of the decay itself differ from them by parts of second order in the damping.

    Parameters
    ----------
    channels : tuple of str
    reference, unit : str
        Channel by whose displacement the amplitude is measured, and the unit of that.
    record : array of int, shape (points,)
        Number of the record of each point, from 1.
    times : array, shape (points,)
        In the record, s.
    amplitudes, amplitude_deviations : array, shape (points,)
        Of the displacement (or strain) at the reference channel, and standard deviations.
    frequencies, frequency_deviations : array, shape (points,)
        Hz.
    damping, damping_deviations : array, shape (points,)
        Ratios.
    covariance : array, shape (points, 2, points, 2)
        Of frequencies (Hz) and damping ratios; windows overlap.
    decay_frequencies, decay_damping : array, shape (points,)
        Of the decaying motion: ω/2π, Hz, and σ/ω of the amplitude :math:`a e^{-\\sigma t}`.
    band_frequencies, band_damping : array, shape (points,)
        The same by band-pass filter and Hilbert transform; NaN where the filter reaches beyond the record.
    shapes : array, shape (points, channels, 2)
        Real and imaginary part of the displacements, that of the reference 1.
    noise : array, shape (channels,)
        Standard deviations of the noise, by its power at the frequency of the mode, in the unit of the channel.
    periods : array, shape (points,)
        Lengths of the windows, in periods of the mode.
    degrees : array of int, shape (points,)
        Of the polynomials of phase and logarithm of the amplitude in a window.
    bias : array, shape (points,)
        Size of the bias of ω and σ, 1/s, that the change of the mode within the windows makes.
    other_modes : array, shape (modes,)
        Frequencies of other modes that were fitted at the same time, Hz.
    slips, stiffnesses : array, shape (sliders,)
        The equivalent law: amplitudes at which parallel sliders slip, and their stiffnesses over the modal mass, 1/s².
    elastic : array, shape (3,)
        Stiffnesses in phase of its springs of 1, a² and a⁴ at the largest amplitude, over the modal mass, 1/s². That of
        a² is three quarters of the coefficient of a cubic force, that of a⁴ five eighths of a quintic one.
    viscous : float
        Its viscous damping over the modal mass, 1/s.
    provenance : mapping
    findings : tuple of Finding
    """

    FORMAT: ClassVar[str] = "dalembert ring-down 1"
    TITLE: ClassVar[str] = "Ring-down"
    VERDICTS: ClassVar[tuple[str, str]] = ("identified", "doubtful")

    channels: Annotated[tuple[str, ...], Labels("channel")]
    reference: str
    unit: str
    record: Points
    times: Points
    amplitudes: Points
    amplitude_deviations: Points
    frequencies: Points
    frequency_deviations: Points
    damping: Points
    damping_deviations: Points
    covariance: Annotated[np.ndarray, Over("point", "quantity", "other point", "other quantity")]
    decay_frequencies: Points
    decay_damping: Points
    band_frequencies: Points
    band_damping: Points
    shapes: Annotated[np.ndarray, Over("point", "channel", "part")]
    noise: Annotated[np.ndarray, Over("channel")]
    periods: Points
    degrees: Points
    bias: Points
    other_modes: Annotated[np.ndarray, Over("other mode")]
    slips: Annotated[np.ndarray, Over("slider")]
    stiffnesses: Annotated[np.ndarray, Over("slider")]
    elastic: Annotated[np.ndarray, Over("power")]
    viscous: float
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    def __len__(self) -> int:
        return len(self.times)

    @property
    def success(self) -> bool:
        """Whether no finding doubts the result."""
        return not self.doubts

    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest amplitude that the decays show."""
        return float(self.amplitudes.min()), float(self.amplitudes.max())

    @property
    def status(self) -> str:
        """Over which amplitudes frequency and damping are known."""
        low, high = (f"{shown(end, digits=4)} {self.unit}".strip() for end in self.range)
        return f"Frequency and damping are known from {low} to {high} of {self.reference}."

    def measurements(self) -> Measurements:
        """Frequency and damping ratio over the amplitude, with mean standard deviations, as data of a model.

        Points of windows that overlap share noise; each fourth point is returned, so that windows touch. Points whose
        deviation is more than three times the median one are left out.
        """
        usual = self.damping_deviations <= UNUSUAL * np.median(self.damping_deviations)
        chosen = [np.flatnonzero(usual & (self.record == number))[::OVERLAP] for number in np.unique(self.record)]
        rows = np.concatenate(chosen)
        # In the order of the amplitudes, each of which data have once.
        rows = rows[np.unique(self.amplitudes[rows], return_index=True)[1]]
        along = Coordinate("amplitude", self.unit, self.amplitudes[rows])
        deviations = {
            "frequency": float(np.sqrt(np.mean(self.frequency_deviations[rows] ** 2))),
            "damping": float(np.sqrt(np.mean(self.damping_deviations[rows] ** 2))),
        }
        return Measurements.of(
            along, {"frequency": self.frequencies[rows], "damping": self.damping[rows]}, deviations=deviations
        )

    def facts(self) -> dict[str, str]:
        low, high = (shown(end, digits=4) for end in self.range)
        frequencies, damping = np.asarray(self.frequencies), np.asarray(self.damping)
        first, last = int(np.argmax(self.amplitudes)), int(np.argmin(self.amplitudes))
        facts = {
            "amplitudes": f"{low} to {high} {self.unit}".strip(),
            "frequency at the largest amplitude": f"{shown(float(frequencies[first]))} Hz",
            "frequency at the smallest amplitude": f"{shown(float(frequencies[last]))} Hz",
            "largest damping ratio": percent(float(damping.max())),
            "points": counted(len(self)),
            "length of windows": f"{np.min(self.periods):.0f} to {np.max(self.periods):.0f} periods",
        }
        if len(self.other_modes):
            facts["other modes"] = ", ".join(f"{shown(float(mode))} Hz" for mode in self.other_modes)
        return facts

    def tables(self) -> tuple[Table, ...]:
        """Return frequency and damping over the amplitude, and the shape of the mode."""
        columns = {
            **({"record": self.record} if np.max(self.record) > 1 else {}),
            "time (s)": cells(self.times, 5),
            labelled(f"amplitude of {self.reference}", self.unit): cells(self.amplitudes, 5),
            "frequency (Hz)": self.frequencies,
            "deviation (Hz)": cells(self.frequency_deviations, 2),
            "damping ratio (%)": cells(100 * self.damping, 4),
            "deviation (%)": cells(100 * self.damping_deviations, 2),
        }
        detail = {
            "time (s)": self.times,
            "decay frequency (Hz)": self.decay_frequencies,
            "decay damping ratio (%)": 100 * self.decay_damping,
            "band-pass frequency (Hz)": self.band_frequencies,
            "band-pass damping ratio (%)": 100 * self.band_damping,
        }
        tables = [
            Table.of("ring-down", "Frequency and damping over the amplitude", columns),
            Table.of("two-methods", "Frequency and damping of the decay by both methods", detail, detail=True),
        ]
        if len(self.channels) > 1:
            ends = {"largest": int(np.argmax(self.amplitudes)), "smallest": int(np.argmin(self.amplitudes))}
            shape: dict[str, Sequence[object]] = {"channel": self.channels}
            for word, row in ends.items():
                shape[f"at the {word} amplitude"] = cells(self.shapes[row, :, 0], 4)
                shape[f"90° behind, {word}"] = cells(-self.shapes[row, :, 1], 2)
            tables.insert(
                1, Table.of("mode-shape", "Shape of the mode, displacements over that of the reference", shape)
            )
        return tuple(tables)
