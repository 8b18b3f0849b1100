"""The first lines of a report: what was done, whether it worked, and what came out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse import BandFit, Fit
from dalembert.multibody import Trajectory, WorkPrecision
from dalembert.report.digits import counted, shown, with_deviation
from dalembert.report.quantities import labelled
from dalembert.report.sections.section import Section
from dalembert.results import fixed_of

MOST_VALUES = 4
ERRORS = (1e-4, 1e-8)
"""Errors that the fastest integrator is named for."""


@dataclass(frozen=True)
class Fact:
    """A number that is worth a place at the top."""

    label: str
    text: str


@dataclass(frozen=True)
class Headline(Section):
    """Title, verdict with advice and reasons to doubt it, and the few numbers that matter."""

    name: ClassVar[str] = "headline"
    heading: ClassVar[str] = "Result"
    title: str
    verdict: str
    success: bool
    status: str
    facts: Sequence[Fact]
    notes: Sequence[str] = ()
    doubts: Sequence[str] = ()
    findings: Sequence[Finding] = ()

    @property
    def doubtful(self) -> bool:
        """Return True if a finding is a reason to doubt the result."""
        return any(finding.doubtful for finding in self.findings)

    @property
    def badge(self) -> str:
        """How the verdict is shown: ``"good"``, ``"doubtful"`` or ``"bad"``."""
        return "bad" if not self.success else "doubtful" if self.doubts or self.doubtful else "good"


def fixed_facts(result: object) -> list[Fact]:
    """Values of the parameters that were fixed by equal bounds."""
    return [Fact(f"{labelled(item.name, item.unit)}, fixed", shown(float(item.lower))) for item in fixed_of(result)]


def of_fit(fit: Fit, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of identified parameters."""
    values = [
        Fact(labelled(item.name, item.unit), with_deviation(value, deviation))
        for item, value, deviation in zip(fit.parameters, fit.values, fit.deviations, strict=True)
    ]
    ended = sum(start.success for start in fit.starts)
    facts = [
        *(values if len(values) <= MOST_VALUES else []),
        Fact("fitness", shown(fit.fitness, digits=3)),
        Fact("simulations", counted(fit.simulations)),
        *([Fact("starts converged", f"{ended} of {len(fit.starts)}")] if len(fit.starts) > 1 else []),
    ]
    return of_identified(fit, title or "Identified parameters", facts, notes)


def of_identified(fit: Fit | BandFit, title: str, facts: Sequence[Fact], notes: Sequence[str]) -> Headline:
    """Headline of something identified, with what speaks against it."""
    doubts = tuple(doubt.message for doubt in fit.doubts) if fit.success else ()
    verdict = "not identified" if not fit.success else "identified, with doubts" if doubts else "identified"
    return Headline(title, verdict, fit.success, fit.status, facts, notes, doubts)


def of_trajectory(trajectory: Trajectory, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a simulated motion."""
    times = np.asarray(trajectory.times)
    counts = np.asarray(trajectory.newton_iterations)
    balance, position = largest(trajectory.energies, "balance"), largest(trajectory.violations, "position")
    facts = [
        Fact("simulated", shown(float(times[-1] - times[0])) + " s"),
        Fact("steps", counted(len(counts))),
        Fact("largest energy error", shown(balance, digits=3) + " J"),
        Fact("largest opening of a joint", shown(position, digits=3) + " m"),
    ]
    swing = max((float(np.ptp(values)) for key, values in trajectory.energies.items() if key != "balance"), default=0.0)
    status = (
        f"The energy balance is kept to {shown(100 * balance / swing, digits=2)} % of the energy that moves; "
        "a smaller step lowers it."
        if swing > 0 and np.isfinite(balance)
        else "The motion was simulated to its end."
    )
    return Headline(title or "Simulated motion", "simulated", True, status, facts, notes)


def of_work_precision(found: WorkPrecision, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of integrators compared."""
    facts = [
        Fact("simulated", shown(found.end) + " s"),
        Fact("integrators", counted(len(found.methods))),
        Fact("runs", counted(len(found.rows))),
        *(Fact(f"fastest to {error:.0e}", row.method) for error in ERRORS if (row := found.fastest(error))),
    ]
    verdict = "compared" if found.success else "not compared"
    return Headline(title or "Work and precision", verdict, found.success, found.status, facts, notes)


def of_sweep(sweep: Any, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a sweep."""
    facts = [Fact(f"values of {curve.parameter}", str(len(curve.values))) for curve in sweep.curves]
    names = ", ".join(curve.parameter for curve in sweep.curves)
    status = f"Responses at {sweep.at}, one parameter varied at a time: {names}. {sweep.status}"
    verdict = "swept" if sweep.success else "incomplete"
    return Headline(title or "Parameter sweep", verdict, sweep.success, status, facts[:MOST_VALUES], notes)


def largest(series: Mapping[str, np.ndarray], key: str) -> float:
    """Largest magnitude in one of several series, NaN if it is not there."""
    return float(np.nanmax(np.abs(series[key]), initial=0.0)) if key in series else float("nan")
