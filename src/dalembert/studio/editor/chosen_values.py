"""Values of parameters, written into the text of a study."""

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from dalembert.errors import InputError
from dalembert.units import is_quantity, si

NUMBER = re.compile(r"\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*")


def use_as_start(document: Any, values: Mapping[str, float]) -> None:
    """Write values by name (SI units) as first guesses of parameters.

    Examples
    --------
    >>> import tomlkit
    >>> document = tomlkit.parse('[parameters]\\nk = { lower = "1 kN/m", upper = "9 kN/m" } # of the spring\\n')
    >>> use_as_start(document, {"k": 4250.0})
    >>> print(tomlkit.dumps(document).splitlines()[1])
    k = { lower = "1 kN/m", upper = "9 kN/m", start = "4.25 kN/m" } # of the spring
    """
    for name, value in values.items():
        table = _table(document, name)
        with _spaced(table):
            table["start"] = written(value, table.get("start", table["lower"]))


def use_as_value(document: Any, name: str, value: float) -> None:
    """Fix a parameter at a value (SI units): both bounds become equal, and the other numbers are left out.

    Examples
    --------
    >>> import tomlkit
    >>> document = tomlkit.parse('[parameters]\\nangle = { lower = 0.6, upper = 1.0, start = 0.7 } # rad\\n')
    >>> use_as_start(document, {"angle": 0.75})
    >>> use_as_value(document, "angle", 0.8)
    >>> print(tomlkit.dumps(document).splitlines()[1])
    angle = { lower = 0.8, upper = 0.8 } # rad
    >>> document = tomlkit.parse('[parameters.angle]\\nlower = 0.6 # rad\\nupper = 1.0\\nstart = 0.7\\n')
    >>> use_as_value(document, "angle", 0.8)
    >>> print(tomlkit.dumps(document).strip())
    [parameters.angle]
    lower = 0.8 # rad
    upper = 0.8
    """
    table = _table(document, name)
    with _spaced(table):
        for key in ("start", "deviation"):
            table.pop(key, None)
    for key in ("lower", "upper"):
        table[key] = written(value, table[key])


def written(value: float, like: object) -> float | str:
    """Return a value (SI units) as another one is written: as a number, or with its unit.

    Examples
    --------
    >>> written(4250.0, "1 kN/m"), written(0.7853981, "pi/4"), written(25.0, 20.0)
    ('4.25 kN/m', 0.785398, 25.0)
    """
    number = float(f"{value:.6g}")
    if not isinstance(like, str) or not is_quantity(like):
        return number
    unit = NUMBER.sub("", like, count=1)
    text = f"{value / si(f'1 {unit}', None):.6g} {unit}"
    return text if abs(si(text, None) - value) <= 1e-5 * abs(value) else number


@contextmanager
def _spaced(table: Any) -> Iterator[None]:
    """Keep the space before the bracket of a table in one line, which keys that come or go would change."""
    spaced = table.as_string().endswith(" }")
    yield
    while table.as_string().endswith("  }"):
        table.value.body.pop()
    if spaced and not table.as_string().endswith(" }"):
        table.value.body[-1][1].trivia.trail = " "


def _table(document: Any, name: str) -> Any:
    try:
        return document["parameters"][name]
    except KeyError:
        raise InputError(f"There is no parameter {name!r} in [parameters]. Add it there.") from None
