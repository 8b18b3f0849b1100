"""Parameters that differ between the first and the second half of the records."""

from collections.abc import Iterator

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum


def parameter_drift(optimum: Optimum) -> Iterator[Finding]:
    """Yield a finding where the halves have different parameters."""
    halves = optimum.causes.halves
    if halves is None or not np.any(halves.drifting):
        return
    items = optimum.problem.model.parameters.items
    worst = int(np.nanargmax(np.abs(halves.differences)))
    name, size = items[worst].name, abs(float(halves.differences[worst]))
    first, second = (f"{value:.4g} {items[worst].unit}".rstrip() for value in halves.values[:, worst])
    also = [repr(item.name) for k, item in enumerate(items) if halves.drifting[k] and k != worst]
    more = f" Also different: {', '.join(also)}." if also else ""
    values = {
        "parameter": name,
        "first": float(halves.values[0, worst]),
        "second": float(halves.values[1, worst]),
        "deviations": size,
    }
    message = (
        f"The two halves of the record have different parameters: {name!r} is {first} in the first and {second} in the "
        f"second half, {size:.3g} standard deviations apart.{more}"
    )
    advice = "Look for what changes with time or amplitude, such as friction or a nonlinear stiffness."
    yield Finding("parameters-drift", "warning", values, message, advice)
