"""Values of parameters, written into the text of a study."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from dalembert.errors import InputError
from dalembert.studio.editor.entries import first_guess, like, put, table_at, unit_among


@dataclass(frozen=True)
class _Home:
    """Where a study describes a parameter: ``table`` has it as ``key``. ``usual`` has the numbers that the parameter
    has if the table does not give them.
    """

    table: Any
    key: str
    usual: Mapping[str, Any]

    def like(self, name: str, value: float) -> str | float:
        """The value with the unit of the number that it replaces, or of a bound."""
        given = self.given
        return like(given.get(name, given["lower"]), value, given)

    @property
    def given(self) -> dict[str, Any]:
        """All numbers of the parameter."""
        return {**self.usual, **table_at(self.table, self.key)}


def unit_in(document: Any, name: str) -> tuple[str, float]:
    """Return the unit in which a study writes a parameter, and its size in SI units; ``("", 1.0)`` without one."""
    sensor = _sensor(document, name)
    try:
        return unit_among(sensor[name.rpartition(" ")[2]] if sensor else _home(document, name).given.values())
    except InputError:
        return "", 1.0


def use_as_start(document: Any, values: Mapping[str, float]) -> None:
    """Write values by name (SI units) as first guesses of parameters; those of sensors have none, and are left out."""
    sensors = [name for name in values if _sensor(document, name)]
    if values and len(sensors) == len(values):
        raise InputError(
            f"{sensors[0]} has no first guess: [sensors] gives bounds only. Choose 'Use as value', or reset it."
        )
    for name in values.keys() - sensors:
        home = _home(document, name)
        put(home.table, home.key, start=first_guess(values[name], home.given))


def use_as_value(document: Any, name: str, value: float) -> None:
    """Fix a parameter at a value (SI units): both bounds become equal, and the other numbers are left out."""
    sensor = _sensor(document, name)
    if sensor is not None:
        what = name.rpartition(" ")[2]
        lower, upper = sensor[what]
        sensor[what] = [like(lower, value, {"upper": upper})] * 2
        return
    home = _home(document, name)
    if home.key == "start":  # a time that is known
        home.table["start"] = home.like("lower", value)
        return
    bound = home.like("lower", value)
    put(home.table, home.key, lower=bound, upper=bound, start=bound if "start" in home.usual else None, deviation=None)


def _home(document: Any, name: str) -> _Home:
    """Where a parameter of the study, or of one experiment, is described."""
    from dalembert.forward.sensors import START

    shared = table_at(document, "parameters")
    if name in shared:
        return _Home(document["parameters"], name, {})
    if name == START and "data" in document:
        return _Home(document["data"], "start", {})
    for table in document.get("experiments", ()):
        experiment = f"{table.get('name')}."
        if name == experiment + START:
            return _Home(table, "start", {})
        local_name = name.removeprefix(experiment)
        if local_name in table.get("local", ()) and local_name in shared:
            if not hasattr(table["local"], "items"):
                locals_ = list(table["local"])
                table["local"] = {}
                for local in locals_:
                    put(table["local"], local)
            return _Home(table["local"], local_name, shared[local_name])
    raise InputError(f"{name!r} is not described by a table of the study. Change the text where its value comes from.")


def _sensor(document: Any, name: str) -> Any:
    """The table of the sensor that a parameter belongs to; None for another parameter."""
    from dalembert.forward.sensors import QUANTITIES

    sensor, _, what = name.rpartition(" ")
    return document["sensors"][sensor] if what in QUANTITIES and sensor in table_at(document, "sensors") else None
