"""Amplitudes over frequency, their peaks, and what happens along the path."""

from dalembert.report import charts
from dalembert.report.digits import shown
from dalembert.report.focus import Look, marked, movers, unstable
from dalembert.report.quantities import labelled, size_label
from dalembert.report.section import Fold, Plot, Section
from dalembert.report.table import Table, cells
from dalembert.units import unit_of
from dalembert.vibration import Backbone

MOST_NAMED = 4
MOST_ROWS = 20


def forced_response(look: Look, mode: Backbone | None) -> Section:
    """The curve of the degrees of freedom looked at, and a table of the peaks of all."""
    how = "Each point is a periodic motion."
    how += " Symbols: where the path has a fold or changes its stability." if marked(look.curve) else ""
    how += " Dashed: unstable motions." if unstable(look.curve).any() else ""
    how += " Crosses: not found." if not look.curve.converged.all() else ""
    how += " Dotted: the nonlinear mode without force." if mode is not None else ""
    plot = Plot("frequency-curve", charts.frequency_curve(look.curve, look.dofs, kind=look.kind, mode=mode), how)
    tables = [table for table in (_peaks(look), _events(look), _lost(look)) if table.rows]
    return Section("Forced response", (*_sentences(look), plot, *map(Fold, tables)))


def _sentences(look: Look) -> list[str]:
    curve, told = look.curve, []
    folds = [shown(float(curve.frequencies[point])) for point in marked(curve).get("fold", [])]
    if folds:
        told.append(
            f"The path has folds at {_listed(folds)} Hz: between them several motions are possible at "
            "the same frequency, and a slow sweep jumps from one to another."
        )
    bad = unstable(curve)
    if bad.any():
        between = curve.frequencies[bad]
        told.append(
            f"{int(bad.sum())} of {len(bad)} points, between {shown(float(between.min()))} and "
            f"{shown(float(between.max()))} Hz, are unstable: the structure does not stay in these motions."
        )
    if len(look.dofs) < len(curve.dofs):
        told.append(
            f"Drawn are {len(look.dofs)} degrees of freedom of the {len(curve.dofs)} observed, in the table those that "
            "move most."
        )
    return told


def _peaks(look: Look) -> Table:
    curve, kind = look.curve, look.kind
    tabled = {*look.dofs, *(curve.dofs if len(curve.dofs) <= MOST_ROWS else movers(curve, MOST_ROWS))}
    dofs = [dof for dof in curve.dofs if dof in tabled]
    peaks = [curve.peak(dof, kind) for dof in dofs]
    points = {dof: Look.of(curve, [dof], kind).point for dof in dofs}
    first = f"harmonic {curve.orders[int(curve.orders[0] == 0)]}"
    columns = {
        "degree of freedom": dofs,
        f"largest {size_label(kind)}": [peak.amplitude for peak in peaks],
        "at frequency (Hz)": [peak.frequency for peak in peaks],
        "its rms": [curve.amplitude(dof, "rms")[point] for dof, point in points.items()],
        "its first harmonic": [curve.amplitude(dof, first)[point] for dof, point in points.items()],
        "unit": map(unit_of, dofs),
    }
    return Table.of("peaks", "Resonance peaks", columns)


def _events(look: Look) -> Table:
    """Marked points."""
    curve, kind = look.curve, look.kind
    events = [(event, point) for event, points in marked(curve).items() for point in points]
    points = [point for _, point in events]
    columns = {
        "what": [event for event, _ in events],
        "frequency (Hz)": curve.frequencies[points] if points else (),
        **{
            labelled(f"{size_label(kind)} of {dof}", unit_of(dof)): curve.amplitude(dof, kind)[points] if points else ()
            for dof in look.dofs[:MOST_NAMED]
        },
    }
    return Table.of("marked-points", "Folds and changes of stability", columns)


def _lost(look: Look) -> Table:
    """Points that were not found."""
    lost = ~look.curve.converged
    columns = {
        "frequency (Hz)": look.curve.frequencies[lost],
        "left unbalanced, part of the forces": cells(look.curve.residuals[lost], 2),
    }
    return Table.of("not-found", "Points that were not found", columns)


def _listed(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
