"""The form of a table of a study: its keys with their values, and the mistakes at each."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from dalembert.studio.editor.cursor import tolerant
from dalembert.studio.editor.editing import text_of, value_of, with_value, without
from dalembert.studio.editor.fields import KIND, TableField, child, field_at, fields_at, kinds_at
from dalembert.studio.editor.lines import Place, is_within, table_of
from dalembert.studio.editor.model_kind import fits_model
from dalembert.studio.editor.reading import Mistake

AXES = ("x", "y", "z")
"""Keys of components along axes: those of a force are what it is about, though each may be left out."""


@dataclass(frozen=True)
class FormRow:
    """A key of a form. ``value`` is None if the key is not given. ``mistakes`` say what is wrong with the value."""

    field: TableField
    value: Any = None
    mistakes: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """The value as the form shows it."""
        return text_of(self.value)

    @property
    def is_table(self) -> bool:
        """Whether the value is a table."""
        return isinstance(self.value, Mapping)

    @property
    def is_usual(self) -> bool:
        """Whether a form shows the key at once, and not among further ones."""
        return self.field.required or self.value is not None or self.field.key in AXES


@dataclass(frozen=True)
class Form:
    """A table that is edited, with the meaning of its kind and the mistakes of the table as a whole."""

    place: Place
    title: str
    meaning: str
    rows: tuple[FormRow, ...]
    mistakes: tuple[str, ...] = ()

    @property
    def keys(self) -> tuple[str, ...]:
        return tuple(row.field.key for row in self.rows)


def form_at(text: str, selection: Place | None, mistakes: Iterable[Mistake] = (), *, inner: Place = ()) -> Form | None:
    """Return the form of the table that a selection is in; None if there is no table with known keys. ``inner`` is the
    way from this table to one within it.
    """
    document = tolerant(text)
    place = (*_table_in(document, text, selection or ()), *inner)
    values = child(document, place)
    values = values if isinstance(values, Mapping) else {}
    fields_here = (field_at(document, (*place, key)) for key in values)
    fields = fields_at(document, place) or tuple(filter(None, fields_here))
    if place == ("model",):
        fields = tuple(field for field in fields if field.key in values or fits_model(document, field.key))
    if not place or not fields:
        return None
    keys = {field.key for field in fields}
    about = [mistake for mistake in mistakes if is_within(mistake.place, place)]
    rows = tuple(FormRow(field, values.get(field.key), _sentences(about, (*place, field.key))) for field in fields)
    rest = tuple(entry.sentence for entry in about if entry.place == place or entry.place[len(place)] not in keys)
    kinds = kinds_at(document, place)
    kind = next((row.value or row.field.default for row in rows if row.field.key == KIND), None)
    return Form(place, _title(document, place), kinds.get(str(kind), ""), rows, rest)


def with_row(text: str, place: Place, field: TableField, written: str) -> str:
    """Return the text with what is written in a form; a key is removed where nothing is."""
    value = value_of(written, field)
    before = child(tolerant(text), (*place, field.key))
    if value == before and type(value) is type(before):
        return text
    return with_value(text, (*place, field.key), value) if value is not None else without(text, (*place, field.key))


def _table_in(document: Any, text: str, selection: Place) -> Place:
    """The table with a header that a selection is in, or its entry where the table has any names as keys."""
    table = table_of(text, selection)
    entry = selection[: len(table) + 1]
    return entry if not fields_at(document, table) and fields_at(document, entry) else table


def _sentences(mistakes: Iterable[Mistake], place: Place) -> tuple[str, ...]:
    return tuple(
        mistake.sentence.partition(f"{place[-1]}: ")[2] or mistake.sentence
        for mistake in mistakes
        if is_within(mistake.place, place)
    )


def _title(document: Any, place: Place) -> str:
    """Return what a form is about.
    >>> study = {"model": {"body": [{"name": "rod"}, {}]}}
    >>> _title(study, ("model", "body", 0, "points")), _title(study, ("model", "body", 1)), _title({}, ("model",))
    ("body 'rod', points", 'body 2', 'model')
    """
    words: list[str] = []
    for length, step in enumerate(place, 1):
        if isinstance(step, int):
            name = child(document, (*place[:length], "name"))
            words[-1] += f" {name!r}" if isinstance(name, str) else f" {step + 1}"
        elif step != "model" or len(place) == 1:
            words.append(step)
    return ", ".join(words)
