"""Columns of a TDMS file of LabVIEW."""

from pathlib import Path

import numpy as np

from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.opening import library, reading

TIME = "t"
"""Column of the times that the properties of a waveform give, where no channel has this name."""


class Tdms(Format):
    """TDMS of LabVIEW: channels by name, or ``group/channel`` where several groups have one of this name."""

    name = "tdms"
    suffixes = (".tdms",)

    def columns(self, path: Path, request: Request) -> Columns:
        arrays, units = _columns(path)
        along, columns, dated = chosen(path, arrays, request.along, request.labels, request.missing)
        named = {name: unit for name, unit in units.items() if name in columns or name == request.along}
        return Columns(path, request.along or "sample", along, columns, named | dated)

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        arrays, units = _columns(path)
        return {name: (array, units.get(name, "")) for name, array in of_numbers(arrays).items()}


def _columns(path: Path) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    with reading(path, "TDMS"):
        nptdms = library("nptdms", path, "TDMS files", "tdms", "npTDMS")
        file = nptdms.TdmsFile.read(path)
        channels = [channel for group in file.groups() for channel in group.channels() if len(channel)]
        names = [channel.name for channel in channels]
        arrays: dict[str, np.ndarray] = {}
        units: dict[str, str] = {}
        for channel in channels:
            label = channel.name if names.count(channel.name) == 1 else f"{channel.group_name}/{channel.name}"
            arrays[label] = np.asarray(channel[:])
            if unit := str(channel.properties.get("unit_string", channel.properties.get("NI_UnitDescription", ""))):
                units[label] = unit
        waves = {
            (channel.properties.get("wf_start_offset", 0.0), channel.properties["wf_increment"], len(channel))
            for channel in channels
            if channel.properties.get("wf_increment")
        }
        if len(waves) == 1 and TIME not in arrays:
            ((begin, step, count),) = waves
            arrays[TIME] = begin + step * np.arange(count)
    return arrays, units
