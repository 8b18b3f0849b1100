"""Scenes as a browser draws and plays them, in pages and in notebooks."""

from pathlib import Path

from dalembert.report.pictures.canvas import COLOURS, INK

LOOK = {"series": list(COLOURS), "ink": INK, "paper": "#fffffe"}
"""Colours of the player, readable on a light and on a dark page."""
BROWSER = Path(__file__).with_name("browser")
"""Folder of the JavaScript: ``index.js`` plays, ``space.js`` draws a scene in space."""
