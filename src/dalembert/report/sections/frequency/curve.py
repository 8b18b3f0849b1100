"""A response over frequency: its peaks, contacts, harmonics, and how far it can be trusted."""

from collections.abc import Iterable, Sequence

import numpy as np

from dalembert.quantities import size_label
from dalembert.report import charts
from dalembert.report.charts.frequency.contacts import shares
from dalembert.report.charts.frequency.frequency_curve import by_order
from dalembert.report.focus import Look, dissipation_of, marked, movers, of_contacts, of_springs, unstable
from dalembert.report.headline import Headline
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Block, Fold, Plot, Row, Section
from dalembert.report.sections.frequency.backbone import nonlinear_mode
from dalembert.report.sections.frequency.deformation import deformed
from dalembert.report.sections.frequency.in_time import in_time
from dalembert.report.sections.frequency.modes import reduced
from dalembert.structure import ReductionErrors
from dalembert.tables import Cell, Table, cells, counted, in_words, labelled, percent, shown
from dalembert.units import unit_of
from dalembert.vibration import Backbone, Deformation, FrequencyCurve, TimeComparison

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


FEW_SPRINGS = 6


def friction(look: Look, lead: str = "") -> Section:
    """Hysteresis loops, states and energies of contacts, and the forces of springs, at the peak."""
    curve, point = look.curve, look.point
    at = f"{shown(float(curve.frequencies[point]))} Hz"
    blocks: list[Block] = [*_friction_sentences(look, lead, at)]
    pairs, tables = [], []
    if curve.contacts:
        title = f"Contact states over a period at {at}"
        how = "A row for each contact; phase 0 is the crest of a force without phase."
        blocks.append(Plot("contact-states", charts.contact_states(curve, point, title=title), how))
        loops = charts.hysteresis(curve, point, title=f"Hysteresis loops at {at}")
        area = "The area of a loop is the energy that friction takes in a period; forces by the harmonics kept."
        mean = "Mean of all contacts." if len(curve.contacts) > 1 else ""
        pairs += [
            Plot("hysteresis", loops, area),
            Plot("dissipation", charts.dissipation(curve), "What each contact takes from the motion."),
            Plot("contact-shares", charts.contact_shares(curve), mean),
        ]
        tables.append(_contacts(look, at))
    if springs := of_springs(curve):
        few = springs[:FEW_SPRINGS]
        named = plain(few[0]) if len(few) == 1 else "springs"
        figure = charts.hysteresis(curve, point, few, title=f"Forces of {named} at {at}")
        pairs.append(Plot("spring-forces", figure, "Force over displacement during a period."))
        columns = {
            "element": springs,
            "energy of a period (J)": cells((curve.dissipated(name)[point] for name in springs), 4),
            **_largest(look, springs, "largest force (N)"),
        }
        tables.append(Table.of("springs", f"Springs and other laws at {at}", columns))
    return Section("Contacts and springs", (*blocks, Row(pairs), *map(Fold, tables)))


def _friction_sentences(look: Look, lead: str, at: str) -> tuple[str, ...]:
    curve, point = look.curve, look.point
    where = f"the point of the curve where {look.dof} is largest, {at}"
    if not curve.contacts:
        return (_after(lead, f"Drawn for {where}."),)
    part = {name: float(share.mean()) for name, share in shares(curve.states[point]).items()}
    told = f"At {where}, the contacts are stuck for {percent(part['stuck'])} of the period, slip for "
    told = _after(lead, f"{told}{percent(part['slipping'])} and are separated for {percent(part['separated'])}.")
    energy = float(np.sum([energy[point] for energy in dissipation_of(curve).values()]))
    if part["stuck"] == 1:
        return (told, "They stick all the time there: what damps is the structure, not friction.")
    return (told, f"Friction takes {shown(energy, digits=4)} J from the motion in each period.")


def _contacts(look: Look, at: str) -> Table:
    curve, point = look.curve, look.point
    parts, energies = shares(curve.states[point]), dissipation_of(curve)
    columns = {
        "contact": energies,
        "stuck (% of the period)": cells(100 * parts["stuck"], 3),
        "slipping (%)": cells(100 * parts["slipping"], 3),
        "separated (%)": cells(100 * parts["separated"], 3),
        "energy of a period (J)": cells((energy[point] for energy in energies.values()), 4),
        **_largest(look, (names[0] for names in of_contacts(curve).values()), "largest friction force (N)"),
    }
    return Table.of("contacts", f"Contacts at {at}, along their first tangential direction", columns)


def _largest(look: Look, coordinates: Iterable[str], force: str) -> dict[str, list[Cell]]:
    """Columns of the largest displacements and forces along coordinates."""
    loops = [np.abs(look.curve.loop(name, look.point)).max(axis=1) for name in coordinates]
    return {"largest displacement (m)": cells((u for u, _ in loops), 4), force: cells((f for _, f in loops), 4)}


def _after(lead: str, sentence: str) -> str:
    return f"{lead}{sentence[0].lower()}{sentence[1:]}" if lead else sentence


ENOUGH = 1e-2
"""Size of the last harmonics at the peak, as part of the largest, above which more of them should be kept."""


def harmonics(look: Look) -> Section:
    """Amplitude of each harmonic over frequency, and at the peak."""
    sizes = {order: float(size[look.point]) for order, size in by_order(look.curve, look.dof).items()}
    most = max(sizes.values())
    columns = {
        "part of the motion": ["mean" if order == 0 else f"harmonic {order}" for order in sizes],
        labelled("amplitude", unit_of(look.dof)): sizes.values(),
        "of the largest (%)": cells((100 * size / most if most else 0.0 for size in sizes.values()), 3),
    }
    how = "Harmonics that stay below a millionth of the largest are left out."
    plot = Plot("harmonic-content", charts.harmonic_content(look.curve, look.dof), how)
    table = Table.of("harmonics", f"Harmonics of {look.dof} at its peak", columns)
    return Section("Harmonics", (_enough(sizes, most), plot, Fold(table)))


def _enough(sizes: dict[int, float], most: float) -> str:
    """Whether the last harmonics are small; empty where there is nothing to say."""
    higher = [size for order, size in sizes.items() if order > 1]
    if most <= 0 or not higher:
        return ""
    last = max(higher[-2:])
    part = f"{percent(last / most, 2)} of the largest one"
    if last > ENOUGH * most:
        return f"At the peak the last two harmonics kept still reach {part}; keep more harmonics."
    return f"At the peak the last two harmonics kept are at most {part}."


def balance(curve: FrequencyCurve) -> Section:
    """Newton iterations, residuals and samples of the points."""
    found, counts, settings = curve.converged, np.asarray(curve.iterations), curve.provenance.get("method", {})
    rows = {
        "points": len(found),
        "points found": int(found.sum()),
        "Newton iterations a point, mean": float(counts.mean()),
        "Newton iterations a point, most": int(counts.max(initial=0)),
        "largest unbalanced part of the forces, of points found": _most(curve.residuals, found),
        "samples of a period, most": int(np.max(np.asarray(curve.samples), initial=0)),
        "change of the forces with twice the samples, most": _most(curve.sampling_errors, found),
        **{f"setting: {name}": settings[name] for name in ("tolerance", "sampling") if name in settings},
    }
    table = Table.of("balance", "Diagnostics", {"quantity": rows, "value": cells(rows.values(), 3)})
    how = "A rise shows where the motion is hard to find: where contacts begin to slip or to lift off."
    plot = Plot("points-found", charts.points_found(curve), how)
    return Section("Diagnostics of the balance", (_sampling(curve), plot, Fold(table)))


def _sampling(curve: FrequencyCurve) -> str:
    """What more samples would change; empty where no point was found."""
    if not curve.converged.any():
        return ""
    error = float(np.nanmax(np.asarray(curve.sampling_errors)[curve.converged], initial=0.0))
    allowed = curve.provenance.get("method", {}).get("sampling")
    told = f"Twice as many samples of a period would change the forces by at most {shown(error, digits=2)} of them."
    if allowed is not None and error > allowed:
        told += f" That is more than the {shown(float(allowed), digits=2)} allowed: give more samples."
    return told


def _most(values: np.ndarray, found: np.ndarray) -> float:
    own = np.asarray(values, dtype=float)[found]
    return float(np.nanmax(own)) if np.isfinite(own).any() else float("nan")


@sections_of(FrequencyCurve)
def frequency_curve(curve: FrequencyCurve, options: ReportOptions) -> list[Section]:
    """The response, its contacts and harmonics, and what was computed beside it."""
    look = Look.of(curve, options.dofs, options.amplitude) if curve.converged.any() else None
    sections: list[Section] = [_headline(curve, look)]
    if look is not None:
        sections.append(forced_response(look, options.first(Backbone)))
        sections += [friction(look)] if curve.coordinates else []
        sections.append(harmonics(look))
    return [*sections, *beside(options, curve), balance(curve)]


def beside(options: ReportOptions, curve: FrequencyCurve | None = None) -> list[Section]:
    """Sections of what was computed beside a response."""
    sections = {
        Deformation: deformed,
        Backbone: nonlinear_mode,
        TimeComparison: lambda compared: in_time(compared, curve),
        ReductionErrors: reduced,
    }
    found = {kind: options.first(kind) for kind in sections}
    return [section(found[kind]) for kind, section in sections.items() if found[kind] is not None]


def _headline(curve: FrequencyCurve, look: Look | None) -> Headline:
    found, points = int(curve.converged.sum()), len(curve.converged)
    low, high = (shown(float(end)) for end in (curve.frequencies.min(), curve.frequencies.max()))
    facts = {}
    if look is not None:
        peak = curve.peak(look.dof, look.kind)
        size = in_words(peak.amplitude, unit_of(look.dof), 5)
        facts[f"peak of {look.dof}"] = f"{size} at {shown(peak.frequency)} Hz"
    facts |= {
        "harmonics": _orders(curve.orders),
        "Newton iterations a point": shown(float(np.mean(curve.iterations)), digits=3),
        "samples of a period": counted(int(np.max(curve.samples))),
    }
    status = (
        f"All {counted(points)} points between {low} and {high} Hz were found."
        if found == points
        else f"{counted(points - found)} of {counted(points)} points between {low} and {high} Hz were not found; "
        "they are marked, and the curve continues past them."
    )
    return Headline(
        title="Forced response",
        verdict="computed" if found == points else "incomplete" if found else "not found",
        success=found == points,
        status=status,
        facts=facts | ({"contacts": counted(len(curve.contacts))} if curve.contacts else {}),
    )


def _orders(orders: Sequence[int]) -> str:
    """Harmonics in a few words.

    >>> _orders((0, 1, 2, 3)), _orders((1, 3, 5)), _orders((1, 3, 5, 7, 9))
    ('0 to 3', '1, 3, 5', '1, 3 … 9')
    """
    if len(orders) > 2 and list(orders) == list(range(orders[0], orders[-1] + 1)):
        return f"{orders[0]} to {orders[-1]}"
    return ", ".join(map(str, orders)) if len(orders) < 5 else f"{orders[0]}, {orders[1]} … {orders[-1]}"
