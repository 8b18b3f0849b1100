"""What a small study for reports is, and what it must provoke."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Case:
    """What a study gives, the sentences that its report or summary must say, and the figures that it must show.

    ``make`` returns a result, or a result and the options of its report; text alone where there is no report.
    """

    make: Callable[[], Any]
    says: tuple[str, ...]
    shows: tuple[str, ...] = ()
    options: dict[str, Any] = field(default_factory=dict)
