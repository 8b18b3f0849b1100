"""Findings on inputs whose samples are closer together than the steps of an integrator."""

from collections.abc import Iterator

import numpy as np

from dalembert.findings import Finding
from dalembert.multibody.components.signals import Table
from dalembert.multibody.model.system import BaseSystem

LOST = 0.05  # part of an input's variation that steps may miss
LATE = 0.25  # time before the first sample, in parts of that from the first to the last


def late_samples(times: np.ndarray) -> tuple[Finding, ...]:
    """Return a finding on samples (samples,), s, that begin long after the motion does, which is at 0."""
    first = float(times[0])
    if len(times) < 3 or first <= LATE * (times[-1] - first):
        return ()
    return (
        Finding(
            "late-samples",
            "note",
            {"first": first},
            f"The first sample is at {first:.6g} s, and the motion starts at 0 s.",
            "If the motion starts with the record, use data.since('first').",
        ),
    )


def skipped_samples(system: BaseSystem, step: float | None, begin: float, end: float) -> tuple[Finding, ...]:
    """Return a finding for each table of a system that fixed steps sample too coarsely. ``step``: s, None for a solver
    that chooses its steps; ``begin``, ``end``: time of the signals at which the motion starts, and its duration, s. The
    lost part is the root mean square of the values less those on lines between the steps, relative to their standard
    deviation. Steps end at all changes of a held table, so that none is lost.
    """
    if step is None:
        return ()
    found = []
    for component in (*system.joints, *system.loads):
        tables = {name: one for name, one in vars(component).items() if isinstance(one, Table) and not one.steps}
        for name, table in tables.items():
            found += _skipped(component.name, name, table, step, begin - float(np.real(table.delay)), end)
    return tuple(found)


def _skipped(component: str, name: str, table: Table, step: float, begin: float, end: float) -> Iterator[Finding]:
    times, values = np.asarray(table.times, dtype=float), np.real(table.values)
    inside = (times >= begin) & (times <= begin + end)
    times, values = times[inside], values[inside]
    if len(times) < 3 or np.ptp(values) == 0:
        return
    apart = float(np.median(np.diff(times)))
    steps = np.arange(begin, begin + end + step, step)
    taken = np.interp(times, steps, np.interp(steps, times, values))
    lost = float(np.sqrt(np.mean((values - taken) ** 2)) / np.std(values))
    if step > 1.01 * apart and lost > LOST:
        given = {"component": component, "key": name, "step": step, "apart": apart, "lost": lost}
        yield Finding(
            "skipped-samples",
            "warning",
            given,
            f"Steps of {step:.3g} s miss {100 * lost:.2g} % of the variation of the input {name!r} of {component!r}, "
            f"whose samples are {apart:.3g} s apart.",
            f"Use steps of {apart:.2g} s, or a low-pass filter for the input.",
        )
