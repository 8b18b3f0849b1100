"""The way from a data file to the `[data]` table of a draft: what is chosen, what that gives, and what is doubtful."""

import tomllib
from collections.abc import Mapping
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from dalembert.data.known_formats import known_formats
from dalembert.errors import DalembertError, InputError
from dalembert.findings import Finding
from dalembert.studio.data.choices import Choices, fix_of, of_table, write
from dalembert.studio.data.examined import MOST_SAMPLES, Examined, compare, examine
from dalembert.studio.editor.draft import Draft
from dalembert.studio.worker import Worker
from dalembert.study.schema_file import NAME as SCHEMA

Place = tuple[str | int, ...]
DATA: Place = ("data",)
UNITS = {("rad", 1e3): "mrad", ("m", 1e3): "mm", ("N", 1e-3): "kN", ("m/s", 1e3): "mm/s", ("m/s**2", 1e3): "mm/s^2"}
"""Units by which data may differ from a channel's, by that unit and the ratio of their numbers."""

LARGE = 1.345
"""Standard deviations of noise from which a residual is large: usual for Huber's loss."""


class DataGuide:
    """Choices for a file, and the result. ``place``: table to write, ``("data",)`` or one of the experiments; ``file``:
    empty if none is chosen; ``choices``: None until the file was read once; ``examined``: the last result;
    ``suspects``: findings from the response at the first guesses; ``error``: why the file cannot be read.
    """

    def __init__(self, draft: Draft, worker: Worker) -> None:
        self.draft, self._worker = draft, worker
        self.place: Place = DATA
        self.file, self.error = "", ""
        self.choices: Choices | None = None
        self.examined: Examined | None = None
        self.suspects: tuple[Finding, ...] = ()
        self._before: Choices | None = None
        self._seen: Any = None

    @property
    def files(self) -> list[str]:
        """Names of the data files beside the study."""
        suffixes = tuple(suffix for form in known_formats().values() for suffix in form.suffixes)
        names = (path.name for path in self.draft.path.parent.iterdir() if path.is_file() and path.name[0] != ".")
        named = (name for name in names if name.lower().removesuffix(".gz").endswith(suffixes))
        return sorted(name for name in named if name != SCHEMA)

    @property
    def tables(self) -> dict[Place, str]:
        """Tables that may be written, with their names."""
        experiments = _document(self.draft.text).get("experiments", [])
        names = {
            ("experiments", k): f"[[experiments]] {table.get('name', k + 1)}" for k, table in enumerate(experiments)
        }
        return names or {DATA: "[data]"}

    @property
    def candidate(self) -> str:
        """The text of the study with the choices; as it is while they lack something, or the text is not valid."""
        if self.examined is None or not self.examined.table:
            return self.draft.text
        try:
            document = tomlkit.parse(self.draft.text)
            write(document, self.examined.table, self.place)
        except (TOMLKitError, KeyError, IndexError):
            return self.draft.text
        return tomlkit.dumps(document)

    @property
    def is_reading(self) -> bool:
        """Whether the file was not read yet with what is chosen."""
        chosen = (self.file, self.choices)
        read = None if self.examined is None else (self.examined.choices.file, self.examined.choices)
        return bool(self.file) and not self.error and chosen != read

    @property
    def is_written(self) -> bool:
        """Whether the study has what is chosen."""
        return self.examined is not None and bool(self.examined.table) and self.candidate == self.draft.text

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What is wrong or doubtful."""
        return (*(self.examined.findings if self.examined else ()), *self.suspects)

    def follow(self) -> bool:
        """Take the choices from the study's text where its table of data has changed; return whether it had."""
        if self.place not in self.tables:
            self.place = next(iter(self.tables))
        table = self._table()
        if table == self._seen:
            return False
        self._seen = table
        if table is None or not isinstance(table.get("file"), str):
            return False
        self.file, self.choices, self._before = table["file"], of_table(table), None
        return True

    def choose_table(self, place: Place) -> None:
        """Choose the table that is written."""
        self.place, self._seen = place, None
        self.follow()

    def choose_file(self, name: str) -> None:
        """Choose a file; the uses of columns are kept if it has the same ones."""
        self._before = self.choices or self._before
        self.file, self.choices, self.error = name, None, ""

    async def look(self) -> None:
        """Read the file with the choices."""
        if not self.file:
            return
        good = self.draft.good
        text = self.draft.text if good is None else good.text
        file, choices = self.file, self.choices
        try:
            arguments = self.draft.path, text, file, choices, self._before
            examined = await self._worker.ask("data", examine, *arguments)
        except DalembertError as error:
            self.examined, self.suspects, self.error = None, (), str(error).replace(f"{self.draft.path.parent}/", "")
            return
        if examined is None or (self.file, self.choices) != (file, choices):  # there is a newer request
            return
        self.examined, self.error, self.choices = examined, "", examined.choices

    async def doubt(self) -> None:
        """Compare the data with the response at the first guesses."""
        shown = self.examined
        if shown is None or not shown.table or shown.samples // (shown.choices.decimate or 1) > MOST_SAMPLES:
            self.suspects = ()
            return
        try:
            suspects = await self._worker.ask("suspects", compare, self.draft.path, self.candidate)
            if suspects is not None:  # otherwise there is a newer request
                self.suspects = suspects
        except DalembertError:  # a model that fails says so where it is simulated
            self.suspects = ()

    def write(self) -> None:
        """Write the choices into the draft."""
        if self.examined is None or not self.examined.table:
            raise InputError(self.examined.lacks if self.examined else "Choose a data file first.")
        if self.is_reading:
            raise InputError("The file is still being read. Try again in a moment.")
        table, place = self.examined.table, self.place
        self.draft.edit(lambda document: write(document, table, place))
        self._seen = self._table()

    def remedy(self, finding: Finding) -> str:
        """Label of the button beside a finding; empty if it has none."""
        fix, values = fix_of(finding), finding.values
        if fix is not None:
            return fix.label
        if finding.code == "suspect-offset":
            return "Estimate the offset"
        if finding.code == "outliers" and self._takes_loss(values):
            return "Use a robust loss"
        return f"Use {unit}" if finding.code == "suspect-unit" and (unit := self._unit(values)) else ""

    def apply(self, finding: Finding) -> None:
        """Do what the button beside a finding does."""
        fix, values = fix_of(finding), finding.values
        assert self.choices is not None
        if fix is not None:
            self.choices = fix.change(self.choices, values)
        elif finding.code == "suspect-unit":
            self.choices = self.choices.with_unit(self.choices.channels[values["channel"]], self._unit(values))
        elif finding.code == "outliers":
            self.write()
            scale = None if self._deviations else LARGE * values["noise"]
            self.draft.edit(lambda document: _use_robust_loss(document, scale))
        else:
            self.write()
            self.draft.edit(lambda document: _estimate_offset(document, values))

    def _unit(self, values: Any) -> str:
        """The unit that would explain by how much data and response differ."""
        unit = self.examined.channels.get(values["channel"], "") if self.examined else ""
        if unit.startswith("rad") and 50 < values["factor"] < 60:
            return unit.replace("rad", "deg").replace("**", "^")
        return UNITS.get((unit, values["factor"]), "")

    def _takes_loss(self, values: Any) -> bool:
        """Whether the study identifies by squares, and it is known which residuals are large for a robust loss."""
        table = _document(self.draft.text).get("identify")
        if not isinstance(table, Mapping) or table.get("loss", "linear") != "linear" or table.get("profile"):
            return False
        alone = self.choices is not None and len(self.choices.channels) == 1 and "weights" not in table
        return self._deviations or (alone and self.place == DATA and values["noise"] > 0)

    @property
    def _deviations(self) -> bool:
        return bool((self._table() or {}).get("deviations"))

    def _table(self) -> dict[str, Any] | None:
        here: Any = _document(self.draft.text)
        try:
            for step in self.place:
                here = here[step]
        except (KeyError, IndexError):
            return None
        return here


def _document(text: str) -> dict[str, Any]:
    """What a text says; nothing if it is not valid TOML."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return {}


def _use_robust_loss(document: tomlkit.TOMLDocument, scale: float | None) -> None:
    identify: Any = document["identify"]
    identify["loss"] = "huber"
    if scale is not None and "loss_scale" not in identify:
        identify["loss_scale"] = float(f"{scale:.2g}")


def _estimate_offset(document: tomlkit.TOMLDocument, values: Any) -> None:
    sensors = document.setdefault("sensors", tomlkit.table(is_super_table=True))
    sensors.setdefault(values["channel"], tomlkit.table())["offset"] = [values["lower"], values["upper"]]
