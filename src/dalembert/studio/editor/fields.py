"""What a study file may say at a place: the keys of a table with unit, default, meaning, allowed names and kinds.

All of it comes from the JSON schema of study files, which the tables of the study make.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from dalembert.studio.editor.lines import Place
from dalembert.study import schema_file
from dalembert.study.text.numbers import UNIT
from dalembert.study.text.places import NAMES

Shape = Literal["number", "whole", "switch", "choice", "text", "list", "table"]
Node = Mapping[str, Any]
_SHAPES: dict[str, Shape] = {
    "boolean": "switch", "integer": "whole", "string": "text", "array": "list", "object": "table",
}  # fmt: skip
KIND = "kind"
_OF_KIND = "What it is."
_NAMED = {
    "channels": "channel", "wraps": "channel", "of": "channel", "observe": "channel",
    "points": "point", "driving": "point", "input": "input", "local": "parameter", "parameters": "parameter",
    "first": "node", "second": "node", "dof": "node", "fixed": "node", "masters": "node",
}  # fmt: skip
"""What texts of a key are names of, where the schema does not say it; also the keys of a table of this name."""
_OF_KEYS = {"columns": "channel", "deviations": "channel", "weights": "channel", "derivatives": "channel",
            "sensors": "channel", "intervals": "parameter", "truth": "parameter", "over": "parameter",
            "pose": "joint", "rates": "joint", "inputs": "input"}  # fmt: skip


@dataclass(frozen=True)
class TableField:
    """A key of a table. ``shape`` says what a value of it is, ``meaning`` includes what is expected. ``unit``: of a
    number, None or empty if it has none; ``default``: None if there is none, or it depends on other keys; ``choices``:
    allowed texts, such as kinds; ``names``: what a text, or each text of a list, names, such as a "point" or "joint".
    """

    key: str
    shape: Shape
    meaning: str = ""
    unit: str | None = None
    default: Any = None
    required: bool = False
    choices: tuple[str, ...] = ()
    names: str = ""

    @property
    def facts(self) -> str:
        """Return unit and default in a few words.
        >>> TableField("angle", "number", unit="rad", default=0.0).facts
        'in rad, default 0'
        """
        unit = f"in {self.unit}" if self.unit else ""
        rule = "required" if self.required else "" if self.default is None else f"default {shown(self.default)}"
        return ", ".join(filter(None, (unit, rule)))


def fields_at(document: Any, place: Place) -> tuple[TableField, ...]:
    """Return the keys of the table at a place of a document; none where there is no table with known keys. The kinds of
    the document, and whether its model is in space, choose among tables.
    """
    tables = _tables_at(document, place)
    chosen = _chosen(tables, child(document, place)) or {}
    keys, required, kinds = chosen.get("properties", {}), chosen.get("required", ()), tuple(_kinds(tables))
    fields = [_field(key, node, key in required, kinds if key == KIND else ()) for key, node in keys.items()]
    if kinds and KIND not in keys:  # it chooses among the tables
        fields.insert(0, TableField(KIND, "choice", _OF_KIND, required=not keys, choices=kinds))
    return tuple(fields)


def field_at(document: Any, place: Place) -> TableField | None:
    """Return the key that a place is; None if it is not known."""
    if not place or isinstance(place[-1], int):
        return None
    key = str(place[-1])
    known = {field.key: field for field in fields_at(document, place[:-1])}
    if key in known:
        return known[key]
    more = _more_at(document, place[:-1])
    return None if more is None else _field(key, more, False, ())


def kinds_at(document: Any, place: Place) -> dict[str, str]:
    """Return the kinds that the table at a place may be of, with what each is."""
    return _kinds(_tables_at(document, place))


def keys_named(place: Place) -> str:
    """Return what the keys of the table at a place are names of, empty if of nothing that is known."""
    return _OF_KEYS.get(str(place[-1]), "") if place else ""


def tables_of(document: Any) -> dict[Place, str]:
    """Return the meanings of the tables that a study may have, by their places; those of lists have a trailing 0."""
    meanings: dict[Place, str] = {}
    for path in ((), ("model",)):
        for key, node in (
            (_chosen(_tables_at(document, path), child(document, path)) or {}).get("properties", {}).items()
        ):
            for alternative in _alternatives(node):
                if alternative.get("type") == "array" and any(
                    map(_is_table, _alternatives(alternative.get("items", {})))
                ):
                    meanings[(*path, key, 0)] = _meaning(node)
                elif _is_table(alternative):
                    meanings.setdefault((*path, key), _meaning({**alternative, **node}))
    return meanings


def child(value: Any, place: Sequence[str | int]) -> Any:
    """Return what is at a place of a document, None if nothing is."""
    for step in place:
        try:
            value = value[step]
        except (KeyError, IndexError, TypeError):
            return None
    return value


def _tables_at(document: Any, place: Place) -> list[Node]:
    """Tables that a place may be by the schema."""
    nodes: list[Node] = [schema_file.schema()]
    value: Any = document
    for step in place:
        if isinstance(step, int):
            nodes = [node["items"] for parent in nodes for node in _alternatives(parent) if "items" in node]
        else:
            tables = [parent for node in nodes for parent in _alternatives(node) if _is_table(parent)]
            table = _chosen(tables, value) or {}
            inner = table.get("properties", {}).get(step, table.get("additionalProperties"))
            nodes = [inner] if isinstance(inner, Mapping) else []
        value = child(value, (step,))
    return [parent for node in nodes for parent in _alternatives(node) if _is_table(parent)]


def _more_at(document: Any, place: Place) -> Node | None:
    """Schema of the values of a table with any keys."""
    table = _chosen(_tables_at(document, place), child(document, place)) or {}
    more = table.get("additionalProperties")
    return more if isinstance(more, Mapping) else None


def _alternatives(node: Node) -> Iterator[Node]:
    """The schemas that a schema allows one of, references resolved."""
    while "$ref" in node:
        node_here = {key: value for key, value in node.items() if key != "$ref"}
        node = {**schema_file.schema()["$defs"][node["$ref"].rpartition("/")[2]], **node_here}
    choices = [*node.get("anyOf", ()), *node.get("oneOf", ())]
    if not choices:
        yield node
    shared = {key: node[key] for key in (UNIT, NAMES) if key in node}
    for choice in choices:
        yield from _alternatives({**shared, **choice})


def _is_table(node: Node) -> bool:
    return "properties" in node or isinstance(node.get("additionalProperties"), Mapping)


def _chosen(tables: Sequence[Node], value: Any) -> Node | None:
    """The table that a value is by its kind; the only one, or the one of the default kind, without a value."""
    entries = value if isinstance(value, Mapping) else {}
    fitting = [
        table for table in tables if all(entries.get(key, default) == const for key, default, const in _fixed(table))
    ]
    return max(fitting, key=lambda table: sum(key in entries for key, _, _ in _fixed(table)), default=None)


def _fixed(table: Node) -> Iterator[tuple[str, Any, Any]]:
    """Keys of a table that have one value alone: its default, and this value."""
    for key, node in table.get("properties", {}).items():
        if "const" in node:
            yield key, node.get("default"), node["const"]


def _kinds(tables: Sequence[Node]) -> dict[str, str]:
    return {
        table["properties"][KIND]["const"]: _meaning(table)
        for table in tables
        if "const" in table.get("properties", {}).get(KIND, {})
    }


def _field(key: str, node: Node, required: bool, kinds: tuple[str, ...]) -> TableField:
    """A key of a table; ``kinds`` are the types of components if the key selects one."""
    choices = list(_alternatives(node))
    full = next(_alternatives({name: value for name, value in node.items() if name not in ("anyOf", "oneOf")}))
    inner = [
        *choices,
        *(alternative for choice in choices if "items" in choice for alternative in _alternatives(choice["items"])),
    ]
    texts = kinds or tuple(
        dict.fromkeys(
            str(text)
            for alternative in choices
            for text in alternative.get(
                "enum", [alternative["const"]] if "const" in alternative else _kinds([alternative])
            )
        )
    )
    return TableField(
        key,
        _shape(choices, texts),
        _OF_KIND if kinds else _meaning(full),
        next((alternative[UNIT] for alternative in inner if UNIT in alternative), None),
        full.get("default"),
        required,
        texts,
        next((alternative[NAMES] for alternative in inner if NAMES in alternative), _NAMED.get(key, "")),
    )


def _meaning(node: Node) -> str:
    """The first paragraph of a description, without marks of code."""
    return node.get("description", "").partition("\n\n")[0].replace("``", "")


def _shape(choices: Sequence[Node], texts: Sequence[str]) -> Shape:
    types = {
        kind
        for choice in choices
        for kind in ([choice.get("type")] if isinstance(choice.get("type"), str) else choice.get("type") or [])
    }
    if texts and types <= {"string", "object", "boolean"}:
        return "switch" if types == {"boolean"} else "choice"
    if "number" in types or {"string", "integer"} <= types:
        return "number"
    for kind, shape in _SHAPES.items():
        if kind in types:
            return shape
    return "text"


def shown(value: Any) -> str:
    """Return a default as a study file gives it.
    >>> shown(True), shown(0.001), shown("cubic")
    ('true', '0.001', 'cubic')
    """
    return str(value).lower() if isinstance(value, bool) else f"{value:g}" if isinstance(value, float) else str(value)
