"""Columns of a measurement data file (MDF 3 and 4) of ASAM."""

from pathlib import Path

import numpy as np

from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.guarded import guarded
from dalembert.data.opening import reading, require
from dalembert.errors import DataError, unknown

TIME = "t"


class Mdf(Format):
    """MDF of ASAM: channels by name along ``t``; ``group/channel`` where several have one name."""

    name = "mdf"
    suffixes = (".mf4", ".mdf")

    def columns(self, path: Path, request: Request) -> Columns:
        signals = _signals(path)
        wanted = request.labels
        for name in wanted or ():
            if name not in signals and name != TIME:
                raise DataError(unknown("column", name, [TIME, *signals], str(path)))
        picked = {name: signal for name, signal in signals.items() if wanted is None or name in wanted}
        first = next(iter(picked.values()), None)
        if first is None:
            raise DataError(f"{path}: the file has no channel of numbers")
        picked = {name: signal for name, signal in picked.items() if wanted is not None or _same_times(signal, first)}
        for name, signal in picked.items():
            if not _same_times(signal, first):
                raise DataError(
                    f"{path}: the channels {next(iter(picked))!r} and {name!r} have different times; read each by "
                    "itself (more in a study), and merge them"
                )
        arrays = {TIME: first[0], **{name: values for name, (_, values, _) in picked.items()}}
        along, columns, dated = chosen(path, arrays, request.along, wanted, request.missing)
        units = {name: unit for name, (_, _, unit) in picked.items() if unit}
        return Columns(path, request.along or "sample", along, columns, units | dated)

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        signals = _signals(path)
        times = next((along for along, _, _ in signals.values()), np.zeros(0))
        arrays = {TIME: (times, "")} | {name: (values, unit) for name, (_, values, unit) in signals.items()}
        numbers = of_numbers({name: array for name, (array, _) in arrays.items()})
        return {name: (array, arrays[name][1]) for name, array in numbers.items()}


Signal = tuple[np.ndarray, np.ndarray, str]


def _same_times(first: Signal, second: Signal) -> bool:
    return np.array_equal(first[0], second[0])


def _signals(path: Path) -> dict[str, Signal]:
    """Times, values and unit of each channel of numbers, in physical values.

    Another process reads them, since the reader breaks down over damaged files.
    """
    with reading(path, "MDF"):
        require("asammdf", path, "MDF files", "mdf")
        return guarded(path, "MDF", __name__, "signals_in")


def signals_in(path: str) -> dict[str, Signal]:
    """Return times, values and unit of each channel of numbers, in physical values."""
    from asammdf import MDF

    with MDF(path) as file:
        signals = list(file.iter_channels(skip_master=True))
    names = [signal.name for signal in signals]
    channels: dict[str, Signal] = {}
    for signal in signals:
        label = signal.name if names.count(signal.name) == 1 else f"{signal.group_index}/{signal.name}"
        values = np.asarray(signal.samples)
        if values.dtype.kind in "fiu" and values.ndim == 1 and len(values):
            channels[label] = np.asarray(signal.timestamps, dtype=float), values, str(signal.unit or "")
    return channels
