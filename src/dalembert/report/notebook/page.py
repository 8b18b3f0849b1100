"""What a notebook shows of a result or a model, as HTML."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape

from dalembert.report.look import FONT

CELL = "padding:0.1rem 0.9rem 0.1rem 0;text-align:left;border:none;font-variant-numeric:tabular-nums"
BADGES = {"good": "#00704f", "doubtful": "#8a5a00", "bad": "#b3261e", "": "#5d6776"}
"""Colours of verdicts behind white text."""


@dataclass(frozen=True)
class Summary:
    """What a notebook shows.

    Parameters
    ----------
    title : str
    verdict, badge : str
        A word, and how it is meant: ``"good"``, ``"doubtful"`` or ``"bad"``.
    sentences : sequence of str
    facts : mapping of str to str
    pictures : sequence of str
        SVG, beside each other where there is room.
    """

    title: str
    verdict: str = ""
    badge: str = ""
    sentences: Sequence[str] = ()
    facts: Mapping[str, str] = field(default_factory=dict)
    pictures: Sequence[str] = ()

    def html(self) -> str:
        """Return the summary as one HTML element, in the colours of the notebook."""
        colour = f"background:{BADGES[self.badge]};color:#fff;border-radius:0.25rem;padding:0 0.4rem"
        verdict = f' <span style="{colour}">{escape(self.verdict)}</span>' if self.verdict else ""
        sentences = "".join(
            f'<p style="margin:0.3rem 0;max-width:60rem">{escape(sentence)}</p>'
            for sentence in self.sentences
            if sentence
        )
        rows = "".join(
            f'<tr style="background:none"><th scope="row" style="{CELL};font-weight:normal">{escape(name)}</th>'
            f'<td style="{CELL}">{escape(text)}</td></tr>'
            for name, text in self.facts.items()
        )
        table = f'<table style="border-collapse:collapse;margin:0.3rem 0">{rows}</table>' if rows else ""
        figures = "".join(f'<div style="max-width:100%">{picture}</div>' for picture in self.pictures)
        beside = f'<div style="display:flex;flex-wrap:wrap;gap:1rem;align-items:flex-start">{figures}</div>'
        head = f"<div><strong>{escape(self.title)}</strong>{verdict}</div>"
        content = f"{head}{sentences}{table}{beside if figures else ''}"
        return f'<div style="font-family:{escape(FONT)};line-height:1.45">{content}</div>'
