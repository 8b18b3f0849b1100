"""What the contacts do at the peak and along the curve."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from dalembert.report import charts
from dalembert.report.charts.contact_states import shares
from dalembert.report.digits import shown
from dalembert.report.focus import Look, dissipation_of, of_contacts, of_springs
from dalembert.report.look import plain
from dalembert.report.plot import Plot
from dalembert.report.sections.findings import Findings
from dalembert.report.table import Cell, Table, cell
from dalembert.vibration import FrequencyCurve

FEW_SPRINGS = 6


@dataclass(frozen=True)
class Friction(Findings):
    """Hysteresis loops, states and energies of contacts, and the forces of springs, at the peak."""

    heading: ClassVar[str] = "Contacts and springs"
    look: Look
    lead: str = ""

    @property
    def sentences(self) -> tuple[str, ...]:
        curve, point = self.look.curve, self.look.point
        at = f"the point of the curve where {self.look.dof} is largest, {shown(float(curve.frequencies[point]))} Hz,"
        if not curve.contacts:
            return (_after(self.lead, f"Drawn for {at[:-1]}."),)
        part = {name: float(share.mean()) for name, share in shares(curve.states[point]).items()}
        told = f"At {at} the contacts are stuck for {_percent(part['stuck'])} of the period, slip for "
        told += f"{_percent(part['slipping'])} and are separated for {_percent(part['separated'])}."
        told = _after(self.lead, told)
        energy = float(np.sum([energy[point] for energy in dissipation_of(curve).values()]))
        if part["stuck"] == 1:
            return (told, "They stick all the time there: what damps is the structure, not friction.")
        return (told, f"Friction takes {shown(energy, digits=4)} J from the motion in each period.")

    @property
    def wide(self) -> tuple[Plot, ...]:
        if not self.look.curve.contacts:
            return ()
        at = _at(self.look.curve, self.look.point)
        return (
            Plot(
                "contact-states",
                charts.contact_states(self.look.curve, self.look.point, title=f"Contact states over a period at {at}"),
                "A row for each contact; phase 0 is the crest of a force without phase.",
            ),
        )

    @property
    def pairs(self) -> tuple[Plot, ...]:
        curve, point, at = self.look.curve, self.look.point, _at(self.look.curve, self.look.point)
        found = []
        if curve.contacts:
            loops = charts.hysteresis(curve, point, title=f"Hysteresis loops at {at}")
            area = "The area of a loop is the energy that friction takes in a period; forces by the harmonics kept."
            mean = "Mean of all contacts." if len(curve.contacts) > 1 else ""
            found = [
                Plot("hysteresis", loops, area),
                Plot("dissipation", charts.dissipation(curve), "What each contact takes from the motion."),
                Plot("contact-shares", charts.contact_shares(curve), mean),
            ]
        springs = of_springs(curve)[:FEW_SPRINGS]
        if springs:
            figure = charts.hysteresis(curve, point, springs, title=f"Forces of {_named(springs)} at {at}")
            found.append(Plot("spring-forces", figure, "Force over displacement during a period."))
        return tuple(found)

    @property
    def tables(self) -> tuple[Table, ...]:
        return (*self._of_contacts, *self._of_springs)

    @property
    def _of_contacts(self) -> tuple[Table, ...]:
        curve, point = self.look.curve, self.look.point
        if not curve.contacts:
            return ()
        parts, energies = shares(curve.states[point]), dissipation_of(curve)
        rows = [
            (
                cell(contact),
                *(cell(float(100 * parts[state][place]), digits=3) for state in ("stuck", "slipping", "separated")),
                cell(float(energies[contact][point]), digits=4),
                *self._largest(names[0]),
            )
            for place, (contact, names) in enumerate(of_contacts(curve).items())
        ]
        columns = (
            "contact",
            "stuck (% of the period)",
            "slipping (%)",
            "separated (%)",
            "energy of a period (J)",
            "largest displacement (m)",
            "largest friction force (N)",
        )
        caption = f"Contacts at {shown(float(curve.frequencies[point]))} Hz, along their first tangential direction"
        return (Table("contacts", caption, columns, rows),)

    @property
    def _of_springs(self) -> tuple[Table, ...]:
        curve, point, names = self.look.curve, self.look.point, of_springs(self.look.curve)
        if not names:
            return ()
        rows = [
            (cell(name), cell(float(curve.dissipated(name)[point]), digits=4), *self._largest(name)) for name in names
        ]
        columns = ("element", "energy of a period (J)", "largest displacement (m)", "largest force (N)")
        caption = f"Springs and other laws at {shown(float(curve.frequencies[point]))} Hz"
        return (Table("springs", caption, columns, rows),)

    def _largest(self, coordinate: str) -> tuple[Cell, Cell]:
        """Largest displacement and force along a coordinate."""
        u, force = self.look.curve.loop(coordinate, self.look.point)
        return cell(float(np.abs(u).max()), digits=4), cell(float(np.abs(force).max()), digits=4)


def _percent(part: float) -> str:
    return f"{shown(100 * part, digits=3)} %"


def _at(curve: FrequencyCurve, point: int) -> str:
    return f"{shown(float(curve.frequencies[point]))} Hz"


def _named(names: list[str]) -> str:
    return plain(names[0]) if len(names) == 1 else "springs"


def _after(lead: str, sentence: str) -> str:
    return f"{lead}{sentence[0].lower()}{sentence[1:]}" if lead else sentence
