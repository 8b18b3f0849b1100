"""Two parts of a page side by side, below each other on narrow screens, whose border a mouse and keys can move."""

from collections.abc import Iterator
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
