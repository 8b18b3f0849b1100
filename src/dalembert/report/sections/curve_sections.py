"""A response over frequency: its peaks, contacts, harmonics, and how far it can be trusted."""

from collections.abc import Iterable, Mapping

import numpy as np

from dalembert.errors import counted
from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Block, Plot, Row, Section, by_name
from dalembert.report.sections.mode_sections import reduced
from dalembert.report.sections.shape_sections import deformed, in_time, nonlinear_mode
from dalembert.structure import ReductionErrors
from dalembert.tables import Table, percent, shown
from dalembert.vibration import Backbone, Deformation, FrequencyCurve, TimeComparison
from dalembert.vibration.balance.arc_length import CLOSED
from dalembert.vibration.paths.focus import Look, dissipation_of, marked, of_springs, state_shares, unstable

FEW_SPRINGS = 6
ENOUGH = 1e-2
"""Size of the last harmonics at the peak, as part of the largest, above which more of them should be kept."""


@sections_of(FrequencyCurve)
def frequency_curve(curve: FrequencyCurve, options: ReportOptions) -> list[Section]:
    """The response, its contacts and harmonics, and what was computed beside it."""
    shown_of = options.dofs, options.amplitude
    tables = by_name(curve.tables(*shown_of))
    sections: list[Section] = [headline_of(curve, facts=curve.facts(*shown_of))]
    if curve.converged.any():
        look = Look.of(curve, *shown_of)
        listed = (table for name in ("peaks", "marked-points", "not-found") for table in tables[name])
        sections.append(forced_response(look, options.first(Backbone), listed, options.each(FrequencyCurve)))
        if "control" in curve.provenance:
            how = "All forces but static ones have this factor, so that the amplitude is held."
            sections.append(Section("Held amplitude", (Plot("load-factors", charts.load_factors(curve), how),)))
        sections += [friction(look, tables)] if curve.coordinates else []
        how = "Harmonics that stay below a millionth of the largest are left out."
        plot = Plot("harmonic-content", charts.harmonic_content(curve, look.dof), how)
        sections.append(Section("Harmonics", (_enough(look.harmonic_sizes), plot, *tables["harmonics"])))
    how = "A rise shows where the motion is hard to find: where contacts begin to slip or to lift off."
    plot = Plot("points-found", charts.points_found(curve), how)
    balance = Section("Diagnostics of the balance", (_sampling(curve), plot, *tables["balance"]))
    return [*sections, *beside(options, curve), balance]


def forced_response(
    look: Look, mode: Backbone | None, tables: Iterable[Table], branches: Mapping[str, FrequencyCurve] | None = None
) -> Section:
    """The curve of the degrees of freedom looked at with its branches, and tables of its peaks and marked points."""
    curve, sentences = look.curve, []
    how = "Each point is a periodic motion."
    how += " Symbols: where the path has a fold or changes its stability." if marked(curve) else ""
    how += " Dashed: unstable motions." if unstable(curve).any() else ""
    how += " Crosses: not found." if not curve.converged.all() else ""
    how += " Dotted: the nonlinear mode without force." if mode is not None else ""
    plot = Plot(
        "frequency-curve", charts.frequency_curve(curve, look.dofs, kind=look.kind, mode=mode, branches=branches), how
    )
    if folds := [shown(float(curve.frequencies[point])) for point in marked(curve).get("fold", [])]:
        listed = folds[0] if len(folds) == 1 else f"{', '.join(folds[:-1])} and {folds[-1]}"
        sentences.append(
            f"The path has folds at {listed} Hz: between them several motions are possible at "
            "the same frequency, and a slow sweep jumps from one to another."
        )
    bad = unstable(curve)
    if bad.any():
        between = curve.frequencies[bad]
        sentences.append(
            f"{int(bad.sum())} of {len(bad)} points, between {shown(float(between.min()))} and "
            f"{shown(float(between.max()))} Hz, are unstable: the structure does not stay in these motions."
        )
    for name, branch in (branches or {}).items():
        low, high = (shown(float(end(branch.frequencies))) for end in (np.nanmin, np.nanmax))
        where = f"lies between {low} and {high} Hz, {counted(len(branch), 'point')}"
        closed = any(finding.values.get("reason") == CLOSED for finding in branch.findings)
        where += ", and is closed: no sweep of the frequency comes to it from outside." if closed else "."
        sentences.append(f"{(name or 'another branch').capitalize()} {where}")
    if len(look.dofs) < len(curve.dofs):
        sentences.append(
            f"Drawn are {len(look.dofs)} degrees of freedom of the {len(curve.dofs)} observed, in the table those that "
            "move most."
        )
    return Section("Forced response", (*sentences, plot, *tables))


def friction(look: Look, tables: Mapping[str, list[Table]], lead: str = "") -> Section:
    """Hysteresis loops, states and energies of contacts, and the forces of springs, at the peak."""
    curve, point = look.curve, look.point
    at = f"{shown(float(curve.frequencies[point]))} Hz"
    blocks: list[Block] = [*_friction_sentences(look, lead, at)]
    pairs = []
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
    if springs := of_springs(curve):
        few = springs[:FEW_SPRINGS]
        named = plain(few[0]) if len(few) == 1 else "springs"
        figure = charts.hysteresis(curve, point, few, title=f"Forces of {named} at {at}")
        pairs.append(Plot("spring-forces", figure, "Force over displacement during a period."))
    return Section("Contacts and springs", (*blocks, Row(pairs), *tables["contacts"], *tables["springs"]))


def _friction_sentences(look: Look, lead: str, at: str) -> tuple[str, ...]:
    curve, point = look.curve, look.point
    where = f"the point of the curve where {look.dof} is largest, {at}"
    if not curve.contacts:
        sentence = f"Drawn for {where}."
        return (f"{lead}{sentence[0].lower()}{sentence[1:]}" if lead else sentence,)
    part = {name: float(share.mean()) for name, share in state_shares(curve.states[point]).items()}
    states = (
        f"{f'{lead}at' if lead else 'At'} {where}, the contacts are stuck for {percent(part['stuck'])} of the period, "
        f"slip for {percent(part['slipping'])} and are separated for {percent(part['separated'])}."
    )
    if part["stuck"] == 1:
        return (states, "They stick all the time there: what damps is the structure, not friction.")
    energy = float(np.sum([energy[point] for energy in dissipation_of(curve).values()]))
    return (states, f"Friction takes {shown(energy, digits=4)} J from the motion in each period.")


def _enough(sizes: dict[int, float]) -> str:
    """Whether the last harmonics are small; empty where there is nothing to say."""
    most, higher = max(sizes.values()), [size for order, size in sizes.items() if order > 1]
    if most <= 0 or not higher:
        return ""
    last = max(higher[-2:])
    part = f"{percent(last / most, 2)} of the largest one"
    if last > ENOUGH * most:
        return f"At the peak the last two harmonics kept still reach {part}; keep more harmonics."
    return f"At the peak the last two harmonics kept are at most {part}."


def _sampling(curve: FrequencyCurve) -> str:
    """What more samples would change; empty where no point was found."""
    if not curve.converged.any():
        return ""
    error = float(np.nanmax(np.asarray(curve.sampling_errors)[curve.converged], initial=0.0))
    allowed = curve.provenance.get("method", {}).get("sampling")
    text = f"Twice as many samples of a period would change the forces by at most {shown(error, digits=2)} of them."
    if allowed is not None and error > allowed:
        text += f" That is more than the {shown(float(allowed), digits=2)} allowed: give more samples."
    return text


def beside(options: ReportOptions, curve: FrequencyCurve | None = None) -> list[Section]:
    """Sections of what was computed beside a response."""
    sections = {
        Deformation: deformed,
        Backbone: nonlinear_mode,
        TimeComparison: lambda compared: in_time(compared, curve),
        ReductionErrors: reduced,
    }
    results = {kind: options.first(kind) for kind in sections}
    return [section(results[kind]) for kind, section in sections.items() if results[kind] is not None]
