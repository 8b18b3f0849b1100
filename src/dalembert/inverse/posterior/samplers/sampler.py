"""What every sampler of a posterior offers."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import ClassVar, TypeAlias

import numpy as np

from dalembert.arguments import Checked
from dalembert.findings import Finding
from dalembert.inverse.posterior.modes import PosteriorModes
from dalembert.inverse.posterior.posed import Length
from dalembert.inverse.posterior.target import Target

# Called with the number of draws that were added, of all chains and in the warm-up too, and of those in the end.
OnDraws: TypeAlias = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class Chains:
    """Draws of several chains."""

    places: np.ndarray  # (chains, draws, parameters): in the coordinates of the target
    log_density: np.ndarray  # (chains, draws): of the target
    statistics: Mapping[str, np.ndarray] = field(default_factory=dict)  # of the sampler, by the names that ArviZ uses
    simulations: int = 0  # those that the problem's journal has not counted
    findings: tuple[Finding, ...] = ()  # what only the sampler knows


def moved(places: np.ndarray, target: Target, to: Target) -> np.ndarray:
    """Places of a target in the coordinates of another one with the same density, both (..., parameters)."""
    return places if target is to else to.places(target.points(places))


@dataclass(frozen=True)
class Sampler(Checked, ABC):
    """Base of the samplers; a subclass with a ``name`` needs no other registration."""

    name: ClassVar[str]
    gradients: ClassVar[bool]
    """Whether it needs gradients."""
    jumps: ClassVar[bool] = False
    """Whether it jumps between modes."""

    def check(self) -> None:
        """Refuse where a package that it needs is not installed."""

    @abstractmethod
    def sampled(self, modes: PosteriorModes, length: Length, on_draws: OnDraws) -> Chains:
        """Sample from starts in all modes; places are in the coordinates of the best mode."""
