"""Which table of a study's text each part of the drawing of its model comes from."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from dalembert.studio.editor.lines import Place, is_within

if TYPE_CHECKING:
    from dalembert.study import Study

STRUCTURE = {"mass": "body", "spring": "spring", "force": "force", "contact": "contact"}
"""Roles in the drawing of the tables of a structure."""


def places_of(study: "Study") -> dict[str, Place]:
    """Return the places of the tables of parts by their roles and names in the drawing: ``"body rod"``.

    The empty name is that of all other parts: those that a function, or a robot's file, describes.
    """
    model = study.file.model
    other = "robot" if model.robot_table is not None else "function" if model.function is not None else "structure"
    found: dict[str, Place] = {"": ("model", other), "gravity gravity": ("model", "gravity")}
    for table in ("body", "joint", "load"):
        found |= {f"{table} {part.name}": ("model", table, number) for number, part in enumerate(getattr(model, table))}
    for table, role in STRUCTURE.items():
        for number, part in reversed(list(enumerate(getattr(model, table)))):
            found |= {f"{role} {name}": ("model", table, number) for name in _names(table, part)}
    return found | {f"channel {channel}": _channel_place(study, channel) for channel in shown_channels(study)}


def place_of(places: Mapping[str, Place], part: str) -> Place:
    """Return the place of a part of the drawing."""
    return places.get(part) or places.get("", ("model",))


def parts_at(places: Mapping[str, Place], place: Place | None) -> list[str]:
    """Return the parts whose tables a place lies in, or that lie in it: all joints in ``("model", "joint")``.

    Examples
    --------
    >>> parts_at({"body rod": ("model", "body", 0), "joint pin": ("model", "joint", 0)}, ("model", "body", 0, "mass"))
    ['body rod']
    """
    if place is None or len(place) < 2:
        return []
    return [name for name, table in places.items() if name and (is_within(place, table) or is_within(table, place))]


def shown_channels(study: "Study") -> list[str]:
    """Return the channels of the data, and those that the task names."""
    from dalembert.study.experiments import measured_channels

    task = getattr(study.table, "channels", None) or ()
    return list(dict.fromkeys([*measured_channels(study.file), *(name for name in task if isinstance(name, str))]))


def _channel_place(study: "Study", channel: str) -> Place:
    file = study.file
    if file.data is not None and channel in file.data.channels:
        return ("data",)
    for number, table in enumerate(file.experiments):
        if channel in table.channels:
            return ("experiments", number)
    return (study.task, "channels")


def _names(table: str, part: Any) -> list[str]:
    """Names that the drawing of a structure gives to what a table describes."""
    if table == "force":
        return [part.dof, f"{part.dof}.x"]
    if table == "spring" and not hasattr(part, "name"):
        first, second = (_node(end) for end in (part.first, part.second))
        return [f"{first} – {second}", f"{second} – {first}"]
    return [part.name]


def _node(end: str | None) -> str:
    return "ground" if end is None else end.rpartition(".")[0] or end
