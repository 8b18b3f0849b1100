"""The harmonics of the motion, and whether enough of them are kept."""

from dalembert.report import charts
from dalembert.report.charts.frequency.harmonic_content import by_order
from dalembert.report.digits import percent
from dalembert.report.focus import Look
from dalembert.report.quantities import labelled
from dalembert.report.section import Fold, Plot, Section
from dalembert.report.table import Table, cells
from dalembert.units import unit_of

ENOUGH = 1e-2
"""Size of the last harmonics at the peak, as part of the largest, above which more of them should be kept."""


def harmonics(look: Look) -> Section:
    """Amplitude of each harmonic over frequency, and at the peak."""
    sizes = {order: float(size[look.point]) for order, size in by_order(look.curve, look.dof).items()}
    most = max(sizes.values())
    columns = {
        "part of the motion": ["mean" if order == 0 else f"harmonic {order}" for order in sizes],
        labelled("amplitude", unit_of(look.dof)): sizes.values(),
        "of the largest (%)": cells((100 * size / most if most else 0.0 for size in sizes.values()), 3),
    }
    how = "Harmonics that stay below a millionth of the largest are left out."
    plot = Plot("harmonic-content", charts.harmonic_content(look.curve, look.dof), how)
    table = Table.of("harmonics", f"Harmonics of {look.dof} at its peak", columns)
    return Section("Harmonics", (_enough(sizes, most), plot, Fold(table)))


def _enough(sizes: dict[int, float], most: float) -> str:
    """Whether the last harmonics are small; empty where there is nothing to say."""
    higher = [size for order, size in sizes.items() if order > 1]
    if most <= 0 or not higher:
        return ""
    last = max(higher[-2:])
    part = f"{percent(last / most, 2)} of the largest one"
    if last > ENOUGH * most:
        return f"At the peak the last two harmonics kept still reach {part}; keep more harmonics."
    return f"At the peak the last two harmonics kept are at most {part}."
