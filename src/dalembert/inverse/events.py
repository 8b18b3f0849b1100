"""Events of an identification, one dataclass each, for progress bar, log and result."""

from collections.abc import Callable
from dataclasses import asdict, dataclass, fields, is_dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.optimize import RegularisedStep


@dataclass(frozen=True, eq=False)
class StartBegan:
    """A start sets out; ``values`` (parameters,) is where, or None where the method scatters its own points."""

    kind: ClassVar[str] = "start-began"
    start: int
    simulations: int
    values: np.ndarray | None


@dataclass(frozen=True, eq=False)
class Screened:
    """Points spread over the bounds were simulated to choose starts from; ``best`` is the lowest misfit among them."""

    kind: ClassVar[str] = "screened"
    points: int
    failed: int
    simulations: int
    best: float


@dataclass(frozen=True, eq=False)
class Sampled:
    """A surrogate has ``runs`` simulations behind it, and asks for more until it is good enough."""

    kind: ClassVar[str] = "sampled"
    runs: int
    simulations: int


@dataclass(frozen=True, eq=False)
class Checked:
    """True runs where a surrogate has its minima and maxima: their misfit, and the surrogate's largest error there."""

    kind: ClassVar[str] = "checked"
    runs: int
    simulations: int
    misfit: float
    error: float


@dataclass(frozen=True, eq=False)
class Paved:
    """Boxes of a paving so far: in the set, on its boundary, and still to be looked at."""

    kind: ClassVar[str] = "paved"
    inside: int
    boundary: int
    waiting: int


@dataclass(frozen=True, eq=False)
class Profiled:
    """A profile likelihood has one more value of a parameter: how much worse it explains the data."""

    kind: ClassVar[str] = "profiled"
    parameter: str
    excess: float
    simulations: int


@dataclass(frozen=True, eq=False)
class Drawn:
    """A sampler has some of the draws of all chains, those of the warm-up included."""

    kind: ClassVar[str] = "drawn"
    draws: int
    of: int


@dataclass(frozen=True, eq=False)
class Penalised:
    """A gradient of a penalised misfit was computed, in a round of at most ``of``, with the weight of the round."""

    kind: ClassVar[str] = "penalised"
    round: int
    of: int
    weight: float
    simulations: int


@dataclass(frozen=True, eq=False)
class SearchIteration:
    """One iteration of one start.

    Parameters
    ----------
    start, iteration : int
    simulations : int
        Spent so far by the whole identification; a response with its sensitivities counts as 1 + parameters.
    best : float
        Lowest misfit of this start so far, over its first ``samples`` samples; of segments that need not meet yet,
        their misfit.
    values : array, shape (parameters,)
        Where it was found.
    samples : int
        Samples compared; fewer than all while the horizon still grows.
    regularised : RegularisedStep, optional
        How response sensitivity took the step that led there.
    gap : float, optional
        Of multiple shooting, the largest gap between two segments, in parts of the states' ranges.
    minimised : float, optional
        Of multiple shooting, what is made least: the misfit and the weighted squares of the gaps. Their weight grows
        from rung to rung, and with it the misfit.
    of : int, optional
        Samples that are compared in the end.
    """

    kind: ClassVar[str] = "iteration"
    start: int
    iteration: int
    simulations: int
    best: float
    values: np.ndarray
    samples: int
    regularised: RegularisedStep | None = None
    gap: float | None = None
    minimised: float | None = None
    of: int | None = None


@dataclass(frozen=True, eq=False)
class StartEnd:
    """How one start ended.

    Parameters
    ----------
    start, end : array, shape (parameters,)
        NaN where a swarm scattered its own points.
    misfit : float
        Over all samples; infinite for a start that failed.
    success : bool
    message : str
    simulations : int
        Spent by this start alone.
    """

    kind: ClassVar[str] = "start-ended"
    start: np.ndarray
    end: np.ndarray
    misfit: float
    success: bool
    message: str
    simulations: int


@dataclass(frozen=True, eq=False)
class Finished:
    """The identification is done."""

    kind: ClassVar[str] = "finished"
    success: bool
    status: str
    misfit: float
    values: np.ndarray
    simulations: int


Event = (
    StartBegan
    | Screened
    | Sampled
    | Checked
    | Paved
    | Profiled
    | Drawn
    | Penalised
    | SearchIteration
    | StartEnd
    | Finished
)
OnEvent = Callable[[Event], None]


def as_record(event: Event) -> dict[str, Any]:
    """The event as a mapping that JSON can hold: ``event`` names its kind, a number that is not finite becomes None.

    >>> as_record(SearchIteration(0, 1, 3, float("inf"), np.array([0.5]), 41))["best"] is None
    True
    >>> as_record(Screened(16, 0, 19, 0.5))
    {'event': 'screened', 'points': 16, 'failed': 0, 'simulations': 19, 'best': 0.5}
    """
    return {"event": event.kind} | {field.name: _plain(getattr(event, field.name)) for field in fields(event)}


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return [_plain(entry) for entry in value.tolist()]
    if is_dataclass(value) and not isinstance(value, type):
        return {name: _plain(entry) for name, entry in asdict(value).items()}
    return None if isinstance(value, float) and not np.isfinite(value) else value
