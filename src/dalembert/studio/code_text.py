"""Sentences with code in backticks, shown as code."""

import re
from html import escape

from nicegui import ui

_CODE = re.compile(r"`([^`]+)`")


def code_text(text: str) -> ui.html:
    """Show a sentence; what is in backticks has the letters of code."""
    return ui.html(code_html(text), sanitize=False)


def code_html(text: str) -> str:
    """Return a sentence as HTML.
    >>> code_html("Write `start = 1` where a < b.")
    'Write <code>start = 1</code> where a &lt; b.'
    """
    return _CODE.sub(r"<code>\1</code>", escape(text, quote=False))


def plain_text(text: str) -> str:
    """Return a sentence for places that show no code: names in quotes.
    >>> plain_text("Write `start = 1`.")
    "Write 'start = 1'."
    """
    return _CODE.sub(r"'\1'", text)
