"""The result of a prediction: a response and its bands."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.contents import Contents
from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.forward.stored_coordinate import StoredCoordinate
from dalembert.inverse.fit.stored_data import StoredMeasured
from dalembert.results import EndedResult
from dalembert.stored_fields import Labels, OptionalTable, Over, Table
from dalembert.tables import Table as ResultTable
from dalembert.tables import cells, counted

FLAT = 1e-9  # range of a response, as a part of its size, below which a band has no width relative to it


@dataclass(frozen=True, eq=False)
class Prediction(EndedResult):
    """Confidence bands of a response and of new measurements, as :func:`predict` returns them.

    Parameters
    ----------
    coordinate : Coordinate
        Times in s, or frequencies in Hz, of the samples.
    channels, units : tuple of str
        Names and SI units of the channels.
    response : array, shape (samples, channels)
        Response at the identified values, in the units of the channels.
    deviations : array, shape (samples, channels)
        Standard deviations of the response, from those of the parameters; NaN from where a
        band is as wide as the motion, see the finding ``band-ends``.
    noise : array, shape (channels,)
        Standard deviation of a measurement, root mean square over the samples; NaN for channels that were not measured.
    data : Measurements or None
        The fitted data.
    level : float
        Probability of the bands, between 0 and 1.
    quantile : float
        Half width of a band in standard deviations: of the response, or of the response and the noise together.
    known : bool
        Whether the noise was known, or estimated from the residuals.
    simulations : int
        Number of simulations.
    provenance : mapping
        Versions of the programs, hashes of model and data, and settings.
    findings : tuple of Finding
        Conclusions of the method about the result.
    noise_of_samples : array, shape (samples, channels), optional
        Standard deviation of a measurement of each sample, where it depends on the response.
    """

    FORMAT: ClassVar[str] = "dalembert prediction 1"
    TITLE: ClassVar[str] = "Predicted response"
    VERDICTS: ClassVar[tuple[str, str]] = ("predicted", "not bounded")

    coordinate: StoredCoordinate
    channels: Annotated[tuple[str, ...], Labels("channel")]
    units: tuple[str, ...]
    response: Table
    deviations: Table
    noise: Annotated[np.ndarray, Over("channel")]
    data: StoredMeasured
    level: float
    quantile: float
    known: bool
    simulations: int
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()
    noise_of_samples: OptionalTable = None

    @property
    def lower(self) -> np.ndarray:
        """Lower ends of the band of the true response, (samples, channels)."""
        return self.response - self.quantile * self.deviations

    @property
    def upper(self) -> np.ndarray:
        """Upper ends of the band of the true response, (samples, channels)."""
        return self.response + self.quantile * self.deviations

    @property
    def measured_lower(self) -> np.ndarray:
        """Lower ends of the band of a new measurement, (samples, channels)."""
        return self.response - self.quantile * np.hypot(self.deviations, self._noise)

    @property
    def measured_upper(self) -> np.ndarray:
        """Upper ends of the band of a new measurement, (samples, channels)."""
        return self.response + self.quantile * np.hypot(self.deviations, self._noise)

    @property
    def _noise(self) -> np.ndarray:
        return self.noise if self.noise_of_samples is None else self.noise_of_samples

    @property
    def success(self) -> bool:
        """Whether every band is finite."""
        return bool(np.all(np.isfinite(self.deviations)))

    @property
    def outcome(self) -> tuple[Finding, ...]:
        """How wide the bands are, and what they assume."""
        return tuple(self._outcome())

    def _outcome(self) -> Iterator[Finding]:
        if np.all(np.isnan(self.deviations)):
            message = "No bands: the fit has no standard deviations, since the model has no sensitivities."
            advice = "Use a solver, or bounds, for which the derivatives of the response can be computed."
            yield Finding("no-bands", "error", {}, message, advice)
            return
        lost = [name for name, wide in zip(self.channels, self.deviations.T, strict=True) if np.isinf(wide).any()]
        if lost:
            message = (
                f"The band of {listed(list(map(repr, lost)))} is infinitely wide: it depends on a combination of the "
                "parameters that the data do not identify."
            )
            advice = (
                "The findings of the fit name the combination. Measure a quantity that identifies it, or fix one of "
                "its parameters."
            )
            yield Finding("infinite-band", "error", {"channels": ", ".join(lost)}, message, advice)
        widest = np.fmax.reduce(self.deviations, axis=0)
        extent = np.ptp(self.response, axis=0)
        varies = extent > FLAT * np.max(np.abs(self.response), axis=0)
        ratio = 2 * self.quantile * widest / np.where(varies, extent, np.nan)
        finite = np.flatnonzero(np.isfinite(ratio))
        if len(finite):
            worst = finite[np.argmax(ratio[finite])]
            yield Finding(
                "band-width",
                "note",
                {"level": self.level, "channel": self.channels[worst], "ratio": float(ratio[worst])},
                f"The {100 * self.level:g} % band of the response is at most {100 * ratio[worst]:.2g} % as wide as the "
                f"range of the response, in {self.channels[worst]!r}.",
            )
        source = "given standard deviations" if self.known else "residuals"
        message = (
            f"The noise level follows from {source}. The bands assume that the model is right and nearly linear in the "
            "parameters within their intervals."
        )
        yield Finding("band-assumptions", "note", {"noise_is_known": self.known}, message)

    def facts(self) -> dict[str, str]:
        return {"level": f"{100 * self.level:g} %", "channels": counted(len(self.channels))}

    def tables(self) -> tuple[ResultTable, ...]:
        """Return the half widths of the bands."""
        half = (self.upper - self.lower) / 2, (self.measured_upper - self.measured_lower) / 2
        response, measurement = (cells(np.fmax.reduce(widths, axis=0), 3) for widths in half)
        columns = {
            "channel": self.channels,
            "unit": self.units,
            "± response at most": response,
            "± measurement at most": measurement,
        }
        return (ResultTable.of("prediction", f"Half widths of the {100 * self.level:g} % bands", columns),)

    def contents(self) -> Contents:
        contents, over = super().contents(), ("sample", "channel")
        bands = {"lower": (over, self.lower), "upper": (over, self.upper)}
        return replace(contents, variables={**contents.variables, **bands})
