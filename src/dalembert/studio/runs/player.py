"""A player of motions: the mechanism in SVG, with a button and the time."""

from dataclasses import asdict

from nicegui import ui

from dalembert.report.look import DARK, LIGHT, Palette
from dalembert.studio.simulation.film import Film

LOOKS = """
.player { width: 100% }
.player-scene { display: block; width: 100%; height: clamp(180px, 27vh, 380px); touch-action: pan-y }
.player-scene[tabindex="0"] { cursor: grab; touch-action: none }
.player-scene:focus-visible, .player-controls input:focus-visible { outline: 2px solid currentColor }
.player-controls { display: flex; align-items: center; gap: 8px }
.player-controls input { flex: 1; min-width: 0; accent-color: var(--q-primary) }
.player-controls output { min-width: 6.5em; font-variant-numeric: tabular-nums; text-align: right }
.player-body { fill: none; stroke-width: 5; stroke-linecap: round; stroke-linejoin: round }
.player-joint { fill: var(--player-surface); stroke: var(--player-ink); stroke-width: 2 }
.player-fixed { stroke: var(--player-muted) }
.player-measured, .player-ruler { fill: none; stroke: var(--player-muted); stroke-width: 1.25 }
.player-name, .player-length { fill: var(--player-muted); font-size: 13px; user-select: none }
"""


def _colours(palette: Palette, where: str) -> str:
    """Rules for a page in the colours of a palette."""
    named = "; ".join(f"--player-{name}: {getattr(palette, name)}" for name in ("surface", "ink", "muted"))
    series = "\n".join(f"{where} .series-{k} {{ stroke: {colour} }}" for k, colour in enumerate(palette.series))
    return f"{where} .player {{ {named} }}\n{series}\n"


class Player(ui.element, component="player.js"):
    """Plays films. A newer film continues where the older one was; it plays to its end after each change.

    Parameters
    ----------
    label : str
        For screen readers.

    Notes
    -----
    It emits ``shown`` when it appears on the page, also again, and ``hidden`` when it disappears.
    """

    def __init__(self, label: str) -> None:
        super().__init__()
        self._props["label"] = label
        self.number = 0
        ui.add_css(LOOKS + _colours(LIGHT, ".body--light") + _colours(DARK, ".body--dark"))

    def show(self, film: Film, **times: float) -> None:
        """Show a newer film; ``times`` tell a benchmark in the browser when it was asked for and computed."""
        self.number += 1
        self._props["film"] = {**asdict(film), "facts": {"number": self.number, **times}}
        self.update()
