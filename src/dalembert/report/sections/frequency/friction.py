"""What the contacts do at the peak and along the curve."""

from collections.abc import Iterable

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.frequency.contacts import shares
from dalembert.report.digits import percent, shown
from dalembert.report.focus import Look, dissipation_of, of_contacts, of_springs
from dalembert.report.look import plain
from dalembert.report.section import Block, Fold, Plot, Row, Section
from dalembert.report.table import Cell, Table, cells

FEW_SPRINGS = 6


def friction(look: Look, lead: str = "") -> Section:
    """Hysteresis loops, states and energies of contacts, and the forces of springs, at the peak."""
    curve, point = look.curve, look.point
    at = f"{shown(float(curve.frequencies[point]))} Hz"
    blocks: list[Block] = [*_sentences(look, lead, at)]
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


def _sentences(look: Look, lead: str, at: str) -> tuple[str, ...]:
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
