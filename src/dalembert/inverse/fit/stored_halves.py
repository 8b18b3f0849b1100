"""The halves of the records as variables of a dataset, and back."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from dalembert.inverse.misfit.halves import Halves

NAMES = ("values", "deviations")


def stored_halves(found: Halves | None) -> dict[str, Any]:
    """Variables over ``half`` and ``parameter``; none without halves."""
    if found is None:
        return {}
    both = {f"half_{name}": (("half", "parameter"), getattr(found, name)) for name in NAMES}
    return {**both, "half_differences": ("parameter", found.differences)}


def halves_of(arrays: Mapping[str, np.ndarray], refitted: bool | None) -> Halves | None:
    """The halves again; ``refitted`` is None where there are none."""
    if refitted is None:
        return None
    values, deviations = (arrays[f"half_{name}"] for name in NAMES)
    return Halves(values, deviations, arrays["half_differences"], refitted)
