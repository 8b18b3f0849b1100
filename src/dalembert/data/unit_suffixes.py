"""Units by the last part of the names of columns, such as ``angle_deg`` and ``time_ms``."""

import re

NAMED = {
    "s": "s", "sec": "s", "ms": "ms", "us": "us", "µs": "us", "ns": "ns", "deg": "deg", "degree": "deg",
    "degrees": "deg", "rad": "rad", "mm": "mm", "cm": "cm", "m": "m", "um": "um", "rpm": "rpm", "n": "N", "kn": "kN",
    "nm": "N*m", "hz": "Hz", "khz": "kHz", "mps": "m/s", "degps": "deg/s", "dps": "deg/s", "radps": "rad/s",
}  # fmt: skip
"""Units by the last part of a name in lower case."""

SURE = {
    "rad": ("deg",),
    "m": ("mm", "um"),
    "rad/s": ("rpm", "deg/s"),
    "N": ("kN",),
    "s": ("ms", "us", "ns"),
    "Hz": ("kHz",),
}
"""Units that nothing but a unit is called, by what they measure. The centre of mass is called cm, too."""


def suffix(name: str) -> str:
    """Return the unit at the end of a name; ``""`` if there is none.

    >>> suffix("angle_deg"), suffix("ms"), suffix("x"), suffix("m"), suffix("rod.end.x")
    ('deg', 'ms', '', '', '')
    """
    first, _, last = re.sub(r"[\s.\-]", "_", name.strip().lower()).rpartition("_")
    return NAMED.get(last, "") if first or len(last) > 1 else ""


def sure_suffix(name: str, along: str = "") -> str:
    """Return the unit at the end of a name that needs no confirmation; ``""`` if there is none.

    Parameters
    ----------
    name : str
    along : str
        SI unit of the samples' coordinate if it is their column, ``"s"`` or ``"Hz"``.

    Examples
    --------
    >>> sure_suffix("angle_deg"), sure_suffix("x_cm"), sure_suffix("t_ms"), sure_suffix("t_ms", "s")
    ('deg', '', '', 'ms')
    """
    unit = suffix(name)
    kinds = (along,) if along else [kind for kind in SURE if kind not in ("s", "Hz")]
    return unit if any(unit in SURE.get(kind, ()) for kind in kinds) else ""
