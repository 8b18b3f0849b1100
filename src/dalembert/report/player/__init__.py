"""Scenes as a browser draws and plays them, in pages and in notebooks."""

from collections.abc import Iterable
from pathlib import Path

from dalembert.report.look import DARK, LIGHT
from dalembert.report.pictures.canvas import COLOURS, INK, between

LOOK = {
    "series": list(COLOURS),
    "ink": INK,
    "muted": INK,
    "faint": between(LIGHT.grid, DARK.grid, 0.3),
    "paper": LIGHT.surface,
}
"""Colours of the player, readable on a light and on a dark page."""
PAGE_LOOKS = [
    {"series": look.series, "ink": look.ink, "muted": look.muted, "faint": look.grid, "paper": look.surface}
    for look in (LIGHT, DARK)
]
"""Colours of the player on a light and on a dark page."""
BROWSER = Path(__file__).with_name("browser")
"""Folder of the JavaScript: ``index.js`` plays, ``space.js`` draws a scene in space."""
PICTURES = BROWSER / "pictures.js"
"""What plays the pictures of motions in a page."""


def player_files(*, in_space: bool = True) -> tuple[Path, ...]:
    """Return the files of the player, as one module needs them: of motions in the plane, or in space too."""
    names = (*(("solids.js", "space.js") if in_space else ()), "shapes.js", "plane.js", "index.js")
    return tuple(BROWSER / name for name in names)


def module(paths: Iterable[Path]) -> str:
    """Return files of JavaScript as one module, without indents and comments."""
    lines = (line.strip() for path in paths for line in path.read_text(encoding="utf-8").splitlines())
    return "\n".join(line for line in lines if line and not line.startswith(("import ", "//")))
