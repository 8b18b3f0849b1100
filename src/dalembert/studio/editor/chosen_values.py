"""Values of parameters, written into the text of a study."""

from collections.abc import Mapping
from typing import Any

from dalembert.errors import InputError
from dalembert.studio.editor.entries import like, put


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
        put(document["parameters"], name, start=like(table.get("start", table["lower"]), value))


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
    bounds = {key: like(_table(document, name)[key], value) for key in ("lower", "upper")}
    put(document["parameters"], name, **bounds, start=None, deviation=None)


def _table(document: Any, name: str) -> Any:
    try:
        return document["parameters"][name]
    except KeyError:
        raise InputError(f"There is no parameter {name!r} in [parameters]. Add it there.") from None
