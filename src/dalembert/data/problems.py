"""What a fit would stumble over in the columns of a file, found before anything is fitted."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from dalembert.data.guesses import Unit
from dalembert.data.preview import Preview, PreviewColumn
from dalembert.data.stretches import gaps
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.unit_table import readings
from dalembert.units import factor_of, wrong_kind

MANY = 20_000
"""Samples from which a fit takes long without learning more."""
KEPT = 5_000
"""Samples that are to be left of many."""
CUBIC = np.array([-1.0, 4.0, 0.0, 4.0, -1.0]) / 6
"""Weights of the neighbours of a sample in the value that a cubic polynomial through them has there."""
AROUND, LOCAL = 7, 25
"""Samples whose median a value is compared with, and those that say how much values scatter about it."""
SCATTER = 10.0
"""Standard deviations of the scatter from which a value is an outlier."""
SMALL = 0.02
"""Part of the range of a column below which a value is no outlier."""
TURNS = 2.0
"""Turns (in radians) from which an angle without a unit is probably one in degrees."""
JUMP = 0.75
"""Part of a turn from which a step of an angle is a jump by a whole turn."""
FLAT = 1e-9
"""Range of a column, as a part of its largest value, below which it is constant."""


@dataclass(frozen=True)
class Use:
    """How the columns of a file are to be used. ``time``: column of the times; ``units``: of columns, SI where there is
    none; ``channels``: column of each channel, and SI unit of the channel (``""`` if it is not known); ``start``: time
    (s) of the file at which the motion begins, or ``"first"``; ``missing``: ``"refuse"`` or ``"leave-out"``; ``wraps``:
    channels that are angles known up to whole turns; ``between``: times (s) from the beginning of the motion between
    which samples are used.
    """

    time: str | int | None = None
    units: Mapping[str | int, Unit] = field(default_factory=dict)
    channels: Mapping[str, tuple[str | int, str]] = field(default_factory=dict)
    start: float | str | None = None
    missing: str = "refuse"
    wraps: tuple[str, ...] = ()
    between: tuple[float, float] | None = None
    decimate: int | None = None

    def factor(self, key: str | int | None) -> float:
        """Number of SI units that the unit of a column is; 1 if it is unknown."""
        unit = self.units.get(key) if key is not None else None
        try:
            return factor_of(unit.name, measured=True) if unit is not None and unit.name not in ("", "-", "1") else 1.0
        except InputError:
            return 1.0


def problems(preview: Preview, use: Use) -> list[Finding]:
    """Return what is wrong or doubtful in the times and in the columns of channels, errors first."""
    times = None if use.time is None else preview.column(use.time)
    listed = [*_of_lines(preview)]
    if times is not None:
        listed += _of_times(preview, times, use)
    along = None if times is None else times.values * use.factor(use.time)
    for channel, (key, unit) in use.channels.items():
        column = preview.column(key)
        if column is not None:
            listed += _of_channel(column, channel, unit, use, along)
    order = ("error", "warning", "note")
    return sorted(listed, key=lambda finding: order.index(finding.severity))


def _of_lines(preview: Preview) -> Iterator[Finding]:
    if preview.uneven is not None:
        line, cells = preview.uneven
        yield Finding(
            "uneven-line",
            "error",
            {"line": line, "cells": cells, "columns": len(preview.columns)},
            f"Line {line} has {cells} cells; expected {len(preview.columns)}, as the others have.",
            "Correct or remove the line in the file, or choose another separator.",
        )


def _of_times(preview: Preview, times: PreviewColumn, use: Use) -> Iterator[Finding]:
    yield from _unreadable(times, times=True)
    values, unit = times.values * use.factor(times.key), use.units.get(times.key)
    finite = values[np.isfinite(values)]
    if len(finite) < 2:
        return
    back = np.flatnonzero(np.diff(finite) <= 0)
    if len(back):
        row = int(back[0]) + 1
        yield Finding(
            "times-not-growing",
            "error",
            {"column": times.key, "sample": row, "samples": len(back)},
            f"The times do not grow: in row {row + 1} of the numbers {finite[row]:.6g} s comes after "
            f"{finite[row - 1]:.6g} s ({len(back)} rows in all).",
            "Choose another column of times, or sort the lines of the file and remove repeated ones.",
        )
        return
    yield from _of_unit(times, "s", use)
    steps, long = np.diff(finite), gaps(finite)
    usual = float(np.median(steps))
    if unit is not None and unit.source == "steps" and unit.name != "s":
        yield Finding(
            "guessed-time-unit",
            "warning",
            {"column": times.key, "unit": unit.name, "step": usual, "duration": float(finite[-1] - finite[0])},
            f"The file names no unit of the times. They are taken to be in {unit.name}: {1 / usual:.4g} samples a "
            f"second, {finite[-1] - finite[0]:.4g} s in all.",
            "Choose the unit of the times if this is wrong.",
        )
    yield from _beginning(finite, use)
    if len(long):
        widest = int(long[np.argmax(steps[long])])
        yield Finding(
            "time-gaps",
            "note",
            {"gaps": len(long), "time": float(finite[widest]), "longest": float(steps[widest])},
            f"Samples are missing in {_count(len(long), 'gap')} of the times. The longest is {steps[widest]:.3g} s "
            f"long, behind {finite[widest]:.4g} s; the usual step is {usual:.3g} s.",
            "A fit needs no samples there. Check that the record is of one motion.",
        )
    if len(finite) > MANY and use.decimate is None and use.between is None:
        factor = int(np.ceil(len(finite) / KEPT))
        yield Finding(
            "many-samples",
            "warning",
            {"samples": len(finite), "factor": factor, "even": not len(long) and bool(np.ptp(steps) < 0.01 * usual)},
            f"The record has {len(finite)} samples. A fit takes long, and fewer samples give nearly the same values.",
            f"Keep every {factor}th sample behind a low-pass filter (decimate), or a shorter part of the record.",
        )


def _beginning(times: np.ndarray, use: Use) -> Iterator[Finding]:
    begin = times[0] if use.start == "first" else 0.0 if use.start is None else float(use.start)
    if times[0] < begin and use.between is None:
        yield Finding(
            "samples-before-start",
            "error",
            {"samples": int(np.sum(times < begin)), "first": float(times[0] - begin), "last": float(times[-1] - begin)},
            f"{_count(int(np.sum(times < begin)), 'sample')} lie before the time {begin:.6g} s at which the motion "
            "begins.",
            "Leave them out, or let the motion begin with the first sample.",
        )
    if abs(times[0]) > 1e-9 * np.ptp(times):
        handled = use.start is not None
        yield Finding(
            "late-times",
            "note" if handled else "warning",
            {"first": float(times[0])},
            f"The times begin at {times[0]:.6g} s, and the motion of a model begins at 0 s."
            + (f" The time {begin:.6g} s of the file becomes 0 s." if handled else ""),
            "" if handled else "Choose when the motion begins, such as with the first sample.",
        )


def _unreadable(column: PreviewColumn, *, times: bool = False, left_out: bool = False) -> Iterator[Finding]:
    if column.wrong is not None:
        line, cell = column.wrong
        yield Finding(
            "no-number",
            "error",
            {"column": column.key, "line": line, "cell": cell, "times": times},
            f"The column {str(column.key)!r} has {cell!r} in line {line}, which is no finite number.",
            "Correct or empty the cell in the file, or choose another separator or decimal mark."
            if times
            else "Correct or empty the cell in the file, take it as a missing value, or choose another separator or "
            "decimal mark.",
        )
    if column.missing and not left_out:
        yield Finding(
            "missing-values",
            "error",
            {"column": column.key, "cells": column.missing, "times": times},
            f"The column {str(column.key)!r} has {_count(column.missing, 'empty cell')}.",
            "Remove these lines in the file."
            if times
            else "Leave missing values out, or remove the lines in the file.",
        )


def _of_unit(column: PreviewColumn, wanted: str, use: Use) -> Iterator[Finding]:
    name = _unit_name(use, column.key)
    values = {"column": column.key, "unit": name}
    if name not in ("", "-", "1") and not readings(name):
        yield Finding(
            "unknown-unit",
            "error",
            values,
            f"The unit {name!r} of the column {str(column.key)!r} is unknown.",
            "Choose its unit, such as mm, deg or m/s^2.",
        )
    elif wanted and (sentence := wrong_kind(name, wanted)):
        yield Finding(
            "wrong-unit",
            "error",
            values | {"expected": wanted},
            f"The column {str(column.key)!r} does not measure what it is used for: {sentence}.",
            "Choose another column, or correct its unit.",
        )


def _of_channel(
    column: PreviewColumn, channel: str, unit: str, use: Use, along: np.ndarray | None
) -> Iterator[Finding]:
    yield from _unreadable(column, left_out=use.missing == "leave-out")
    yield from _of_unit(column, unit, use)
    finite = np.isfinite(column.values)
    values = column.values[finite] * use.factor(column.key)
    if len(values) < 2:
        return
    named = {"channel": channel, "column": column.key}
    if np.ptp(values) <= FLAT * np.max(np.abs(values)):
        yield Finding(
            "constant-column",
            "warning",
            named,
            f"The column {str(column.key)!r} is constant ({values[0]:.6g}).",
            "Choose the column that was measured.",
        )
        return
    if unit == "rad" and not _unit_name(use, column.key) and np.max(np.abs(values)) > TURNS * 2 * np.pi:
        yield Finding(
            "suspect-degrees",
            "warning",
            named | {"unit": "deg"},
            f"The column {str(column.key)!r} reaches {np.max(np.abs(values)):.4g} rad, which is "
            f"{np.max(np.abs(values)) / (2 * np.pi):.3g} turns. It has no unit and is probably in degrees.",
            "Choose deg as its unit.",
        )
    elif unit == "rad" and channel not in use.wraps and (jumps := _jumps(values)):
        yield Finding(
            "angle-jumps",
            "warning",
            named | {"jumps": jumps},
            f"The column {str(column.key)!r} has {_count(jumps, 'jump')} by about a turn.",
            "Take the channel as an angle that is known up to whole turns (wraps).",
        )
    far = outliers(values)
    if len(far):
        first = float(along[finite][far[0]]) if along is not None and len(along) == len(finite) else float(far[0])
        yield Finding(
            "outliers",
            "warning",
            named | {"samples": len(far), "time": first, "value": float(values[far[0]]), "noise": _noise(values)},
            f"{_count(len(far), 'value')} of the column {str(column.key)!r} {'lies' if len(far) == 1 else 'lie'} far "
            f"from the values around {'it' if len(far) == 1 else 'them'}, the first at {first:.4g} s.",
            "Empty these cells in the file and leave missing values out, or use a robust loss: loss = 'huber'.",
        )


def outliers(values: np.ndarray) -> np.ndarray:
    """Return the samples whose ``values`` (samples,), all finite, lie far from those around them.

    A value is far if it differs from the median of the values around it, and from a cubic polynomial through the two on
    each side, by more than ten standard deviations of the scatter about such polynomials (1.4826 times the median of
    the absolute differences there), 3.5 times the median of the changes per sample there, and 2 % of the span from the
    1 % to the 99 % quantile of the values. Fewer than 25 values are not judged.
    """
    if len(values) < LOCAL:
        return np.zeros(0, dtype=int)
    from scipy.ndimage import median_filter

    from_cubic = np.zeros(len(values))  # of a smooth motion nearly zero, at its peaks as well
    from_cubic[2:-2] = np.abs(values[2:-2] - np.convolve(values, CUBIC, mode="valid"))
    from_median = np.abs(values - median_filter(values, AROUND, mode="nearest"))  # zero at the edges of a step
    scatter = 1.4826 * median_filter(from_cubic, LOCAL, mode="nearest")
    slope = median_filter(np.abs(np.gradient(values)), LOCAL, mode="nearest")  # by which medians differ near an edge
    span = np.ptp(np.quantile(values, [0.01, 0.99]))
    limit = SCATTER * scatter + 0.5 * AROUND * slope + SMALL * span
    return np.flatnonzero(np.minimum(from_cubic, from_median) > limit)


def _noise(values: np.ndarray) -> float:
    """Standard deviation of the noise of a smooth motion, robust to outliers.

    >>> round(_noise(np.random.default_rng(0).standard_normal(4000)), 1)
    1.0
    """
    differences = values[2:-2] - np.convolve(values, CUBIC, mode="valid")
    return float(1.4826 * np.median(np.abs(differences)) / np.sqrt(1 + CUBIC @ CUBIC))


def _jumps(values: np.ndarray) -> int:
    """Number of jumps by about a turn of an angle in rad that stays within one."""
    return int(np.sum(np.abs(np.diff(values)) > JUMP * 2 * np.pi)) if np.ptp(values) < 1.1 * 2 * np.pi else 0


def _unit_name(use: Use, key: str | int) -> str:
    return use.units[key].name if key in use.units else ""


def _count(number: int, what: str) -> str:
    """
    >>> _count(1, "gap"), _count(3, "gap")
    ('1 gap', '3 gaps')
    """
    return f"{number} {what}{'' if number == 1 else 's'}"
