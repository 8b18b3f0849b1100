"""Units by the last part of the names of columns, such as ``angle_deg`` and ``time_ms``."""

import re

NAMED = {
    "s": "s", "sec": "s", "ms": "ms", "us": "us", "µs": "us", "ns": "ns", "deg": "deg", "degree": "deg",
    "degrees": "deg", "rad": "rad", "mm": "mm", "cm": "cm", "m": "m", "um": "um", "rpm": "rpm", "n": "N", "kn": "kN",
    "nm": "N*m", "hz": "Hz", "khz": "kHz", "mps": "m/s", "degps": "deg/s", "dps": "deg/s", "radps": "rad/s",
}  # fmt: skip
"""Units by the last part of a name in lower case."""

QUOTIENTS = {
    "deg_s": "deg/s", "deg_per_s": "deg/s", "deg_s2": "deg/s^2", "rad_s": "rad/s", "rad_per_s": "rad/s",
    "rad_s2": "rad/s^2", "mm_s": "mm/s", "mm_per_s": "mm/s", "mm_s2": "mm/s^2", "m_s": "m/s", "m_per_s": "m/s",
    "m_s2": "m/s^2",
}  # fmt: skip
"""Units by the last parts of a name."""

SURE = {
    "rad": ("deg",),
    "m": ("mm", "um"),
    "rad/s": ("rpm", "deg/s"),
    "rad/s^2": ("deg/s^2",),
    "m/s": ("mm/s",),
    "m/s^2": ("mm/s^2",),
    "N": ("kN",),
    "s": ("ms", "us", "ns"),
    "Hz": ("kHz",),
}
"""Units that nothing but a unit is called, by what they measure. The centre of mass is called cm, too."""


def suffix(name: str) -> str:
    """Return the unit at the end of a name; ``""`` if there is none.

    >>> suffix("angle_deg"), suffix("ms"), suffix("x"), suffix("m"), suffix("rod.end.x"), suffix("gyro_deg_s")
    ('deg', 'ms', '', '', '', 'deg/s')
    """
    plain = re.sub(r"[\s.\-]", "_", name.strip().lower())
    for quotient, unit in QUOTIENTS.items():
        if plain.endswith(f"_{quotient}"):
            return unit
    first, _, last = plain.rpartition("_")
    return NAMED.get(last, "") if first or len(last) > 1 else ""


def sure_suffix(name: str, along: str = "") -> str:
    """Return the unit at the end of a name that needs no confirmation; ``""`` if there is none. ``along``: SI unit of
    the samples' coordinate if the name is that of its column, ``"s"`` or ``"Hz"``.

    >>> sure_suffix("angle_deg"), sure_suffix("x_cm"), sure_suffix("t_ms"), sure_suffix("t_ms", "s")
    ('deg', '', '', 'ms')
    """
    unit = suffix(name)
    kinds = (along,) if along else [kind for kind in SURE if kind not in ("s", "Hz")]
    return unit if any(unit in SURE.get(kind, ()) for kind in kinds) else ""
