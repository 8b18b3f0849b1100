"""A check of documents against the part of JSON Schema that the schema of study files uses."""

from collections.abc import Mapping
from typing import Any

_TYPES = {
    "object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "number": (int, float),
    "null": type(None),
}  # fmt: skip


def fits(value: Any, schema: Mapping[str, Any], root: Mapping[str, Any]) -> bool:
    """Whether a value is as a schema says, whose definitions are in ``root``."""
    if "$ref" in schema:
        return fits(value, root["$defs"][schema["$ref"].removeprefix("#/$defs/")], root)
    checks = [any(fits(value, one, root) for one in schema[key]) for key in ("anyOf",) if key in schema]
    checks += [sum(fits(value, one, root) for one in schema["oneOf"]) == 1] if "oneOf" in schema else []
    checks += [value == schema["const"]] if "const" in schema else []
    checks += [value in schema["enum"]] if "enum" in schema else []
    kinds = schema.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if kinds:
        is_bool = isinstance(value, bool)
        checks.append(any(isinstance(value, _TYPES[kind]) and is_bool == (kind == "boolean") for kind in kinds))
    if isinstance(value, dict):
        checks += [set(schema.get("required", ())) <= value.keys(), *_entries(value, schema, root)]
    if isinstance(value, list):
        checks += [schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value))]
        checks += [fits(entry, schema["items"], root) for entry in value if "items" in schema]
    return all(checks)


def _entries(value: dict[str, Any], schema: Mapping[str, Any], root: Mapping[str, Any]) -> list[bool]:
    known, more = schema.get("properties", {}), schema.get("additionalProperties", True)
    others = [more if isinstance(more, bool) else fits(value[key], more, root) for key in value.keys() - known.keys()]
    return [*(fits(value[key], known[key], root) for key in value.keys() & known.keys()), *others]
