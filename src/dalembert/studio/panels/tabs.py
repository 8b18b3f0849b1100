"""Panels beside a text, each with a tab."""

from collections.abc import Callable, Sequence

from nicegui import ui

Panel = tuple[str, str, str, Callable[[], object]]
"""Name, title and icon of a panel, and the function that builds it."""


def tabs(panels: Sequence[Panel]) -> None:
    """Build the panels; the first one is open."""
    with ui.tabs().props("dense no-caps inline-label align=left outside-arrows mobile-arrows").classes("w-full") as bar:
        for name, title, icon, _ in panels:
            ui.tab(name, title, icon)
    with ui.tab_panels(bar, value=panels[0][0], animated=False).classes("w-full grow bg-transparent"):
        for name, _, _, show in panels:
            with ui.tab_panel(name).style("padding: 4px 0"):
                show()
