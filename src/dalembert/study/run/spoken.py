"""Durations and sizes in words."""

DAY = 86_400.0
"""Seconds."""


def spoken(seconds: float) -> str:
    """A duration as people say it, to two digits.

    >>> [spoken(value) for value in (2.345e-4, 0.1234, 41.7, 250.0, 7400.0)]
    ['0.23 ms', '0.12 s', '42 s', '4.2 min', '2.1 h']
    >>> [spoken(value) for value in (9e5, 1.33e9, 1e15)]
    ['10 days', '42 years', '3.2e+07 years']
    """
    units = ((365.25 * DAY, " years"), (DAY, " days"), (3600.0, " h"), (60.0, " min"), (1.0, " s"))
    for size, unit in units:
        if seconds >= 2 * size:
            number = seconds / size
            return f"{number:.0f}{unit}" if 9.95 <= number < 1e4 else f"{number:.2g}{unit}"
    return f"{seconds:.2g} s" if seconds >= 0.01 else f"{1e3 * seconds:.2g} ms"


def spoken_size(size: float) -> str:
    """A size in bytes as people say it, to two digits.

    >>> [spoken_size(value) for value in (512, 48_000, 2.4e8, 3.1e12)]
    ['0.51 kB', '48 kB', '240 MB', '3.1 TB']
    """
    for unit in ("kB", "MB", "GB", "TB"):
        size /= 1000
        if size < 999.5 or unit == "TB":
            break
    return f"{float(f'{size:.2g}'):g} {unit}"
