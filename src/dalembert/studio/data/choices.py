"""How the columns of a data file are to be used, and the `[data]` table that says so."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import tomlkit
from tomlkit.items import InlineTable
from tomlkit.toml_document import TOMLDocument

from dalembert.data.guesses import Unit, time_column, unit_of
from dalembert.data.preview import Preview
from dalembert.data.problems import Use
from dalembert.data.text_layout import AUTO, is_number
from dalembert.data.unit_suffixes import suffix
from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.units import is_si, si

Key = str | int
OF_FILE = (
    "format",
    "frequency",
    "split",
    "trial",
    "between",
    "gap",
    "every",
    "resample",
    "lowpass",
    "more",
    "derivatives",
)
"""Keys of `[data]` that go with the file that they were written for, and that no choice sets."""


@dataclass(frozen=True)
class Choices:
    """How the columns of a file are to be used. ``file`` is a name beside the study, ``time`` and ``channels`` are
    columns. ``units`` has only the units that were chosen; the others are guessed. ``start``: time of the file at which
    the motion begins, as in `[data]`: a number (s), a text such as ``"1.5 s"`` or ``"first"``, or another entry;
    ``missing``: ``"refuse"``, ``"leave-out"``, or a list of words that stand for missing values; ``between``: times,
    or frequencies, between which samples are kept, as in `[data]`; ``sampling``: samples per second of a file without
    times.
    """

    file: str
    time: Key | None = None
    separator: str = AUTO
    decimal: str = AUTO
    units: Mapping[Key, str] = field(default_factory=dict)
    channels: Mapping[str, Key] = field(default_factory=dict)
    start: Any = None
    missing: str | list[str | float] = "refuse"
    wraps: tuple[str, ...] = ()
    decimate: int | None = None
    between: tuple[Any, Any] | None = None
    sampling: Any = None

    @property
    def absent(self) -> list[str]:
        """Words and numbers that stand for missing values, besides the common ones."""
        return [] if isinstance(self.missing, str) else list(map(str, self.missing))

    @property
    def rate(self) -> float | None:
        """Samples a second (Hz) without a column of times; None if there is none, or if it is no positive rate."""
        if self.sampling is None or self.time is not None:
            return None
        try:
            rate = si(self.sampling, "Hz")
        except InputError:
            return None
        return rate if rate > 0 else None

    @property
    def begin(self) -> float | None:
        """Time of the file at which the motion begins, s; None where no number says it."""
        return _number(self.start, "s")

    @property
    def used(self) -> tuple[Key | None, ...]:
        """The column of times, and those of channels."""
        return (self.time, *self.channels.values())

    def unit(self, preview: Preview, key: Key) -> Unit:
        """Unit of a column: the chosen one, or else the guessed one."""
        column = preview.column(key)
        if key in self.units or column is None:
            return Unit(self.units.get(key, ""), "")
        return unit_of(column, times=key == self.time)

    def with_unit(self, key: Key, unit: str) -> "Choices":
        """The same with another unit of a column."""
        return replace(self, units={**self.units, key: unit})

    def use(self, preview: Preview, units: Mapping[str, str]) -> Use:
        """The same for a search of problems; ``units`` are the SI units of channels."""
        lower, upper = (_number(end, "s") for end in self.between or (None, None))
        return Use(
            self.time,
            {column.key: self.unit(preview, column.key) for column in preview.columns},
            {channel: (key, units.get(channel, "")) for channel, key in self.channels.items()},
            self.start if self.start in (None, "first") else self.begin or 0.0,
            "refuse" if self.missing == "refuse" else "leave-out",
            self.wraps,
            None if lower is None or upper is None else (lower, upper),
            self.decimate,
        )

    def mapped(self, channel: str, key: Key | None) -> "Choices":
        """The same with another column of a channel, which has none if that is None."""
        kept = {name: column for name, column in self.channels.items() if name != channel}
        channels = kept if key is None else {**kept, channel: key}
        return replace(self, channels=channels, wraps=tuple(name for name in self.wraps if name in channels))


def guessed(preview: Preview, channels: Mapping[str, str], before: Choices | None = None) -> Choices:
    """Return how a file is probably to be used. ``channels`` maps the channels of the model to their SI units. Times
    that do not begin at 0 count from the first sample. A column is used for the channel of its name. The use of columns
    in ``before``, choices on another file, is kept if this file has columns of the same names.
    """
    time = time_column(preview)
    names = {column.key: column.key for column in preview.columns if column.key != time and column.key in channels}
    choices = Choices(preview.path.name, time, channels={str(name): key for name, key in names.items()})
    if before is not None and all(key is not None and preview.column(key) for key in before.used):
        time = before.time
        choices = replace(choices, time=time, channels=before.channels, units=before.units, wraps=before.wraps)
    times = None if time is None else preview.column(time)
    late = times is not None and len(times.values) > 0 and times.values[0] != 0.0
    gaps = any(column.missing for column in preview.columns if column.key != time)
    return replace(choices, start="first" if late else None, missing="leave-out" if gaps else "refuse")


def of_table(table: Mapping[str, Any]) -> Choices:
    """Return the choices that a `[data]` table says, as it stands in a study file."""
    columns: list[Any] = [table.get("time"), *table.get("columns", {}).values()]
    numbers: dict[str, Key] = {str(key): key for key in columns if isinstance(key, int)}
    between = table.get("between")
    if not isinstance(between, list) or len(between) != 2 or None in (_number(end, None) for end in between):
        between = None
    return Choices(
        str(table.get("file", "")),
        None if "sampling" in table else table.get("time", "t"),
        table.get("separator", AUTO),
        table.get("decimal", AUTO),
        {numbers.get(key, str(key)): str(unit) for key, unit in table.get("units", {}).items()},
        dict(table.get("columns", {})),
        table.get("start"),
        table.get("missing", "refuse"),
        tuple(table.get("wraps", ())),
        table.get("decimate"),
        None if between is None else (between[0], between[1]),
        table.get("sampling"),
    )


def _number(value: object, unit: str | None) -> float | None:
    """A number of a study file in an SI unit (None: any); None if it is no number and no text such as ``"1.5 s"``."""
    try:
        return si(value, unit)
    except InputError:
        return None


def table_of(choices: Choices, preview: Preview) -> dict[str, Any]:
    """Return the keys of the `[data]` table that choices say."""
    if choices.time is None and choices.sampling is None:
        raise InputError("No column has the times. Choose the column of the times, or give the sampling rate.")
    if not choices.channels:
        raise InputError("No column is used for a channel. Choose the channel that a column measures.")
    table: dict[str, Any] = {"file": choices.file}
    marks = {"separator": choices.separator, "decimal": choices.decimal}
    table |= {key: mark for key, mark in marks.items() if mark != AUTO}
    table |= {"time": choices.time} if choices.time not in ("t", None) else {}
    table |= {"sampling": choices.sampling} if choices.time is None else {}
    table["columns"] = dict(choices.channels)
    units = {str(key): choices.unit(preview, key).name for key in dict.fromkeys(choices.used) if key is not None}
    named = {str(column.key): column.unit for column in preview.columns}
    units = {
        key: unit
        for key, unit in units.items()
        if unit != named.get(key, "") and (named.get(key) or suffix(key) or not is_si(unit))
    }
    options = {
        "units": units,
        "start": choices.start,
        "missing": None if choices.missing == "refuse" else choices.missing,
        "wraps": list(choices.wraps),
        "decimate": choices.decimate,
        "between": None if choices.between is None else list(choices.between),
    }
    return table | {key: value for key, value in options.items() if value not in (None, {}, [])}


SET = (
    "file",
    "separator",
    "decimal",
    "time",
    "sampling",
    "columns",
    "units",
    "start",
    "missing",
    "wraps",
    "decimate",
    "between",
)
"""Keys that choices set, in the order in which they are written."""


def write(document: TOMLDocument, table: Mapping[str, Any], place: tuple[str | int, ...] = ("data",)) -> None:
    """Write the keys of a `[data]` table, as :func:`table_of` returns it, into a study; comments, order and other keys
    stay. ``place``: the table to write, ``("data",)``, or an experiment such as ``("experiments", 0)``. Keys that
    belong to another file, such as its trial, and deviations of channels that the data no longer have are removed.
    """
    if place == ("data",) and "data" not in document:
        document["data"] = tomlkit.table()
    here: Any = document
    for step in place:
        here = here[step]
    if here.get("file", table["file"]) != table["file"]:
        for key in OF_FILE:
            here.pop(key, None)
    for key in SET:
        if key not in table:
            here.pop(key, None)
        elif here.get(key) != table[key]:
            here[key] = _item(table[key])
    for channel in [name for name in here.get("deviations", {}) if name not in table["columns"]]:
        del here["deviations"][channel]
    if "deviations" in here and not here["deviations"]:
        del here["deviations"]


def _item(value: Any) -> Any:
    """A mapping as an inline table, anything else as it is."""
    if not isinstance(value, Mapping):
        return value
    inline: InlineTable = tomlkit.inline_table()
    inline.update(value)
    return inline


@dataclass(frozen=True)
class Fix:
    """What a button beside a problem does: ``change`` returns new choices from choices and the finding's values."""

    label: str
    change: Callable[[Choices, Mapping[str, Any]], Choices]


FIXES = {
    "late-times": Fix("Begin with the first sample", lambda choices, _: replace(choices, start="first")),
    "samples-before-start": Fix(
        "Leave them out", lambda choices, values: replace(choices, between=(0.0, float(values["last"])))
    ),
    "missing-values": Fix("Leave missing values out", lambda choices, _: replace(choices, missing="leave-out")),
    "angle-jumps": Fix(
        "Take whole turns as unknown",
        lambda choices, values: replace(choices, wraps=(*choices.wraps, values["channel"])),
    ),
    "suspect-degrees": Fix("Use deg", lambda choices, values: choices.with_unit(values["column"], values["unit"])),
    "no-number": Fix(
        "Take it as a missing value",
        lambda choices, values: replace(choices, missing=[*choices.absent, str(values["cell"])]),
    ),
    "many-samples": Fix("Decimate", lambda choices, values: replace(choices, decimate=int(values["factor"]))),
}
"""By the codes of findings, where a choice puts right what is wrong."""


def fix_of(finding: Finding) -> Fix | None:
    """The button beside a problem; None where nothing here can put it right."""
    handled = finding.code == "late-times" and finding.severity == "note"
    times = finding.code in ("missing-values", "no-number") and finding.values["times"]
    infinite = finding.code == "no-number" and is_number(str(finding.values["cell"]))
    uneven = finding.code == "many-samples" and not finding.values["even"]
    return None if handled or times or infinite or uneven else FIXES.get(finding.code)
