"""An identification from bands as text."""

from dalembert.inverse.bands.band_fit import BandFit
from dalembert.inverse.fit.summary import table
from dalembert.results import fixed_lines


def summary(fit: BandFit) -> str:
    """Table of intervals with middle, radius, their deviations, unit and bounds; then fitness, effort and status."""
    rows: list[tuple[str, ...]] = [("parameter", "interval", "middle", "±", "radius", "±", "unit", "bounds")]
    for k, item in enumerate(fit.parameters):
        known = item.name in fit.intervals
        rows.append(
            (
                item.name,
                f"[{fit.box.lower[k]:.7g}, {fit.box.upper[k]:.7g}]",
                f"{fit.middle[k]:.7g}",
                f"{fit.middle_deviations[k]:.2g}",
                f"{fit.radius[k]:.5g}" if known else "0 (given)",
                f"{fit.radius_deviations[k]:.2g}" if known else "",
                item.unit,
                f"{item.lower:.6g} to {item.upper:.6g}",
            )
        )
    checked = "not checked" if fit.checked_fitness is None else f"{fit.checked_fitness:.6g} by true runs"
    facts = [
        f"method       {fit.method}",
        f"fitness      {fit.fitness:.6g} (weighted sum of squares of {2 * fit.lower.size} bounds), {checked}",
        f"simulations  {fit.simulations}",
        f"seconds      {fit.seconds:.2g}",
        f"starts       {len(fit.starts)}",
        *fixed_lines(fit),
    ]
    return "\n".join(
        [*table(rows), "", *facts, "", fit.status, *fit.identifiability().sentences, *map(str, fit.findings)]
    )
