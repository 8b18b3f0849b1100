"""What is computed beside a response over frequency: nonlinear modes, deformed shapes, periodic motions in time."""

import numpy as np

from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.scene.shape import magnified
from dalembert.report.section import Block, Motion, Plot, Row, Section
from dalembert.tables import percent, shown
from dalembert.units import unit_of
from dalembert.vibration import Backbone, Deformation, FrequencyCurve, PeriodicMotion, StaticContact, TimeComparison

STEADY = 1e-3
"""Change of the frequency, as part of it, below which none is stated."""


@sections_of(Backbone)
def backbone(mode: Backbone, options: ReportOptions) -> list[Section]:
    """The mode alone."""
    return [headline_of(mode), nonlinear_mode(mode)]


def nonlinear_mode(mode: Backbone) -> Section:
    """Frequency and damping over amplitude, with the energy of the mode and the force that keeps it going."""
    how = "Without force, and with the damping made up for: resonance peaks of forced responses lie on this line."
    return Section("Nonlinear mode", (*_sentences(mode), Plot("backbone", charts.backbone(mode), how), *mode.tables()))


def _sentences(mode: Backbone) -> list[str]:
    known = np.asarray(mode.converged)
    if not known.any():
        return []
    amplitudes, frequencies, damping = (
        np.asarray(values)[known] for values in (mode.amplitudes, mode.frequencies, mode.damping)
    )
    unit = unit_of(mode.dof)
    low, high = (f"{shown(float(amplitudes[end]), digits=4)} {unit}" for end in (0, -1))
    first, last = float(frequencies[0]), float(frequencies[-1])
    if abs(last - first) < STEADY * first:
        sentences = [f"From {low} to {high} of {mode.dof} the frequency of the mode stays at {shown(first)} Hz."]
    else:
        word = "stiffens" if last > first else "softens"
        text = f"From {low} to {high} of {mode.dof} the mode {word}: its frequency goes from {shown(first)} to "
        sentences = [f"{text}{shown(last)} Hz."]
    top = int(damping.argmax())
    if damping[top] > 0:
        most = f"It is damped most, by a ratio of {percent(damping[top])}, at "
        sentences.append(f"{most}{shown(float(amplitudes[top]), digits=4)} {unit}.")
    return sentences


@sections_of(Deformation)
def deformation(shape: Deformation, options: ReportOptions) -> list[Section]:
    """The deformed shape."""
    return [headline_of(shape), deformed(shape)]


def deformed(shape: Deformation) -> Section:
    """The deformed shape as a film, and a map of the interface where there are contacts."""
    film, blocks = charts.deformation(shape), list[Block]()
    how = f"Displacements drawn {shown(magnified(shape), digits=2)} times as large as they are; thin lines: at rest. "
    how += f"The film is {film.pace}. Drag to turn the view."
    energies = np.asarray(shape.energies, dtype=float)
    if len(energies) > 1 and energies.max() > 0:
        most = int(energies.argmax())
        part = percent(energies[most] / energies.sum())
        blocks.append(f"Of all the energy that friction takes, {shape.contacts[most]} takes most, {part}.")
    blocks.append(Motion("deformation", film, how))
    if shape.contacts:
        over = "Filled: the state at the phase shown; ring: the state held for longest; larger contacts take more "
        over += "energy from the motion."
        at = f"Contact states over the interface at {shown(shape.frequency)} Hz"
        blocks.append(Plot("interface-map", charts.interface_map(shape, title=at), over))
    return Section("Deformed shape", blocks)


@sections_of(StaticContact)
def static_contact(joint: StaticContact, options: ReportOptions) -> list[Section]:
    """Normal forces over the interface, and those of the contacts that carry most."""
    blocks = list[Block]()
    if np.isfinite(joint.contact_places).all(axis=1).any():
        how = "Coloured by the normal force; a thick ring: the contact slips; hollow: it is open."
        blocks.append(Plot("normal-forces", charts.normal_forces(joint), how))
    return [headline_of(joint), Section("Contacts at rest", (*blocks, *joint.tables()))]


@sections_of(TimeComparison)
def time_comparison(compared: TimeComparison, options: ReportOptions) -> list[Section]:
    """The comparison alone."""
    return [headline_of(compared), in_time(compared)]


def in_time(compared: TimeComparison, curve: FrequencyCurve | None = None) -> Section:
    """Points of the curve that were integrated in time, and how far harmonic balance is from them."""
    how = "Crosses: in time; circles: harmonic balance at the same frequencies."
    plot = Plot("time-comparison", charts.time_comparison(compared, curve), how)
    known, settings = np.asarray(compared.converged), compared.provenance
    sentences = [
        f"{len(known)} points were integrated in time with {settings['method']['steps_per_period']} steps a "
        f"period ({settings['way']}), {compared.periods.min()} to {compared.periods.max()} periods each."
    ]
    if known.any():
        sizes = np.abs(compared.differences[known])
        row, column = np.unravel_index(int(np.nanargmax(sizes)), sizes.shape)
        sentences.append(
            f"Harmonic balance differs by at most {percent(sizes[row, column], 2)} of the largest motion, for "
            f"{compared.dofs[column]} at {shown(float(compared.frequencies[known][row]))} Hz."
        )
    if late := [shown(float(frequency)) for frequency in compared.frequencies[~known]]:
        sentences.append(f"Not periodic yet in time, so not to be compared: {', '.join(late)} Hz.")
    return Section(compared.title, (*sentences, plot, *compared.tables()))


@sections_of(PeriodicMotion)
def period(motion: PeriodicMotion, options: ReportOptions) -> list[Section]:
    """The last period."""
    plots = [Plot("periodic-motion", charts.periodic_motion(motion), "The last period of the integration.")]
    if motion.coordinates:
        how = "The area of a loop is the energy taken in a period."
        plots.append(Plot("loops-in-time", charts.loops_in_time(motion), how))
    return [headline_of(motion), Section("Periodic motion", (plots[0], Row(plots[1:]), *motion.tables()))]
