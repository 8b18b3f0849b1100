"""Small global sensitivity analyses that provoke the sentences and figures of their reports."""

import numpy as np

import dalembert as da
from dalembert.surrogate import TotalDegree
from report_case import Case
from small_models import DECAY, TIMES


def _fragile(size: float, rate: float) -> np.ndarray:
    if size > 2.18:
        raise RuntimeError("too large")
    return size * np.exp(-rate * TIMES)


SENSITIVITY_CASES = {
    "indices of two parameters": Case(
        lambda: da.global_sensitivity(DECAY, {"size": (1.8, 2.2), "rate": da.Normal(0.8, 0.1)}),
        (
            "The indices of whole channels are uncertain by at most",
            "Each area is the part of the variance that a parameter causes alone.",
            "Solid: first-order index. Dotted: total index",
            "Parts of the variance of whole channels",
            "Normal(mean=0.8, deviation=0.1)",
        ),
        ("indices-1", "shares-1"),
    ),
    "indices of one sample": Case(
        lambda: da.global_sensitivity(
            da.PythonModel(lambda a, idle: np.array([a**2 + 0 * idle]), {"a": (0, 1), "idle": (0, 1)}, ["y"], TIMES[:1])
        ),
        (
            "A total index contains interactions.",
            "The total indices of these parameters are below 0.01 in all channels: idle.",
            "They may be fixed within their intervals.",
        ),
        ("indices-1",),
    ),
    "indices of a constant channel": Case(
        lambda: da.global_sensitivity(
            da.PythonModel(
                lambda a: np.stack([a * TIMES, 0 * a * TIMES + 1.0], axis=1), {"a": (0, 1)}, ["x", "y"], TIMES
            )
        ),
        (
            "The response of 'y' is constant: it has no indices.",
            "or widen the intervals.",
            "Samples without indices, where the response does not vary:",
            "The indices there are NaN.",
        ),
    ),
    "indices where runs fail": Case(
        lambda: da.global_sensitivity(
            da.PythonModel(_fragile, DECAY.parameters, ["x"], TIMES),
            {"size": (1.8, 2.2), "rate": (0.7, 0.9)},
            TotalDegree(4, oversampling=4),
        ),
        ("runs failed and were left out, the first: RuntimeError: too large", "Narrow the intervals to where"),
    ),
    "a screening": Case(
        lambda: da.screen(
            da.PythonModel(
                lambda a, b, idle: a * b * TIMES + 0 * idle, dict.fromkeys(("a", "b", "idle"), (0, 1)), ["x"], TIMES
            ),
            trajectories=6,
        ),
        (
            "The parameters are ranked by 6 trajectories, 24 simulations.",
            "Right: a large effect. Up: the effect depends on the other parameters or is not linear.",
            "The effects of these parameters are below 5 % of the largest one in all channels: idle.",
            "Effects on whole channels, over the whole intervals",
        ),
        ("effects-1",),
    ),
}
