"""Colours of the studio's pages: texts have a contrast of at least 4.5 to their ground, in light and in dark."""

from nicegui import ui

from dalembert.report.look import DARK, LIGHT


def _rgb(colour: str) -> str:
    """A colour as browsers write it.

    >>> _rgb("#0069ab")
    'rgb(0, 105, 171)'
    """
    return f"rgb({', '.join(str(part) for part in bytes.fromhex(colour[1:]))})"


FILLS = {"primary": LIGHT.series[0], "positive": "#007a57", "warning": "#8a5f00", "negative": "#c10015"}
"""Grounds of buttons, badges and messages, whose text is white."""
TEXTS = {"primary": DARK.series[0], "positive": DARK.series[2], "warning": DARK.series[4], "negative": "#ff8a80"}
"""Texts and icons on dark ground in place of the colours above."""
_ON_DARK = "\n".join(
    f".body--dark :is(.text-{name}, .dot.bg-{name}) {{ --q-{name}: {colour} }}" for name, colour in TEXTS.items()
)
_LINES = "\n".join(
    f".body--dark .js-plotly-plot [style*='{use}: {_rgb(light)}'] {{ {use}: {dark} !important }}"
    for light, dark in zip(LIGHT.series, DARK.series, strict=True)
    for use in ("stroke", "fill")
)
_FOCUSED = ":is(a, button, summary, [tabindex='0'], [role=tab], [role=menuitem], input[type=range]):focus-visible"
RULES = f"""
.nicegui-link {{ color: {FILLS["primary"]} }}
.body--dark .nicegui-link {{ color: {TEXTS["primary"]} }}
.q-header .nicegui-link {{ color: white }}
{_ON_DARK}
.body--dark .q-field {{ --q-primary: {TEXTS["primary"]}; --q-negative: {TEXTS["negative"]} }}
body {{ --focus: {FILLS["primary"]}; --ground: white }}
body.body--dark {{ --focus: {TEXTS["primary"]}; --ground: #121212 }}
.q-header {{ --focus: white; --ground: {FILLS["primary"]} }}
{_FOCUSED} {{ outline: 2px solid var(--focus); outline-offset: 2px }}
[role=tab]:focus-visible {{ outline-offset: -2px }}
.no-outline:focus-visible {{ box-shadow: 0 0 0 2px var(--ground), 0 0 0 4px var(--focus) }}
@media (prefers-reduced-motion: reduce) {{
    * {{ transition-duration: 1ms !important; scroll-behavior: auto !important }}
}}
.cm-editor.cm-focused {{ outline: 2px solid var(--focus) !important }}
.js-plotly-plot .main-svg :is(.cartesianlayer, .infolayer) text {{ fill: currentColor !important }}
.q-dialog .q-card {{ z-index: 1 }}
.q-notification__actions {{ --q-primary: currentColor }}
.model-drawing text {{ fill: currentColor; paint-order: stroke; stroke: var(--ground); stroke-width: 3px }}
.model-space button {{ color: inherit !important }}
.cm-editor .cm-activeLine {{ background: rgba(118, 129, 143, 0.06) }}
.cm-editor .cm-lineNumbers .cm-gutterElement {{ color: #6b6b6b }}
.body--dark .cm-editor .cm-lineNumbers .cm-gutterElement {{ color: #a0a0a0 }}
{_LINES}
"""
"""Quasar shows the focus by a faint ground alone, and figures have one colour of text for light and dark pages."""


def add_colours() -> None:
    """Give a page the colours."""
    ui.colors(**FILLS)
    ui.add_css(RULES)
