"""The first lines of a report on vibrations: forced response and what follows from it."""

from collections.abc import Sequence

import numpy as np

from dalembert.report.charts.resonance_peaks import value_text
from dalembert.report.digits import counted, shown
from dalembert.report.focus import Look, unit_of
from dalembert.report.prefixes import in_words
from dalembert.report.sections.headline import MOST_VALUES, Fact, Headline
from dalembert.structure import ModeShapes, ReductionErrors
from dalembert.vibration import (
    Backbone,
    CurveFamily,
    Deformation,
    FrequencyCurve,
    PeriodicMotion,
    ResonanceTrack,
    TimeComparison,
)


def of_frequency_curve(curve: FrequencyCurve, look: Look | None, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a response over frequency."""
    found, points = int(curve.converged.sum()), len(curve.converged)
    low, high = (shown(float(end)) for end in (curve.frequencies.min(), curve.frequencies.max()))
    success = found == points
    status = (
        f"All {counted(points)} points between {low} and {high} Hz were found."
        if success
        else f"{counted(points - found)} of {counted(points)} points between {low} and {high} Hz were not found; "
        "they are marked, and the curve goes on beside them."
    )
    facts = [
        *([] if look is None else [Fact(*_largest(curve, look.dof, look.kind))]),
        Fact("harmonics", _orders(curve.orders)),
        Fact("Newton iterations a point", shown(float(np.mean(curve.iterations)), digits=3)),
        Fact("samples of a period", counted(int(np.max(curve.samples)))),
        *([Fact("contacts", counted(len(curve.contacts)))] if curve.contacts else []),
    ]
    verdict = "computed" if success else "incomplete" if found else "not found"
    return Headline(title or "Forced response", verdict, success, status, facts, notes)


def of_family(
    family: CurveFamily, dofs: tuple[str, ...], kind: str, title: str | None, notes: Sequence[str]
) -> Headline:
    """Headline of responses for several values of a parameter."""
    facts = [Fact("values", counted(len(family.values)))]
    if dofs:
        peaks, best = family.peaks(dofs[0], kind), family.best(dofs[0], kind)
        at = int(np.flatnonzero(np.asarray(family.values) == best)[0])
        gain = float(family.reduction(dofs[0], kind)[at])
        facts += [
            Fact(f"{family.parameter} of the smallest peak", value_text(family, best)),
            Fact(f"peak of {dofs[0]} there", in_words(peaks[at].amplitude, unit_of(dofs[0]), 5)),
        ]
        if gain > 0:
            first = value_text(family, float(family.values[0]))
            facts.append(Fact(f"reduction from {first}", f"{shown(100 * gain, digits=3)} %"))
    verdict = "computed" if family.success else "incomplete"
    name = title or f"Forced response over {family.parameter}"
    return Headline(name, verdict, family.success, f"{family.status}.", facts, notes)


def of_time_comparison(compared: TimeComparison, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of points of a curve beside time integration."""
    found = np.asarray(compared.converged)
    most = float(np.nanmax(np.abs(compared.differences[found]), initial=0.0))
    facts = [
        Fact("points", counted(len(found))),
        Fact("largest difference", f"{shown(100 * most, digits=2)} %"),
        Fact("steps a period", counted(int(compared.provenance["method"]["steps_per_period"]))),
    ]
    late = "All points are periodic in time." if found.all() else "Some points are not periodic in time yet."
    verdict = "compared" if found.all() else "incomplete"
    return Headline(title or "Beside time integration", verdict, bool(found.all()), late, facts, notes)


def of_backbone(mode: Backbone, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a nonlinear mode."""
    found, frequencies = np.asarray(mode.converged), np.asarray(mode.frequencies)
    ends = [shown(float(frequencies[found][end])) for end in (0, -1)] if found.any() else []
    facts = [
        *([Fact("frequency", f"{' to '.join(dict.fromkeys(ends))} Hz")] if ends else []),
        *([Fact("largest damping ratio", _percent(np.asarray(mode.damping)[found].max()))] if ends else []),
        Fact("amplitudes", counted(len(found))),
    ]
    status = f"Mode {mode.mode} was found at {int(found.sum())} of {len(found)} amplitudes of {mode.dof}."
    verdict = "computed" if found.all() else "incomplete"
    return Headline(title or "Nonlinear mode", verdict, bool(found.all()), status, facts, notes)


def of_track(track: ResonanceTrack, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a resonance over a parameter."""
    found = np.asarray(track.converged)
    facts = [Fact("values", counted(len(found))), Fact("points balanced", counted(int(np.sum(track.solves))))]
    if found.any():
        lowest = int(np.nanargmin(track.amplitudes))
        facts += [
            Fact(f"{track.parameter} of the smallest peak", value_text(track, track.best())),
            Fact(f"peak of {track.dof} there", in_words(float(track.amplitudes[lowest]), unit_of(track.dof), 5)),
        ]
    status = f"The peak was found at {int(found.sum())} of {len(found)} values of {track.parameter}."
    verdict = "tracked" if found.all() else "incomplete"
    return Headline(title or f"Resonance over {track.parameter}", verdict, bool(found.all()), status, facts, notes)


def of_deformation(shape: Deformation, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a deformed shape."""
    facts = [
        Fact("frequency", f"{shown(shape.frequency)} Hz"),
        Fact("nodes", counted(len(shape.places))),
        *([Fact("contacts", counted(len(shape.contacts)))] if shape.contacts else []),
    ]
    status = "The motion of the whole structure at one point of a response over frequency."
    return Headline(title or "Deformed shape", "computed", True, status, facts, notes)


def of_modes(modes: ModeShapes, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of free vibrations."""
    frequencies = [float(value) for value in modes.frequencies]
    facts = [Fact(f"mode {number}", f"{shown(value)} Hz") for number, value in enumerate(frequencies[:MOST_VALUES], 1)]
    status = f"{len(frequencies)} natural frequencies and shapes of the undamped structure."
    return Headline(title or "Modes", "computed", True, status, facts, notes)


def of_reduction(errors: ReductionErrors, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a reduction's errors."""
    facts = [
        Fact("modes compared", counted(len(errors.full))),
        Fact("largest error of a frequency", _percent(np.max(errors.relative))),
        Fact("least similarity of a shape", shown(float(np.min(errors.similarity)), digits=4)),
    ]
    status = "The lowest modes of the reduced structure beside those of the full one."
    return Headline(title or "Reduction", "compared", True, status, facts, notes)


def of_period(motion: PeriodicMotion, title: str | None, notes: Sequence[str]) -> Headline:
    """Headline of a periodic motion in time."""
    facts = [
        Fact("frequency", f"{shown(motion.frequency)} Hz"),
        Fact("periods", counted(motion.periods)),
        Fact("change over the last one", shown(motion.residual, digits=2)),
        Fact("steps of a period", counted(len(motion.times))),
    ]
    status = "The motion repeats itself." if motion.converged else "The motion does not repeat itself yet."
    verdict = "periodic" if motion.converged else "not periodic"
    return Headline(title or "Periodic motion", verdict, motion.converged, status, facts, notes)


def _percent(part: float) -> str:
    return f"{shown(100 * float(part), digits=3)} %"


def _largest(curve: FrequencyCurve, dof: str, kind: str) -> tuple[str, str]:
    peak = curve.peak(dof, kind)
    return f"peak of {dof}", f"{in_words(peak.amplitude, unit_of(dof), 5)} at {shown(peak.frequency)} Hz"


def _orders(orders: Sequence[int]) -> str:
    """Harmonics in a few words.

    >>> _orders((0, 1, 2, 3)), _orders((1, 3, 5)), _orders((1, 3, 5, 7, 9))
    ('0 to 3', '1, 3, 5', '1, 3 … 9')
    """
    if len(orders) > 2 and list(orders) == list(range(orders[0], orders[-1] + 1)):
        return f"{orders[0]} to {orders[-1]}"
    return ", ".join(map(str, orders)) if len(orders) < 5 else f"{orders[0]}, {orders[1]} … {orders[-1]}"
