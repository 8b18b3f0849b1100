"""Events of a propagation, one dataclass each, for progress bar and log."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, ClassVar


@dataclass(frozen=True)
class Began:
    """A method sets out; ``most`` runs are known from the start, or None where the method finds out by itself."""

    kind: ClassVar[str] = "method-began"
    method: str
    most: int | None


@dataclass(frozen=True)
class Ran:
    """A batch of runs is done: ``runs`` by this method so far, a response with its sensitivities as 1 + parameters."""

    kind: ClassVar[str] = "ran"
    method: str
    runs: int
    failed: int
    most: int | None


@dataclass(frozen=True)
class Ended:
    """A method is done."""

    kind: ClassVar[str] = "method-ended"
    method: str
    success: bool
    status: str
    runs: int
    seconds: float


Event = Began | Ran | Ended
OnEvent = Callable[[Event], None]


def as_record(event: Event) -> dict[str, Any]:
    """The event as a mapping that JSON can hold: ``event`` names its kind.

    >>> as_record(Ran("vertex", 4, 0, 4))
    {'event': 'ran', 'method': 'vertex', 'runs': 4, 'failed': 0, 'most': 4}
    """
    return {"event": event.kind} | asdict(event)
