"""What all pages share: head, navigation, colours, corrections for screen readers, and how messages are shown."""

from collections.abc import Callable, Hashable, Iterator
from contextlib import ContextDecorator, contextmanager
from functools import wraps
from inspect import iscoroutinefunction
from typing import Any
from urllib.parse import quote
from weakref import WeakValueDictionary

from nicegui import context, ui

from dalembert import __version__
from dalembert.errors import DalembertError, told, unchanged
from dalembert.report.look import DARK, LIGHT
from dalembert.studio.code_text import plain_text
from dalembert.study.run.folder import RunFolder


def _rgb(colour: str) -> str:
    """Return a colour as browsers write it.
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


_SCRIPT = """
<script>
addEventListener("DOMContentLoaded", () => {
    const correct = () => {
        // Entries of a menu are children of the list: what is between may not take the focus.
        for (const one of document.querySelectorAll("[role=listbox] > [tabindex]")) one.removeAttribute("tabindex");
        for (const one of document.querySelectorAll(".js-plotly-plot")) if (!fitted.has(one)) {
            fitted.add(one);
            sizes.observe(one);
        }
    };
    // NiceGUI fits figures that a tab has taken out of the page, too, which is an error.
    const fitted = new WeakSet();
    const sizes = new ResizeObserver(async (entries) => {
        const { Plotly } = await import("nicegui-plotly");
        for (const { target } of entries) if (target.offsetParent && target._fullLayout) Plotly.Plots.resize(target);
    });
    addEventListener("keydown", (event) => {
        const entries = [...(event.target.closest?.("[role=menu]")?.querySelectorAll("[role=menuitem]") ?? [])];
        const at = entries.indexOf(document.activeElement), last = entries.length - 1;
        const below = at < last ? at + 1 : 0, above = at > 0 ? at - 1 : last;
        const next = { ArrowDown: below, ArrowUp: above, Home: 0, End: last }[event.key];
        if (next === undefined || last < 0) return;
        event.preventDefault();
        entries[next].focus();
    });
    new MutationObserver(correct).observe(document.body, { childList: true, subtree: true });
});
</script>
"""


def add_corrections() -> None:
    """Correct the elements of a page when they appear."""
    ui.add_head_html(_SCRIPT)


STATES = {
    "finished": "positive",
    "running": "primary",
    "interrupted": "warning",
    "paused": "warning",
    "killed": "warning",
}
"""Colour of a state's badge; that of an error for the others."""
LOOKS = """
.border, .border-t { border-color: rgba(118, 129, 143, 0.45) }
.cm-line.wrong { background: rgba(224, 49, 49, 0.06) !important; box-shadow: inset 3px 0 #e03131 }
.body--dark .cm-line.wrong { background: rgba(224, 49, 49, 0.16) !important }
.cm-line.chosen { background: rgba(57, 135, 229, 0.1) !important; box-shadow: inset 3px 0 #3987e5 }
.disk-notice { background: rgba(240, 180, 41, 0.22) }
.study-parts > .q-splitter__before { padding-right: 8px; overflow: hidden }
.study-parts > .q-splitter__after { padding-left: 8px; gap: 0 }
.study-parts .grip { position: absolute; inset: 0 -4px; border-radius: 4px }
.study-parts .grip:focus-visible { outline: 3px solid currentColor }
.model-drawing { overflow: hidden; touch-action: pan-y; user-select: none }
.model-drawing > svg { width: 100%; height: 100%; display: block; overflow: visible }
.model-space { overflow: hidden; --ground: #fff }
.body--dark .model-space { --ground: #121212 }
.model-space button, .model-space span { text-shadow: 0 0 2px var(--ground), 0 0 3px var(--ground) }
.model-space button { background: none; border: 0; border-radius: 4px; cursor: pointer }
.model-space button.chosen, .model-part.chosen { outline: 2px solid #3987e5 }
.model-space button.wrong, .model-part.wrong { outline: 2px solid #e03131 }
.model-space:focus-visible, .model-space button:focus-visible { outline: 2px solid #3987e5; outline-offset: -2px }
.model-drawing g[data-part] { cursor: pointer; outline: none }
.model-drawing g.chosen { filter: drop-shadow(0 0 2px #3987e5) drop-shadow(0 0 4px #3987e5) }
.model-drawing g.wrong { filter: drop-shadow(0 0 2px #e03131) drop-shadow(0 0 4px #e03131) }
.model-drawing g[data-part]:focus-visible { outline: 2px solid #3987e5; outline-offset: 3px }
@media (min-width: 1024px) { .wide { height: calc(100dvh - 3.25rem) } }
@media (max-width: 1023px) {
    .study-parts { flex-direction: column }
    .study-parts > .q-splitter__panel { width: 100% !important; padding: 0 }
    .study-parts > .q-splitter__before { height: 45vh }
    .study-parts > .q-splitter__separator { display: none }
    .model-space { min-height: max(50vh, 320px) }
}
[role=main] > div:empty:not([role]):not([aria-live]) { display: none }
.study-hint { max-width: 28rem; padding: 6px 10px; font-size: 13px; white-space: normal }
.cm-tooltip.cm-completionInfo { max-width: 22rem; padding: 6px 10px; font-size: 13px }
.cm-completionDetail { font-style: normal !important; opacity: 0.8 }
.q-uploader__subtitle { display: none }
.no-list .q-uploader__list { display: none }
.q-uploader__list { min-height: 0; padding: 0 }
"""
"""Quiet lines; mistakes in red on any ground; no sizes and no empty list before anything was uploaded; the parts of a
study's page below each other on narrow screens."""
WAYS = (("Runs", "/"), ("Studies", "/studies"), ("New study", "/new"))


@contextmanager
def frame(title: str, *, wide: bool = False, most: str = "max-w-6xl") -> Iterator[None]:
    """A page with the head on top; what is made in the block is its content.

    It takes all of the window if ``wide``, else at most the width of a class, ``most``.
    """
    ui.page_title(f"{title} · dalembert")
    ui.on_exception(_Once())
    add_colours()
    add_corrections()
    ui.add_css(LOOKS)
    width = "wide flex-nowrap gap-2 p-2" if wide else f"{most} mx-auto p-2 sm:p-4 gap-4"
    main = ui.column().classes(f"w-full {width}").props("role=main id=main")
    with ui.header().classes("items-center gap-x-6 gap-y-1 py-2").props("role=banner"):
        ui.link("dalembert", "/").classes("no-underline text-lg font-bold")
        with ui.row().classes("gap-4").props("role=navigation"):
            for name, path in WAYS:
                ui.link(name, path)
        ui.space()
        ui.label(__version__).classes("text-xs max-sm:hidden")
    ui.skip_link("Skip to the content", target=main)  # after the header, which would move before it
    with main:
        ui.query(".nicegui-content").classes(replace="nicegui-content p-0" if wide else "nicegui-content")
        ui.label(title).classes(f"text-{'xl' if wide else '2xl'} font-bold break-words max-w-full").props(
            "role=heading aria-level=1"
        )
        yield


def badge(state: str) -> ui.badge:
    """A run's state, in words and in colour."""
    return ui.badge(state, color=STATES.get(state, "negative")).props("role=status")


class _Once:
    """Shows what no block caught; an error that a timer meets again and again is shown once."""

    def __init__(self) -> None:
        self._shown: set[str] = set()

    def __call__(self, error: Exception) -> None:
        sentence = told(error)
        if sentence not in self._shown:
            self._shown.add(sentence)
            complain(error)


def complain(error: Exception) -> ui.notification:
    """Show an error as a message that stays until it is read; return the message."""
    if isinstance(error, DalembertError | OSError):
        sentence = unchanged(error)
    else:
        sentence = f"The studio met an error: {told(error)}. Reload the page: a text that is not saved is kept."
    return ui.notification(plain_text(sentence), type="negative", multi_line=True, close_button="Close", timeout=None)


_MESSAGES: WeakValueDictionary[tuple[str, Hashable], ui.notification] = WeakValueDictionary()
"""Messages of actions that failed last time, by the page that shows them and the action."""


class _Complaints(ContextDecorator):
    """A block of an action; see :func:`complaints`."""

    def __init__(self, action: Hashable) -> None:
        self.action = self if action is None else action

    def __enter__(self) -> None:
        """Begin the block."""
        self.page = context.client.id  # at the end the element that asked for the action may be gone

    def __exit__(self, kind: object, error: object, trace: object) -> bool:
        if kind is None or isinstance(error, DalembertError | OSError):
            self._take_away()
        if not isinstance(error, DalembertError | OSError):
            return False
        _MESSAGES[self.page, self.action] = complain(error)
        return True

    def _take_away(self) -> None:
        """Take the message of the last time away, which is out of date."""
        message = _MESSAGES.pop((self.page, self.action), None)
        if message is not None and not message.is_deleted:
            message.dismiss()

    def __call__(self, function: Callable[..., Any]) -> Callable[..., Any]:
        if not iscoroutinefunction(function):
            return super().__call__(function)

        @wraps(function)
        async def guarded(*arguments: object, **named: object) -> object:
            with self:
                return await function(*arguments, **named)

        return guarded


def complaints(action: Hashable = None) -> _Complaints:
    """Return a block, which decorates functions and coroutine functions too, whose errors are shown as messages. A
    message is taken away when the same action is done again: what the block decorates, or whatever has the same
    ``action``, such as its name.
    """
    return _Complaints(action)


def report_of(folder: RunFolder, height: str) -> None:
    """The report of a run as a page within a page, which can reach nothing of the studio."""
    name = quote(folder.path.name)
    page = ui.element("iframe").props(f'src="/files/{name}/report.html" title="Report of {name}"')
    page.props('sandbox="allow-scripts allow-downloads allow-popups"')
    page.classes("w-full border rounded").style(f"height: {height}")


def button(text: str, on_click: Callable[[], object], *, icon: str, colour: str = "primary") -> ui.button:
    """A button in the studio's look."""
    return ui.button(text, on_click=on_click, icon=icon, color=colour).props("no-caps no-wrap unelevated")


def tipped(button: ui.button, text: str) -> ui.button:
    """Give a button a tip, and return it.

    The tip is a child of the button and goes with it. A tip beside it looks for a button that may be gone.
    """
    with button:
        ui.tooltip(text)
    return button


def icon_button(icon: str, label: str, on_click: Callable[[], object]) -> ui.button:
    """A button with an icon alone, and what it does as its label and tip."""
    button = ui.button(on_click=on_click, icon=icon).props(f'flat round dense aria-label="{label}"')
    return tipped(button, label)
