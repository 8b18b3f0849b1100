"""Motions of mechanisms as a browser plays them, in pages and in notebooks."""

from pathlib import Path

from dalembert.report.pictures.canvas import COLOURS, INK
from dalembert.report.player.film import Film, film_of, frames

LOOK = {"series": list(COLOURS), "ink": INK, "paper": "#fffffe"}
"""Colours of the player, readable on a light and on a dark page."""
BROWSER = Path(__file__).with_name("browser")
"""Folder of the player's JavaScript: ``index.js`` is the module."""

__all__ = ["BROWSER", "LOOK", "Film", "film_of", "frames"]
