"""The bias by the integrator as variables of a dataset, and back."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from dalembert.inverse.fit.integration import IntegrationBias

NUMBERS = ("fitness", "corrected", "remainder")


def stored_integration(found: IntegrationBias | None) -> dict[str, Any]:
    """A variable over ``parameter`` and one over nothing for each number; none without an estimate."""
    if found is None:
        return {}
    numbers = {f"integration_{name}": ((), np.float64(getattr(found, name))) for name in NUMBERS}
    return {"integration_bias": ("parameter", found.bias), **numbers}


def integration_of(arrays: Mapping[str, np.ndarray], how: str | None) -> IntegrationBias | None:
    """The bias again; ``how`` is None where there is none."""
    if how is None:
        return None
    numbers = (float(arrays[f"integration_{name}"]) for name in NUMBERS)
    return IntegrationBias(how, arrays["integration_bias"], *numbers)
