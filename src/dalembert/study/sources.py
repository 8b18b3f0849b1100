"""What the files of a study's data were taken to be, and the units of their columns."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from dalembert.study.tables.study import Study

if TYPE_CHECKING:
    from dalembert.data import Measurements


def source_lines(study: Study) -> Iterator[str]:
    """Yield a line on each file of measured data, with the layout of text, and lines on units and inputs."""
    tables = study.file.experiments or ([] if study.file.data is None else [study.file.data])
    read = [table.read() for table in tables]
    origins = (origin for data in read for origin in data.origin.split("; "))
    yield from (f"Data: {origin}" for origin in dict.fromkeys(origins))
    yield from dict.fromkeys(_units(data) for data in read)
    for name, measured in study.inputs.items():
        yield f"Input {name}: {measured.unit or 'no unit is given, read in SI units'}"


def _units(data: "Measurements") -> str:
    """Return the units in which channels were read, in a sentence.
    >>> from dalembert.data import Measurements
    >>> _units(Measurements((0.0, 1.0), ("a.x", "a.y"), [[0, 1], [2, 3]], source_units={"a.x": "mm", "time": "ms"}))
    'Units: time in ms, a.x in mm; no unit is given for a.y, read in SI units'
    """
    named = ", ".join(f"{name} in {data.source_units[name]}" for name in _labels(data) if name in data.source_units)
    plain = ", ".join(name for name in _labels(data) if name not in data.source_units)
    rest = f"no unit is given for {plain}, read in SI units" if plain else ""
    return "Units: " + "; ".join(filter(None, (named, rest)))


def _labels(data: "Measurements") -> tuple[str, ...]:
    return (data.coordinate.name, *data.channels)
