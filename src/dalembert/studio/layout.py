"""The parts of a page, in columns and as tabs."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from nicegui import ui
from nicegui.slot import Slot

LIMITS = (20, 80)  # %
STEP = 5  # % of a key


@contextmanager
def splitter(label: str) -> Iterator[tuple[Slot, Slot]]:
    """Build the parts; the arrow keys move the border, which has a label."""
    element = ui.splitter(value=45, limits=LIMITS).classes("w-full grow min-h-0 study-parts")

    def move(by: int) -> None:
        element.set_value(min(max((element.value or 0) + by, LIMITS[0]), LIMITS[1]))

    with element.separator:
        grip = ui.element("div").classes("grip").props(f'role=separator tabindex=0 aria-label="{label}"')
        grip.props(f"aria-orientation=vertical aria-valuemin={LIMITS[0]} aria-valuemax={LIMITS[1]} aria-valuenow=45")
        grip.on("keydown.left", lambda: move(-STEP))
        grip.on("keydown.right", lambda: move(STEP))
    element.on_value_change(lambda: grip.props(f"aria-valuenow={element.value:.0f}"))
    yield element.before, element.after


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
