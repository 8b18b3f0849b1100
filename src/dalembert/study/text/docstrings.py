"""What the arguments of a class mean, from its docstring: the keys of study files have the same meaning."""

import inspect
import re
from collections.abc import Callable
from functools import cache
from typing import Any

_SECTION = re.compile(r"^Parameters\n-+\n(.*?)(?=\n\n\S[^\n]*\n-{3,}|\Z)", re.DOTALL | re.MULTILINE)
_ENTRY = re.compile(r"^(\w[\w, ]*) *:.*\n((?:(?:[ \t]+\S.*)?\n)*)", re.MULTILINE)
_ROLE = re.compile(r":\w+:`~?(?:[\w.]+\.)?([^`]+)`")
_UNIT = re.compile(r"^(?:(?:N|kg|m|s|rad|Pa|V|A|Ohm)(?:\^[\d()/]+|³)?[ /]?)+(?:[;.]\s+|\.$)")


@cache
def meanings(target: type) -> dict[str, str]:
    """Return the meaning of each argument of a class, without a leading unit; arguments without one are left out.
    >>> from dalembert import RigidBar
    >>> meanings(RigidBar)["angle"], "length" in meanings(RigidBar)
    ('Initial angle from the x axis, rad.', False)
    """
    section = _SECTION.search(inspect.getdoc(target) or "")
    result = {}
    for names, text in _ENTRY.findall(f"{section[1]}\n") if section else ():
        plain = _UNIT.sub("", _ROLE.sub(r"\1", " ".join(text.split())).replace("``", "").replace("\\|", "|"), count=1)
        if plain:
            result |= {name.strip(): plain[0].upper() + plain[1:] for name in names.split(",")}
    return result


def explained(meaning: str) -> Callable[[dict[str, Any]], None] | None:
    """Return a change of a key's JSON schema that puts its meaning before what is expected of it."""

    def explain(schema: dict[str, Any]) -> None:
        kinds = [schema, *schema.get("anyOf", ())]
        expected = next((kind["description"] for kind in kinds if "description" in kind), "")
        schema["description"] = f"{meaning} Expected: {expected}." if expected else meaning

    return explain if meaning else None
