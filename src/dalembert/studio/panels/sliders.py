"""Sliders of the parameters: the mechanism plays and curves lie over the data at the values that they show."""

import asyncio
import time
import tomllib
from functools import partial
from typing import Any

from nicegui import background_tasks, ui

from dalembert.parameter import Parameter
from dalembert.studio.editor.chosen_values import unit_in, use_as_start, use_as_value
from dalembert.studio.editor.draft import Draft
from dalembert.studio.frame import button, complaints
from dalembert.studio.page_services import PageServices
from dalembert.studio.panels.parameter_row import LOOKS, ParameterRow
from dalembert.studio.runs.figures import CONFIG
from dalembert.studio.simulation.answers import Influences, Simulated, Source, influences, simulated
from dalembert.studio.simulation.player import Player
from dalembert.studio.worker import WorkerError

STILL = 0.3
"""Seconds without a change after which the effects of parameters are computed."""
PATIENCE = 1.0
"""Seconds of a simulation after which the page says that it is computed."""

MANY = 16
"""Parameters up to which all have their slider above the drawing; of more the first ones have."""
FIRST = 4


def show(draft: Draft, services: PageServices) -> None:
    """Build the panel."""
    ui.add_css(LOOKS)
    Sliders(draft, services)


class Sliders:
    """The panel of one draft."""

    def __init__(self, draft: Draft, services: PageServices) -> None:
        self._draft, self._services = draft, services
        self._rows: dict[str, ParameterRow] = {}
        self._built: object = None
        self._plots: list[ui.plotly] = []
        self._drawn: tuple[Source, str] | None = None
        self._at_start: float | None = None
        self._later: list[asyncio.TimerHandle] = []
        self._visible, self._requested, self._stale = False, False, False
        with ui.column().classes("w-full gap-2"):
            self._build()
        draft.follow("study", self._take_study)
        draft.follow("values", self._take_values)

    def _build(self) -> None:
        with ui.row().classes("w-full items-center gap-2"):
            self._start = button("Use as start", complaints()(self._use_as_start), icon="flag")
            self._reset = button("Reset", self._reset_values, icon="restart_alt", colour="grey-8")
            self._choice = ui.select([""], value="", label="Experiment", on_change=self._take_choice)
            self._choice.props("dense outlined")
            self._status = ui.label("").classes("break-words text-sm grow basis-60").props("role=status")
            self._busy = ui.row().classes("items-center gap-2")
            with self._busy:
                ui.spinner(size="sm")
                ui.label("Computing …").props("role=status")
                button("Stop", self._services.worker.interrupt, icon="stop", colour="negative").props("dense")
        self._problem = ui.label("").classes("text-negative break-words").props("role=alert")
        self._parameters = ui.column().classes("w-full gap-3")
        self._scene = ui.element("div").classes("w-full border rounded p-1")
        with self._scene:  # an invisible element does not hear its events
            self._player = Player("Motion of the mechanism")
        self._player.on("shown", partial(self._appear, True))
        self._player.on("hidden", partial(self._appear, False))
        self._curves = ui.column().classes("w-full gap-2")
        for part in (self._busy, self._choice, self._scene, self._problem):
            part.set_visibility(False)
        self._enable()

    @property
    def _changed(self) -> dict[str, float]:
        """Values that are not first guesses, by name."""
        starts = self._draft.starts
        return {name: value for name, value in self._draft.values.items() if value != starts[name]}

    @property
    def _items(self) -> tuple[Parameter, ...]:
        """Parameters that have sliders: those that act on what is shown."""
        study = self._draft.study
        return () if study is None else study.parts.get(self._choice.value, ())

    def _take_study(self) -> None:
        study = self._draft.study
        if study is None:
            return
        choices = list(study.parts)
        self._choice.set_options(choices, value=self._choice.value if self._choice.value in choices else choices[0])
        self._choice.set_visibility(len(choices) > 1)
        self._take_choice()

    def _take_choice(self) -> None:
        if self._draft.study is None:
            return
        units = self._units()
        if self._built != (built := [(_range(item), units[item.name]) for item in self._items]):
            self._built = built
            self._build_rows(units)
        self._at_start = None
        self._take_values()

    def _units(self) -> dict[str, tuple[str, float]]:
        """The units in which the study writes the parameters, and their sizes."""
        document = tomllib.loads(self._draft.reading.text)
        written = {item.name: unit_in(document, item.name) for item in self._items}
        return {item.name: written[item.name] if written[item.name][0] else (item.unit, 1.0) for item in self._items}

    def _build_rows(self, units: dict[str, tuple[str, float]]) -> None:
        self._parameters.clear()
        items = self._items
        first = len(items) if len(items) <= MANY else FIRST
        with self._parameters:
            self._rows = {item.name: self._row(item, units[item.name]) for item in items[:first]}
            if first < len(items):
                with (
                    ui.expansion(f"{len(items) - first} more parameters")
                    .classes("w-full border rounded")
                    .props("dense")
                ):
                    self._rows |= {item.name: self._row(item, units[item.name]) for item in items[first:]}
            if not items:
                ui.label("The study has no parameters. Add one to [parameters] to get its slider.")

    def _row(self, item: Parameter, unit: tuple[str, float]) -> ParameterRow:
        kept = {
            "Reset": partial(self._reset_value, item.name),
            "Use as start": complaints()(partial(self._use_as_start, item.name)),
            "Use as value": complaints()(partial(self._use_as_value, item.name)),
        }
        chosen = partial(self._draft.set_value, item.name)
        return ParameterRow(item, self._draft.values[item.name], chosen, kept, unit)

    def _take_values(self) -> None:
        for name in self._rows.keys() & self._draft.values.keys():
            self._rows[name].show(self._draft.values[name])
        self._enable()
        self._ask()

    def _enable(self) -> None:
        for control in (self._start, self._reset):
            control.set_enabled(bool(self._changed))

    def _reset_value(self, name: str) -> None:
        self._draft.set_value(name, self._draft.starts[name])

    def _reset_values(self) -> None:
        for name in self._changed:
            self._reset_value(name)

    def _use_as_start(self, *chosen: str) -> None:
        values = {name: self._draft.values[name] for name in chosen} or self._changed
        self._draft.edit(lambda document: use_as_start(document, values))

    def _use_as_value(self, name: str) -> None:
        self._draft.edit(lambda document: use_as_value(document, name, self._draft.values[name]))

    def _appear(self, visible: bool) -> None:
        self._visible = visible
        if visible and self._stale:
            self._ask()

    def _ask(self) -> None:
        """Simulate at the current values; a newer request takes the place of one that waits.

        While another panel is open this is done once, so that all is compiled and read when this one opens.
        """
        if self._draft.study is None or self._draft.reading.text != self._draft.text:
            return
        self._stale = self._requested and not self._visible
        self._requested = True
        if not self._stale:
            background_tasks.create(self._simulate())

    async def _simulate(self) -> None:
        draft, worker, name = self._draft, self._services.worker, self._choice.value
        assert draft.study is not None
        received, source = time.time(), Source.of(draft.study, draft.path, draft.text)
        worker.drop("influences")
        self._wait(PATIENCE, lambda: self._busy.set_visibility(True))
        values, figures = dict(draft.values), self._drawn != (source, name)
        try:
            result = await worker.ask("simulation", simulated, source, name, values, figures=figures)
        except WorkerError as error:
            self._show_problem(str(error))
            return
        if result is None:  # a newer one is on its way
            return
        if figures:
            self._drawn = source, name
        self._show(result, received)
        if result.hint:
            return
        self._wait(STILL, lambda: background_tasks.create(self._weigh(source, name, values)))

    async def _weigh(self, source: Source, name: str, values: dict[str, float]) -> None:
        """Show how strongly the parameters act at the values."""
        try:
            result = await self._services.worker.ask("influences", influences, source, name, values)
        except WorkerError:  # what is wrong was said by the simulation, or there are no derivatives
            result = Influences((), {})
        if result is None:
            return
        largest = max((effect for effects in result.effects.values() for effect in effects), default=0.0)
        for name, row in self._rows.items():
            row.settle()
            row.show_effects(result.channels, result.effects.get(name, []) if largest > 0 else [], largest)

    def _wait(self, seconds: float, act: Any) -> None:
        """Act after some time without another change; what waited before is left out."""
        self._forget()
        self._later.append(asyncio.get_running_loop().call_later(seconds, act))

    def _forget(self) -> None:
        while self._later:
            self._later.pop().cancel()

    def _show_problem(self, sentence: str) -> None:
        self._forget()
        self._busy.set_visibility(False)
        self._problem.set_text(sentence)
        self._problem.set_visibility(bool(sentence))

    def _show(self, result: Simulated, received: float) -> None:
        self._show_problem("")
        self._status.set_text(result.hint or self._facts(result))
        self._scene.set_visibility(result.film is not None)
        if result.film is not None:
            times_shown = {"received": received, "simulated": result.seconds, "computed": result.computed}
            self._player.show(result.film, **times_shown, answered=time.time())
        if any(curves.figure for curves in result.curves) or len(result.curves) != len(self._plots):
            self._draw(result)
            return
        for plot, curves in zip(self._plots, result.curves, strict=True):
            assert isinstance(plot.figure, dict)
            for trace, (x, y) in curves.lines.items():
                plot.figure["data"][trace] |= {"x": x, "y": y}
            plot.update()

    def _draw(self, result: Simulated) -> None:
        """Draw the figures anew; a figure keeps its place and the user's zoom."""
        if len(result.curves) != len(self._plots):
            self._curves.clear()
            with self._curves:
                self._plots = [
                    ui.plotly({"config": CONFIG})
                    .classes("w-full")
                    .props('role=img aria-label="Computed channels and data"')
                    for _ in result.curves
                ]
        for plot, curves in zip(self._plots, result.curves, strict=True):
            curves.figure["layout"]["uirevision"] = "kept"
            plot.update_figure(curves.figure)

    def _facts(self, result: Simulated) -> str:
        """The misfit and what it is at the first guesses, residuals and time, in words."""
        facts = []
        if result.misfit is not None:
            if not self._changed:
                self._at_start = result.misfit
            start = "" if self._at_start is None else f" (at the start values {self._at_start:.4g})"
            facts.append(f"Misfit {result.misfit:.4g}{start}")
        sizes = list(result.residuals.items())[:4]
        facts += [f"rms residual of {name} {size:.3g} {result.units.get(name, '')}".rstrip() for name, size in sizes]
        return " · ".join([*facts, f"simulated in {_duration(result.seconds)}"])


def _duration(seconds: float) -> str:
    return f"{1000 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"


def _range(item: Parameter) -> tuple[object, ...]:
    """What the slider of a parameter depends on."""
    return item.name, item.unit, item.lower, item.upper, item.logarithmic
