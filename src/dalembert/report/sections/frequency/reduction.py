"""What a reduction changes: the modes of the reduced structure beside those of the full one."""

import numpy as np

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.digits import counted, percent, shown
from dalembert.report.headline import Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Section
from dalembert.report.table import Table, cells
from dalembert.structure import ReductionErrors


@sections_of(ReductionErrors)
def reduction_errors(errors: ReductionErrors, asked: Asked) -> list[Section]:
    """The errors of frequencies and shapes."""
    headline = Headline(
        title="Reduction",
        verdict="compared",
        status="The lowest modes of the reduced structure beside those of the full one.",
        facts={
            "modes compared": counted(len(errors.full)),
            "largest error of a frequency": percent(np.max(errors.relative)),
            "least similarity of a shape": shown(float(np.min(errors.similarity)), digits=4),
        },
    )
    return [headline, reduced(errors)]


def reduced(errors: ReductionErrors) -> Section:
    """The section on a reduction."""
    told = f"The lowest {len(errors.full)} frequencies of the reduced structure are at most "
    told += f"{percent(np.max(errors.relative), 2)} too high, and their shapes are similar by "
    told += f"{shown(float(np.min(errors.similarity)), digits=4)} and more."
    columns = {
        "mode": range(1, len(errors.full) + 1),
        "full (Hz)": errors.full,
        "reduced (Hz)": errors.reduced,
        "error (%)": cells(100 * np.asarray(errors.relative), 3),
        "similarity of the shapes": errors.similarity,
    }
    plot = Plot("reduction-errors", charts.reduction_errors(errors), "What is zero to rounding is not drawn.")
    table = Table.of("reduction", "Modes of the full and the reduced structure", columns)
    return Section("Reduction", (told, plot, Fold(table)))
