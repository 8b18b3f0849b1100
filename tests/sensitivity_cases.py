"""A small global sensitivity analysis that provokes the sentences and figures of its report."""

import dalembert as da
from report_case import Case
from small_models import DECAY

SENSITIVITY_CASES = {
    "indices of two parameters": Case(
        lambda: da.global_sensitivity(DECAY, {"size": (1.8, 2.2), "rate": (0.7, 0.9)}),
        (
            "Each area is the part of the variance that a parameter causes alone.",
            "Parts of the variance of whole channels",
            "first-order index",
        ),
        ("shares-1",),
    ),
}
