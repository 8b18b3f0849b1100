"""One parameter on the page: its slider, its field, and their numbers."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from html import escape

from nicegui import events, ui

from dalembert.errors import InputError
from dalembert.parameter import Parameter
from dalembert.report.charts.drawing import colour_of
from dalembert.studio.editor.entries import DIGITS
from dalembert.units import is_quantity, si

STEPS = 1000
"""Positions of a slider, less one."""


@dataclass(frozen=True)
class SliderScale:
    """Positions of a slider, from 0 to :data:`STEPS`, and values of a parameter.
    >>> angle, modulus = SliderScale(Parameter("angle", 0.6, 1.0)), SliderScale(Parameter("E", 1e6, 1e9))
    >>> angle.value(500), modulus.value(500), modulus.position(1e8)
    (0.8, 31622800.0, 667)
    """

    item: Parameter

    def value(self, position: float) -> float:
        """Value at a position, with as many digits as distinguish neighbouring positions."""
        lower, upper, share = self.item.lower, self.item.upper, min(max(position / STEPS, 0.0), 1.0)
        if share in (0.0, 1.0):
            return upper if share else lower
        if self._logarithmic:
            return float(f"{lower * (upper / lower) ** share:.6g}")
        decimals = 1 - math.floor(math.log10((upper - lower) / STEPS))
        return round(lower + share * (upper - lower), decimals)

    def position(self, value: float) -> int:
        """The position that is nearest to a value."""
        lower, upper = self.item.lower, self.item.upper
        if self._logarithmic:
            return round(STEPS * math.log(value / lower) / math.log(upper / lower))
        return round(STEPS * (value - lower) / (upper - lower))

    @property
    def _logarithmic(self) -> bool:
        return self.item.logarithmic and self.item.lower > 0


_MINUS = "\N{MINUS SIGN}"


def typed_number(text: str | None, unit: str = "", size: float = 1.0) -> float:
    """Return the number of a text in SI units. ``unit``: of a text without one; ``size``: of this unit, in SI units.
    >>> typed_number("-2,5", "mm", 1e-3), typed_number("2 cm", "mm", 1e-3), typed_number("3")
    (-0.0025, 0.02, 3.0)
    >>> typed_number("1,234.5")
    Traceback (most recent call last):
    dalembert.errors.InputError: Enter a number with one decimal point or comma, and no other separators
    """
    written = (text or "").strip().replace(_MINUS, "-")
    if written.count(",") + written.count(".") > 1:
        raise InputError("Enter a number with one decimal point or comma, and no other separators")
    written = written.replace(",", ".")
    try:
        return si(written, unit or None) if is_quantity(written) else si(written, "") * size
    except InputError:
        example = f"2.5, or 2.5 {unit} with its unit" if unit else "2.5"
        raise InputError(f"{text!r} is not a number in this unit. Enter a number such as {example}") from None


THROTTLE = 0.02  # s between two values of a slider that is dragged
SHOWN = 4
"""Channels of which bars are drawn: those that a parameter acts on most."""
LOOKS = """
.parameter-row { display: grid; grid-template-columns: minmax(5rem, 1fr) minmax(6rem, 3fr) 9.5rem auto; gap: 0 10px;
  align-items: center; width: 100% }
.parameter-row input[type=range] { width: 100%; height: 28px; accent-color: var(--q-primary); cursor: pointer }
.body--dark input[type=range] { color-scheme: dark }
.parameter-row input[type=range]:focus-visible { outline: 2px solid currentColor; outline-offset: 1px }
.parameter-row .bounds { display: flex; justify-content: space-between; font-size: 11px; opacity: 0.75;
  margin-top: -4px }
.parameter-row .effects { grid-column: 1 / -1; display: flex; flex-wrap: wrap; gap: 0 14px; font-size: 12px }
.parameter-row .effect { display: inline-flex; align-items: center; gap: 5px }
.parameter-row .track { width: 44px; height: 6px; border-radius: 3px; background: rgba(118, 129, 143, 0.25) }
.body--dark .parameter-row .track { box-shadow: 0 0 0 1px rgba(170, 180, 192, 0.6) }
.parameter-row .bar { height: 6px; border-radius: 3px; min-width: 1px }
@media (max-width: 599px) {
  .parameter-row { grid-template-columns: 1fr 9.5rem auto }
  .parameter-row .way { grid-column: 1 / -1; grid-row: 2 }
}
"""


class Way(ui.element, component="way.js"):
    """A slider that emits ``moved`` with its position."""

    def place(self, position: int, text: str) -> None:
        """Move it to a position, whose value is a text."""
        self._props["position"] = position
        self._props["aria-valuetext"] = text
        self.update()


class ParameterRow:
    """A parameter on a page. ``value`` is the current one, in SI units. ``chosen`` is called with a value that the user
    chose. ``kept`` has what can be done with the value, by its text in the menu. ``unit`` is the unit in which the
    value is shown, and its size in SI units.
    """

    def __init__(
        self,
        item: Parameter,
        value: float,
        chosen: Callable[[float], None],
        kept: Mapping[str, Callable[[], object]],
        unit: tuple[str, float],
    ) -> None:
        self.item, self.unit, self._scale, self._chosen, self._value = item, unit, SliderScale(item), chosen, value
        with ui.element("div").classes("parameter-row").props(f'role=group aria-label="{escape(item.name)}"'):
            ui.label(item.name).classes("font-bold break-words")
            self._build_way()
            self._build_number()
            with ui.button(icon="more_vert").props(f'flat round dense aria-label="Use {escape(item.name)}"'), ui.menu():
                for text, act in kept.items():
                    ui.menu_item(text, act).props("role=menuitem")
            self._effects = ui.html("", sanitize=False).classes("effects")
        self.settle()

    def show(self, value: float) -> None:
        """Show a value that was set elsewhere."""
        if value != self._value:
            self._value = value
            self._number.set_value(self._text)
            self.settle()

    def settle(self) -> None:
        """Bring the slider to its value."""
        text = f"{self._text} {self.unit[0]}".rstrip()
        self._way.place(self._scale.position(self._value), text)

    def show_effects(self, channels: tuple[str, ...], effects: list[float], largest: float) -> None:
        """Show bars for the channels that the parameter acts on, relative to the largest effect of all parameters."""
        order = sorted(range(len(channels)), key=lambda place: -effects[place])[:SHOWN]
        bars = [_bar(channels[k], effects[k], effects[k] / largest, colour_of(k)) for k in sorted(order)]
        self._effects.set_content("".join(bars))

    def _build_way(self) -> None:
        item = self.item
        with ui.element("div").classes("way"):
            self._way = Way().props(f'max={STEPS} aria-label="{escape(item.name)}"')
            self._way.on("moved", self._moved, throttle=THROTTLE)
            with ui.element("div").classes("bounds").props("aria-hidden=true"):
                ui.label(self._shown(item.lower))
                ui.label(self._shown(item.upper))

    def _build_number(self) -> None:
        self._number = ui.input(value=self._text, validation=self._complaint, on_change=self._typed)
        self._number.props(f'dense outlined debounce=300 hide-bottom-space suffix="{escape(self.unit[0])}"')
        self._number.props(f'inputmode=decimal aria-label="Value of {escape(self.item.name)}"')
        self._number.on("blur", self._tidy)

    def _moved(self, event: events.GenericEventArguments) -> None:
        value = self._scale.value(float(event.args))
        if value != self._value:
            self._value = value
            self._number.set_value(self._text)
            self._chosen(value)

    def _typed(self) -> None:
        if self._number.value == self._text or self._complaint(self._number.value):
            return
        value = min(max(self._read(self._number.value), self.item.lower), self.item.upper)
        if value != self._value:
            self._value = value
            self.settle()
            self._chosen(value)

    def _tidy(self) -> None:
        """Show the value in the unit of the row, whichever way it was typed."""
        if not self._complaint(self._number.value):
            self._number.set_value(self._text)

    def _complaint(self, text: str | None) -> str | None:
        """What is wrong with a text that was typed; None if nothing is."""
        lower, upper = self._shown(self.item.lower), self._shown(self.item.upper)
        try:
            value = self._read(text)
        except InputError as error:
            return str(error)
        return None if float(lower) <= float(self._shown(value)) <= float(upper) else f"Enter {lower} to {upper}"

    def _read(self, text: str | None) -> float:
        return typed_number(text, *self.unit)

    @property
    def _text(self) -> str:
        return self._shown(self._value)

    def _shown(self, value: float) -> str:
        """A value (SI) in the unit of the row, with the digits that a user can read."""
        return f"{value / self.unit[1]:.{DIGITS}g}"


def _bar(channel: str, effect: float, share: float, colour: str) -> str:
    """A bar, with the effect in words for those who do not see it."""
    percent = f"{effect:.0f} ×" if effect > 10 else f"{100 * effect:.{0 if effect > 0.1 else 1}f} %"
    name, tip = escape(channel), f"Changes {escape(channel)} by about {percent} of its range between the bounds"
    inside = f'<span class="bar" style="width:{100 * share:.0f}%;background:{colour};display:block"></span>'
    return f'<span class="effect" title="{tip}"><span class="track">{inside}</span><span>{name} {percent}</span></span>'
