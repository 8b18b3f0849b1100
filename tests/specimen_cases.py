"""Small populations of specimens that provoke the sentences and figures of their reports."""

import dalembert as da
from report_case import Case
from small_models import DECAY, measured


def _population(rates: list[float]) -> da.Population:
    fits = {
        f"part {number}": da.identify(DECAY, measured(DECAY, [2.0, rate], 0.02, number, deviations=0.02), starts=1)
        for number, rate in enumerate(rates, start=1)
    }
    return da.population(fits)


def _joint() -> tuple[da.Fit, dict[str, da.Population]]:
    """A fit of three specimens, and beside it their population."""
    experiments = [
        da.Experiment(f"part {k}", DECAY, measured(DECAY, [2.0, rate], 0.02, k, deviations=0.02), local=("rate",))
        for k, rate in enumerate((0.8, 1.0, 1.3))
    ]
    fit = da.identify(experiments, starts=1)
    return fit, {"population": da.population(fit)}


SPECIMEN_CASES = {
    "few specimens": Case(
        lambda: _population([0.8, 1.0, 1.1, 1.3]),
        (
            "There are 4 specimens. Their spread is uncertain.",
            "Measure at least 6 specimens, or use the upper ends of the spreads.",
            "The specimens do not differ in size by more than the deviations of their fits explain.",
            "The band contains a new specimen with 95 %. Bars are two standard deviations.",
            "Mean over specimens, and standard deviation between them",
            "Values of the specimens, and adjusted by what is known of the others",
        ),
        ("specimens-1", "specimens-2"),
    ),
    "a fit of specimens": Case(
        _joint,
        ("There are 3 specimens. Their spread is uncertain.", "Values of the specimens, and adjusted"),
        ("specimens-1",),
    ),
}
