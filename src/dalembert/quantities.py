"""What a channel measures, and in which unit, read from the last word of its name."""

import re
from collections.abc import Iterable, Sequence
from typing import TypeVar

from dalembert.tables import labelled
from dalembert.units import unit_of

Label = TypeVar("Label")
SIZE = re.compile(r"(?P<dof>.+) (?P<kind>peak|rms|harmonic \d+)")
"""Channels of responses over frequency."""
AXES = "xyz"
QUANTITIES = {
    **dict.fromkeys(AXES, ("position", "m")),
    "length": ("length", "m"),
    "angle": ("angle", "rad"),
    **dict.fromkeys(("roll", "pitch", "yaw"), ("angle", "rad")),
    **{f"rotation_{axis}": ("rotation vector", "rad") for axis in AXES},
    **{f"q{number}": ("quaternion", "") for number in range(4)},
    "displacement": ("displacement", "m"),
    **{f"v{axis}": ("velocity", "m/s") for axis in AXES},
    "speed": ("velocity", "m/s"),
    "rate": ("angular rate", "rad/s"),
    **{f"w{axis}": ("angular rate", "rad/s") for axis in AXES},
    **{f"a{axis}": ("acceleration", "m/s²") for axis in AXES},
    **{f"w{axis}_rate": ("angular acceleration", "rad/s²") for axis in AXES},
    "acceleration": ("angular acceleration", "rad/s²"),
    "force": ("force", "N"),
    **{f"force_{axis}": ("force", "N") for axis in (*AXES, *"123")},
    "torque": ("torque", "N m"),
    **{f"torque_{axis}": ("torque", "N m") for axis in (*AXES, *"123")},
    "kinetic_energy": ("energy", "J"),
    "potential_energy": ("energy", "J"),
    "total_energy": ("energy", "J"),
}


def size_label(kind: str) -> str:
    """Return the name of a kind of amplitude on an axis.
    >>> size_label("peak"), size_label("rms"), size_label("harmonic 1")
    ('amplitude', 'rms', 'amplitude of harmonic 1')
    """
    return {"peak": "amplitude", "rms": "rms"}.get(kind, f"amplitude of {kind}")


def quantity(channel: str, unit: str = "") -> str:
    """Return the axis label of a channel, with ``unit`` where its name does not determine one.
    >>> quantity("AB.end.x"), quantity("gauge 7", "V"), quantity("A.rx harmonic 1")
    ('position (m)', 'response (V)', 'amplitude of harmonic 1 (rad)')
    """
    return labelled(*_known(channel, unit))


def unit(channel: str, default: str = "") -> str:
    """Return the unit of a channel, ``default`` where its name does not determine one."""
    return _known(channel, default)[1]


def derivative(channel: str, along: str, unit: str = "") -> str:
    """Axis label of a channel's derivative by something that has the unit ``along``.

    Examples
    --------
    >>> derivative("AB.end.x", "rad"), derivative("AB.end.x", ""), derivative("gauge 7", "rad")
    ('derivative (m/rad)', 'derivative (m)', 'derivative')
    """
    unit_here = _known(channel, unit)[1]
    return labelled("derivative", f"{unit_here}/{along}" if unit_here and along else unit_here)


def _known(channel: str, unit: str) -> tuple[str, str]:
    size = SIZE.fullmatch(channel)
    if size:
        return size_label(size["kind"]), unit_of(size["dof"])
    return QUANTITIES.get(channel.rpartition(".")[2], ("response", unit))


def common(labels: Iterable[Label], otherwise: Label) -> Label:
    """Return the label that all have, such as that of an axis that they share; ``otherwise`` where they differ."""
    known = set(labels)
    return known.pop() if len(known) == 1 else otherwise


def by_quantity(channels: Sequence[str], most: int = 4) -> list[list[str]]:
    """Return groups of channels that may share an axis: one quantity each, ``most`` channels at most."""
    groups: dict[str, list[str]] = {}
    for channel in channels:
        groups.setdefault(quantity(channel), []).append(channel)
    return [group[first : first + most] for group in groups.values() for first in range(0, len(group), most)]
