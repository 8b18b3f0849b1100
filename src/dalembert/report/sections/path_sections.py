"""Paths of equilibria: channels over the load, critical points, and the mechanism along the path."""

from dalembert.multibody import EquilibriumPath
from dalembert.quantities import by_quantity
from dalembert.report import charts
from dalembert.report.headline import headline_of
from dalembert.report.look import plain
from dalembert.report.options import ReportOptions
from dalembert.report.registry import sections_of
from dalembert.report.section import Motion, Plot, Section

HOW = "Solid: stable equilibria; dashed: unstable ones. Circles: limit points; diamonds: branch points."


@sections_of(EquilibriumPath)
def equilibrium_path(path: EquilibriumPath, options: ReportOptions) -> list[Section]:
    """Channels over the load, critical points, the mechanism at equilibria, and a table of all of them."""
    plots = [
        Plot(f"equilibrium-path-{place}", charts.equilibrium_path(path, group, title=", ".join(map(plain, group))), HOW)
        for place, group in enumerate(by_quantity(path.names), start=1)
    ]
    sections = [headline_of(path), Section("Equilibria over the load", (*plots, *path.tables()))]
    if path.build is not None:
        film = charts.equilibria(path)
        turned = " Drag to turn, scroll to zoom." if film.scene.dimensions == 3 else ""
        how = f"Drawn to scale. The slider goes along the path; faint outlines are equilibria on it.{turned}"
        sections.insert(1, Section("Mechanism", (Motion("mechanism", film, how),)))
    return sections
