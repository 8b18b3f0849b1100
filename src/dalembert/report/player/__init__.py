"""Scenes as a browser draws and plays them, in pages and in notebooks."""

from collections.abc import Iterable
from pathlib import Path

from dalembert.report.look import DARK, LIGHT, Palette
from dalembert.report.pictures.canvas import COLOURS, FAINT, INK

LOOK = {"series": list(COLOURS), "ink": INK, "muted": INK, "faint": FAINT, "paper": LIGHT.surface}
"""Colours of the player, readable on a light and on a dark page."""
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


def look_of(palette: Palette) -> dict[str, object]:
    """Return the colours of the player on a page in the colours of a palette."""
    quiet = {"muted": palette.muted, "faint": palette.grid, "paper": palette.surface}
    return {"series": list(palette.series), "ink": palette.ink, **quiet}


PAGE_LOOKS = (look_of(LIGHT), look_of(DARK))
"""Colours of the player on a light and on a dark page of ours."""
