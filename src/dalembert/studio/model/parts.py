"""Which table of a study's text each part of the drawing of its model comes from."""

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any

from dalembert.studio.editor.lines import Place, is_within

if TYPE_CHECKING:
    from dalembert.study import Study

STRUCTURE = {"mass": "body", "spring": "spring", "rotor": "rotor", "force": "force", "contact": "contact"}
"""Roles in the drawing of the tables of a structure."""


def places_of(study: "Study") -> dict[str, Place]:
    """Return the places of the tables of parts by their roles and names in the drawing: ``"body rod"``.

    The empty name is that of all other parts: those that a function, or a robot's file, describes.
    """
    model = study.file.model
    other = "robot" if model.robot_table is not None else "function" if model.function is not None else "structure"
    places: dict[str, Place] = {"": ("model", other), "gravity gravity": ("model", "gravity")}
    for table in ("body", "joint", "load"):
        places |= {
            f"{table} {part.name}": ("model", table, number) for number, part in enumerate(getattr(model, table))
        }
    places |= {f"sensor {name}": ("sensors", name) for name in study.file.sensors}
    places |= {f"input {name}": ("inputs", name) for name in study.file.inputs}
    for table, role in STRUCTURE.items():
        for number, part in enumerate(getattr(model, table)):
            names = [f"{role} {name}" for name in _names(table, part)]
            free = [name for name in names if name not in places] or [f"{names[0]} ({number + 1})"]
            places |= dict.fromkeys(free, ("model", table, number))
    channels = shown_channels(study)
    places |= {f"measured {name.rpartition('.')[0]}": _channel_place(study, name) for name in channels}
    return places | {f"channel {channel}": _channel_place(study, channel) for channel in channels}


def place_of(places: Mapping[str, Place], part: str) -> Place:
    """Return the place of a part of the drawing."""
    return places.get(part) or places.get("", ("model",))


def parts_at(places: Mapping[str, Place], place: Place | None, drawn: Collection[str] = ()) -> list[str]:
    """Return the parts whose tables a place lies in, or that lie in it: all joints in ``("model", "joint")``. In the
    table of a robot or a function these are the drawn parts without tables: the one that a key names, or all.
    """
    if place is None or len(place) < 2:
        return []
    names = [name for name, table in places.items() if name and (is_within(place, table) or is_within(table, place))]
    other = places.get("")
    if names or other is None or not is_within(place, other):
        return names
    loose = [part for part in dict.fromkeys(drawn) if part not in places and part.partition(" ")[2]]
    key = str(place[-1])
    return [part for part in loose if part.partition(" ")[2] in (key, key.rpartition(".")[0])] or loose


def absent_parts(places: Mapping[str, Place], drawn: Collection[str]) -> list[str]:
    """Return parts of the model that have tables and are not drawn; one of those that share a table."""
    shown = {place for part, place in places.items() if part in drawn and not part.startswith("channel ")}
    absent = {
        part if part.startswith("channel ") else place: part
        for part, place in reversed([*places.items()])
        if part not in ("", "gravity gravity") and part not in drawn and place not in shown
        if not part.startswith("measured ")
    }
    return [part for part in places if part in absent.values()]


def shown_channels(study: "Study") -> list[str]:
    """Return the channels of the data, and those that the task names or observes."""
    from dalembert.study.tables.experiments import measured_channels

    table = study.table
    named = [*(getattr(table, "channels", None) or ()), *(getattr(table, "observe", None) or ())]
    return list(dict.fromkeys([*measured_channels(study.file), *(name for name in named if isinstance(name, str))]))


def _channel_place(study: "Study", channel: str) -> Place:
    file = study.file
    if file.data is not None and channel in file.data.channels:
        return ("data",)
    for number, table in enumerate(file.experiments):
        if channel in table.channels:
            return ("experiments", number)
    return (study.task, "channels" if channel in (getattr(study.table, "channels", None) or ()) else "observe")


def _names(table: str, part: Any) -> list[str]:
    """Names that the drawing of a structure gives to what a table describes."""
    if table == "rotor":
        return [f"{part.first} – {part.second}"]
    if table == "force":
        dofs = [dof for key in ("dof", "first", "second") if (dof := getattr(part, key, None)) is not None]
        return [name for dof in dofs for name in (dof, f"{dof}.x")] or [part.direction]
    if table == "spring" and not hasattr(part, "name"):
        ends = part.first, part.second
        first, second = ("ground" if end is None else end.rpartition(".")[0] or end for end in ends)
        return [f"{first} – {second}", f"{second} – {first}"]
    return [part.name]
