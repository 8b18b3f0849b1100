"""Times of day, with or without dates, as seconds since the first of them."""

import re
from collections.abc import Sequence
from datetime import date

import numpy as np

DAY = 86_400.0
"""Seconds."""

_CLOCK = re.compile(
    r"(?:(?P<date>\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4})(?:[T\s]+|$))?"
    r"(?:(?P<hour>\d{1,2}):(?P<minute>\d{2})(?::(?P<second>\d{2}(?:[.,]\d+)?))?\s*(?P<half>[AaPp][Mm])?)?"
    r"\s*(?:Z|UTC|[+-]\d{2}:?\d{2})?"
)


def is_clock(cell: str) -> bool:
    """Return whether a text is a time of day, a date, or both.

    >>> [is_clock(text) for text in ("10:05:00.25", "2024-03-01T10:05:00Z", "1.3.2024 10:05", "10.05", "abc", "")]
    [True, True, True, False, False, False]
    """
    match = _CLOCK.fullmatch(cell.strip())
    return match is not None and (match["hour"] is not None or match["date"] is not None)


def clock_seconds(cells: Sequence[str]) -> np.ndarray | None:
    """Return seconds since the first of several times (times,); None if one is no time, or only some have a date. A
    time of day that is half a day before its predecessor is one of the next day. Of the dates ``1/2/2024`` the larger
    number is the day, and the first one where no date decides.

    >>> clock_seconds(["23:59:59,5", "00:00:00,25"]).tolist(), clock_seconds(["12:00:00 AM", "01:00:00 PM"]).tolist()
    ([0.0, 0.75], [0.0, 46800.0])
    """
    matches = [_CLOCK.fullmatch(cell.strip()) for cell in cells]
    if not cells or not all(match is not None and (match["hour"] or match["date"]) for match in matches):
        return None
    dates = [match["date"] for match in matches if match is not None]
    if len({date is None for date in dates}) > 1:
        return None
    seconds = np.array([_of_day(match) for match in matches])
    days = np.zeros(len(cells)) if dates[0] is None else _days([date for date in dates if date is not None])
    if days is None:
        return None
    if dates[0] is None:
        days = np.concatenate([[0.0], np.cumsum(np.diff(seconds) < -DAY / 2)])
    return (days - days[0]) * DAY + (seconds - seconds[0])


def _of_day(match: re.Match[str] | None) -> float:
    if match is None or match["hour"] is None:
        return 0.0
    hour = int(match["hour"])
    if match["half"]:
        hour = hour % 12 + 12 * (match["half"].lower() == "pm")
    return 3600.0 * hour + 60.0 * int(match["minute"]) + float((match["second"] or "0").replace(",", "."))


def _days(texts: Sequence[str]) -> np.ndarray | None:
    known = {text: tuple(map(int, re.split(r"[-/.]", text))) for text in dict.fromkeys(texts)}
    first_is_month = any(parts[1] > 12 for parts in known.values())
    try:
        days = {text: _day(parts, first_is_month=first_is_month) for text, parts in known.items()}
    except ValueError:
        return None
    return np.array([days[text] for text in texts], dtype=float)


def _day(parts: tuple[int, ...], *, first_is_month: bool) -> int:
    first, two, three = parts
    if first > 31:
        return date(first, two, three).toordinal()
    year = three if three > 99 else 2000 + three
    return (date(year, first, two) if first_is_month else date(year, two, first)).toordinal()
