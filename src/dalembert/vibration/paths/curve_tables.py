"""Facts and tables of a response over frequency."""

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from dalembert.quantities import size_label
from dalembert.tables import Cell, Table, cells, counted, in_words, labelled, shown
from dalembert.units import unit_of
from dalembert.vibration.paths.focus import (
    Look,
    dissipation_of,
    marked,
    movers,
    of_contacts,
    of_springs,
    state_shares,
)

if TYPE_CHECKING:
    from dalembert.vibration.paths.curve import FrequencyCurve

MOST_NAMED = 4
MOST_ROWS = 20


def curve_facts(curve: "FrequencyCurve", dofs: Sequence[str], kind: str) -> dict[str, str]:
    """Return the peak of the degree of freedom that moves most, and how the curve was computed."""
    facts = {}
    if curve.converged.any():
        dof = Look.of(curve, dofs, kind).dof
        peak = curve.peak(dof, kind)
        facts[f"peak of {dof}"] = f"{in_words(peak.amplitude, unit_of(dof), 5)} at {shown(peak.frequency)} Hz"
    facts["harmonics"] = orders_text(curve.orders)
    facts["Newton iterations a point"] = shown(float(np.mean(curve.iterations)), digits=3)
    facts["samples of a period"] = counted(int(np.max(curve.samples)))
    if judged := int(np.sum(curve.stable >= 0)):
        facts["stable points"] = f"{int(np.sum(curve.stable == 1))} of {judged}"
    return facts | ({"contacts": counted(len(curve.contacts))} if curve.contacts else {})


def orders_text(orders: Sequence[int]) -> str:
    """Return harmonics in a few words.
    >>> orders_text((0, 1, 2, 3)), orders_text((1, 3, 5)), orders_text((1, 3, 5, 7, 9))
    ('0 to 3', '1, 3, 5', '1, 3 … 9')
    """
    if len(orders) > 2 and list(orders) == list(range(orders[0], orders[-1] + 1)):
        return f"{orders[0]} to {orders[-1]}"
    return ", ".join(map(str, orders)) if len(orders) < 5 else f"{orders[0]}, {orders[1]} … {orders[-1]}"


def curve_tables(curve: "FrequencyCurve", dofs: Sequence[str], kind: str) -> Iterator[Table]:
    """Yield peaks, marked points, points that were not found, contacts, springs, harmonics and diagnostics."""
    lost = ~curve.converged
    look = None if lost.all() else Look.of(curve, dofs, kind)
    if look is not None:
        yield _peaks(look)
        yield from _events(look)
    if lost.any():
        residuals = cells(curve.residuals[lost], 2)
        columns = {"frequency (Hz)": curve.frequencies[lost], "left unbalanced, part of the forces": residuals}
        yield Table.of("not-found", "Points that were not found", columns)
    if look is not None:
        yield from _contacts(look)
        sizes = look.harmonic_sizes
        most = max(sizes.values())
        columns = {
            "part of the motion": ["mean" if order == 0 else f"harmonic {order}" for order in sizes],
            labelled("amplitude", unit_of(look.dof)): sizes.values(),
            "of the largest (%)": cells((100 * size / most if most else 0.0 for size in sizes.values()), 3),
        }
        yield Table.of("harmonics", f"Harmonics of {look.dof} at its peak", columns, detail=True)
    yield _balance(curve)


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


def _events(look: Look) -> Iterator[Table]:
    events = [(event, point) for event, points in marked(look.curve).items() for point in points]
    if not events:
        return
    points = [point for _, point in events]
    columns = {"what": [event for event, _ in events], "frequency (Hz)": look.curve.frequencies[points]}
    for dof in look.dofs[:MOST_NAMED]:
        title = labelled(f"{size_label(look.kind)} of {dof}", unit_of(dof))
        columns[title] = look.curve.amplitude(dof, look.kind)[points]
    yield Table.of("marked-points", "Folds and changes of stability", columns)


def _contacts(look: Look) -> Iterator[Table]:
    """Yield states, energies and forces of contacts, and of other elements, at the peak."""
    curve, point = look.curve, look.point
    at = f"{shown(float(curve.frequencies[point]))} Hz"
    if curve.contacts:
        parts, energies = state_shares(curve.states[point]), dissipation_of(curve)
        columns = {
            "contact": energies,
            "stuck (% of the period)": cells(100 * parts["stuck"], 3),
            "slipping (%)": cells(100 * parts["slipping"], 3),
            "separated (%)": cells(100 * parts["separated"], 3),
            "energy of a period (J)": cells((energy[point] for energy in energies.values()), 4),
            **_largest(look, (names[0] for names in of_contacts(curve).values()), "largest friction force (N)"),
        }
        caption = f"Contacts at {at}, along their first tangential direction"
        yield Table.of("contacts", caption, columns, detail=True)
    if springs := of_springs(curve):
        columns = {
            "element": springs,
            "energy of a period (J)": cells((curve.dissipated(name)[point] for name in springs), 4),
            **_largest(look, springs, "largest force (N)"),
        }
        yield Table.of("springs", f"Springs and other laws at {at}", columns, detail=True)


def _largest(look: Look, coordinates: Iterable[str], force: str) -> dict[str, list[Cell]]:
    """Return columns of the largest displacements and forces along coordinates."""
    loops = [np.abs(look.curve.loop(name, look.point)).max(axis=1) for name in coordinates]
    return {"largest displacement (m)": cells((u for u, _ in loops), 4), force: cells((f for _, f in loops), 4)}


def _balance(curve: "FrequencyCurve") -> Table:
    """Return Newton iterations, residuals and samples of the points."""
    counts, settings = np.asarray(curve.iterations), curve.provenance.get("method", {})
    residuals, errors = (
        np.asarray(values, dtype=float)[curve.converged] for values in (curve.residuals, curve.sampling_errors)
    )
    rows = {
        "points": len(curve),
        "points found": int(curve.converged.sum()),
        "Newton iterations a point, mean": float(counts.mean()),
        "Newton iterations a point, most": int(counts.max(initial=0)),
        "largest unbalanced part of the forces, of points found": _largest_finite(residuals),
        "samples of a period, most": int(np.max(np.asarray(curve.samples), initial=0)),
        "change of the forces with twice the samples, most": _largest_finite(errors),
        **{f"setting: {name}": settings[name] for name in ("tolerance", "sampling") if name in settings},
    }
    return Table.of("balance", "Diagnostics", {"quantity": rows, "value": cells(rows.values(), 3)}, detail=True)


def _largest_finite(values: np.ndarray) -> float:
    return float(np.nanmax(values)) if np.isfinite(values).any() else float("nan")


def curve_status(curve: "FrequencyCurve") -> str:
    """Return how many points were found, in a sentence."""
    points, lost = len(curve), int((~curve.converged).sum())
    low, high = (shown(float(end)) for end in (curve.frequencies.min(), curve.frequencies.max()))
    if not lost:
        return f"All {counted(points)} points between {low} and {high} Hz were found."
    return (
        f"{counted(lost)} of {counted(points)} points between {low} and {high} Hz were not found; "
        "they are marked, and the curve continues past them."
    )
