"""Free vibrations of a structure: pictures of the modes and a table of their frequencies."""

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.charts.frequency.mode_shapes import MOST
from dalembert.report.digits import shown
from dalembert.report.headline import MOST_VALUES, Headline
from dalembert.report.registry import sections_of
from dalembert.report.section import Fold, Plot, Section
from dalembert.report.table import Table
from dalembert.structure import ModeShapes


@sections_of(ModeShapes)
def mode_shapes(modes: ModeShapes, asked: Asked) -> list[Section]:
    """The modes."""
    numbers = range(1, len(modes.frequencies) + 1)
    how = "The slider goes through the modes; thin lines: at rest; dark: nodal lines."
    if len(numbers) > MOST:
        how += f" Drawn are the first {MOST}."
    lowest = zip(numbers, modes.frequencies[:MOST_VALUES], strict=False)
    headline = Headline(
        title="Modes",
        verdict="computed",
        status=f"{len(numbers)} natural frequencies and shapes of the undamped structure.",
        facts={f"mode {number}": f"{shown(float(frequency))} Hz" for number, frequency in lowest},
    )
    table = Table.of("modes", "Natural frequencies", {"mode": numbers, "frequency (Hz)": modes.frequencies})
    return [headline, Section("Mode shapes", (Plot("mode-shapes", charts.mode_shapes(modes), how), Fold(table)))]
