"""What sensors of a decay see, and how much noise they have."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dalembert.data import Measurements
from dalembert.errors import InputError, require_known
from dalembert.unit_table import readings
from dalembert.units import si_unit

Phasors = NDArray[np.complexfloating[Any, Any]]
"""Complex numbers of any shape."""
QUANTITIES = {"displacement": 0, "strain": 0, "velocity": 1, "acceleration": 2}
"""What sensors measure, and how many derivatives by time of the displacement that is."""
_BY_UNIT = {
    "m": "displacement", "rad": "displacement", "m/s": "velocity", "rad/s": "velocity", "m/s^2": "acceleration",
    "rad/s^2": "acceleration",
}  # fmt: skip


@dataclass(frozen=True)
class Sensors:
    """What sensors see. ``orders``: derivatives by time of the displacement, 0, 1 or 2; ``deviations`` of their noise;
    both (channels,).
    """

    orders: tuple[int, ...]
    deviations: np.ndarray

    @cached_property
    def groups(self) -> dict[int, list[int]]:
        """Channels by what they see: those of a group have the same columns."""
        return {
            order: [channel for channel, seen in enumerate(self.orders) if seen == order]
            for order in sorted({*self.orders})
        }


def quantity_of(data: Measurements, name: str, quantity: str | Mapping[str, str] | None) -> tuple[int, str]:
    """Derivatives by time that a channel sees, and the unit of its displacement: as stated, or by its unit."""
    units = list(map(si_unit, readings(data.source_units.get(name, ""))))
    word = quantity if isinstance(quantity, str) else (quantity or {}).get(name)
    if word is None:
        word = next((_BY_UNIT[unit] for unit in units if unit in _BY_UNIT), None)
    if word is None:
        raise InputError(
            f"ring_down: channel {name!r} may measure a displacement, a velocity, an acceleration or a strain. "
            f"Say which, for example quantity={{{name!r}: 'acceleration'}}"
        )
    require_known("quantity", word, QUANTITIES, "ring_down")
    angle = any(unit.startswith("rad") for unit in units[:1])
    return QUANTITIES[word], "" if word == "strain" else "rad" if angle else "m"
