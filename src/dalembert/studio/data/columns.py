"""The columns of a data file as a table: a menu for the use of each, one for its unit, and the first rows."""

from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from nicegui import ui

from dalembert.data.guesses import Unit
from dalembert.studio.data.choices import Choices, Key
from dalembert.studio.data.examined import Curve, Examined

Pick = Callable[[str, Sequence[str], Callable[[str], object]], Awaitable[object]]
NOTHING, TIMES = "", "\0times"
"""Values of the menu of uses beside the channels' names."""
SOURCES = {"file": "from the file", "name": "from the name", "steps": "guessed from the steps", "": ""}
LIKE = {
    "s": ("s", "ms", "us", "ns", "min"),
    "m": ("m", "cm", "mm", "um", "inch"),
    "rad": ("rad", "deg", "mrad", "turn"),
    "m/s": ("m/s", "mm/s", "km/h"),
    "rad/s": ("rad/s", "deg/s", "rpm"),
    "m/s**2": ("m/s^2", "mm/s^2", "g_0"),
    "rad/s**2": ("rad/s^2", "deg/s^2"),
    "N": ("N", "kN", "mN"),
    "N*m": ("N*m", "N*mm", "kN*m"),
}
"""Units of quantities by their SI units."""
SPELLINGS = str.maketrans({"°": "deg", "º": "deg", "µ": "u", "μ": "u", "²": "^2"})
"""Signs in units of files, as the menu of units spells them."""
CELL = "px-2 py-0.5 text-left align-top border-t"


class ColumnTable:
    """The table. It is rebuilt for another file, and otherwise updated, so that the focus stays. ``choose`` is called
    with the choices when a menu was changed. ``pick`` asks in the drawing for the channel of a column: it takes the
    column, the channels, and the function to call with the chosen channel.
    """

    def __init__(self, choose: Callable[[Choices], object], pick: Pick) -> None:
        self._choose, self._pick, self._examined, self._built = choose, pick, None, None
        self._uses: dict[Key, ui.select] = {}
        self._units: dict[Key, ui.select] = {}
        self._hints: dict[Key, ui.label] = {}
        self._quiet = False
        self._box = ui.element("div").classes("w-full overflow-x-auto border rounded")

    def show(self, examined: Examined) -> None:
        """Show a file with its choices."""
        keys = tuple(curve.key for curve in examined.curves)
        built = (examined.choices.file, keys, examined.first, tuple(examined.channels))
        self._examined, self._quiet = examined, True
        if built != self._built:
            self._built = built
            self._build(examined)
        for curve in examined.curves:
            self._update(examined, curve)
        self._quiet = False

    def _build(self, examined: Examined) -> None:
        self._box.clear()
        keys = [curve.key for curve in examined.curves]
        with self._box, ui.element("table").classes("text-sm w-full").props('aria-label="Columns of the file"'):
            with ui.element("thead"):
                with ui.element("tr"):
                    for key in keys:
                        with ui.element("th").classes("px-2 pt-2 text-left min-w-44").props("scope=col"):
                            ui.label(f"column {key}" if isinstance(key, int) else key).classes("font-bold break-all")
                with ui.element("tr"):
                    for key in keys:
                        with ui.element("td").classes("px-2 pb-2 align-top min-w-44"):
                            self._menus(key)
            with ui.element("tbody").classes("font-mono text-xs"):
                for row in examined.first:
                    with ui.element("tr"):
                        for cell in row:
                            with ui.element("td").classes(CELL):
                                ui.label(cell)

    def _menus(self, key: Key) -> None:
        look = "outlined dense options-dense"
        use = ui.select([], with_input=True, label="Used as", on_change=lambda: self._used(key, use.value))
        use.props(f'{look} aria-label="Use of column {key}"').classes("w-full")
        picked = ui.button("Pick in the drawing", icon="ads_click", on_click=partial(self._picked, key))
        picked.props(f'flat dense no-caps size=sm aria-label="Pick the channel of column {key} in the drawing"')
        unit = ui.select([], with_input=True, new_value_mode="add-unique", label="Unit")
        unit.on_value_change(lambda: self._measured(key, unit.value))
        unit.props(f'{look} aria-label="Unit of column {key}"').classes("w-full mt-2")
        hint = ui.label("").classes("text-xs opacity-80 h-4")
        self._uses[key], self._units[key], self._hints[key] = use, unit, hint

    def _update(self, examined: Examined, curve: Curve) -> None:
        choices, key = examined.choices, curve.key
        use = TIMES if key == choices.time else next((c for c, k in choices.channels.items() if k == key), NOTHING)
        unit = Unit(choices.units[key], "") if key in choices.units else curve.unit
        options = uses(examined.channels, unit.name)
        _set(self._uses[key], options | ({} if use in options else {use: use}), use)
        si = "s" if use == TIMES else examined.channels.get(use, "")
        name = unit.name or si.replace("**", "^")
        known = LIKE.get(si, ()) if si else all_units()
        units: list[str] = [*known, *([name] if name and name not in known else [])]
        _set(self._units[key], units, name or None)
        self._hints[key].set_text(SOURCES[unit.source])

    def _used(self, key: Key, use: str | None) -> None:
        if self._quiet or self._examined is None or use is None:
            return
        self._choose(used(self._examined.choices, key, use))

    async def _picked(self, key: Key) -> None:
        if self._examined is not None:
            channels = [name for name in uses(self._examined.channels, self._unit(key)) if name not in (NOTHING, TIMES)]
            await self._pick(str(key), channels, partial(self._used, key))

    def _unit(self, key: Key) -> str:
        return self._units[key].value or ""

    def _measured(self, key: Key, unit: str | None) -> None:
        if self._quiet or self._examined is None or not unit:
            return
        self._choose(self._examined.choices.with_unit(key, unit))


def _set(menu: ui.select, options: list[str] | dict[str, str], value: str | None) -> None:
    """Change a menu only if it is another one: the browser may be about to choose one of its entries."""
    if menu.options != options:
        menu.set_options(options, value=value)
    elif menu.value != value:
        menu.set_value(value)


def used(choices: Choices, key: Key, use: str) -> Choices:
    """Return the choices with another use of a column: a channel, the times, or nothing.
    >>> before = Choices("a.csv", "t", channels={"rod.angle": "x"})
    >>> used(before, "y", "rod.angle").channels, used(before, "x", "").channels, used(before, "x", TIMES).time
    ({'rod.angle': 'y'}, {}, 'x')
    """
    channels = {name: column for name, column in choices.channels.items() if column != key and name != use}
    time = key if use == TIMES else None if choices.time == key else choices.time
    if use not in (NOTHING, TIMES):
        channels[use] = key
    wraps = tuple(name for name in choices.wraps if name in channels)
    return replace(choices, time=time, channels=channels, wraps=wraps)


def uses(channels: Mapping[str, str], unit: str) -> dict[str, str]:
    """Return the entries of the menu of uses: channels that may have a unit come first.
    >>> list(uses({"A.x": "m", "A.angle": "rad"}, "°").values())
    ['not used', 'times', 'A.angle (rad)', 'A.x (m)']
    """
    spelt = unit.translate(SPELLINGS)
    fits = next((si for si, units in LIKE.items() if spelt in units), None)
    ordered = sorted(channels, key=lambda name: channels[name] != fits)
    shown = {name: f"{name} ({channels[name].replace('**', '^')})" if channels[name] else name for name in ordered}
    return {NOTHING: "not used", TIMES: "times", **shown}


def all_units() -> list[str]:
    """Return all units of the menus."""
    return [unit for units in LIKE.values() for unit in units]
