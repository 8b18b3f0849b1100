"""The result of a design: experiments in order of what they would tell."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from dalembert.contents import Contents
from dalembert.errors import listed
from dalembert.inverse.fit.summary import table
from dalembert.parameters import Parameter, Parameters
from dalembert.results import Result, facts_of, fixed_lines, stored_facts, told_of

if TYPE_CHECKING:
    from xarray import Dataset

CRITERIA = {"D": "geometric mean of the deviations", "E": "largest deviation"}


FACTS = ("criterion", "along", "unit", "simulations")


@dataclass(frozen=True, eq=False)
class Designs(Result):
    """Experiments, the best first: those that leave fewer combinations unseen, then those of the smaller score.

    Parameters
    ----------
    parameters : Parameters
    at : array, shape (parameters,)
        Where the sensitivities were taken.
    criterion : {"D", "E"}
    noise : mapping of str to float
        Standard deviation of the noise of each channel.
    along, unit : str
        What the horizons are measured along.
    sensors : tuple of tuples of str, length designs
    horizons : array, shape (designs,)
    samples : array of int, shape (designs,)
    scores : array, shape (designs,)
        In p/scale; infinite where a combination is not seen.
    unseen : array of int, shape (designs,)
        How many combinations of the parameters the response does not see.
    deviations : array, shape (designs, parameters)
        Standard deviations to be expected.
    singular_values : array, shape (designs, parameters)
        Of W^½ ∂R/∂p · scale, with the priors.
    simulations : int
    provenance : mapping
    """

    FORMAT: ClassVar[str] = "dalembert designs 1"

    parameters: Parameters
    at: np.ndarray
    criterion: str
    noise: Mapping[str, float]
    along: str
    unit: str
    sensors: tuple[tuple[str, ...], ...]
    horizons: np.ndarray
    samples: np.ndarray
    scores: np.ndarray
    unseen: np.ndarray
    deviations: np.ndarray
    singular_values: np.ndarray
    simulations: int
    provenance: Mapping[str, Any]

    @property
    def success(self) -> bool:
        """Whether one of the designs tells every parameter."""
        return bool(self.unseen[0] == 0)

    def named(self, place: int) -> str:
        """A design in words, for example ``"x and y until time 2 s"``."""
        end = f"{self.along} {self.horizons[place]:.6g} {self.unit}".rstrip()
        return f"{listed(self.sensors[place])} until {end}"

    @property
    def status(self) -> str:
        """The best design, how much worse the others are, and which tell too little, in full sentences."""
        if not self.success:
            return (
                "No design tells every parameter: the best one leaves "
                f"{_counted(int(self.unseen[0]), 'combination')} of them unseen; measure other channels, or fix "
                "parameters."
            )
        best = self.named(0)
        parts = [f"Best is {best}: {CRITERIA[self.criterion]} {self.scores[0]:.3g}, in parts of the scales."]
        told = np.flatnonzero(self.unseen == 0)
        if len(told) > 1:
            worse = self.scores[told[-1]] / self.scores[0]
            parts.append(f"{self.named(int(told[-1]))} would be {worse:.3g} times worse.")
        lost = len(self.scores) - len(told)
        if lost:
            parts.append(f"{_counted(lost, 'design')} would leave a combination of the parameters unseen.")
        widths = (self.parameters.upper - self.parameters.lower) / np.sqrt(12)
        weak = [repr(name) for name, ill in zip(self.parameters.names, self.deviations[0] > widths, strict=True) if ill]
        if weak:
            parts.append(f"Even the best design hardly tells {listed(weak)}; measure more exactly, or longer.")
        at = listed([f"{name} = {value:.6g}" for name, value in self.parameters.mapping(self.at).items()])
        return " ".join([*parts, f"This holds near {at}; look elsewhere too if the true values may lie far from it."])

    def summary(self) -> str:
        """The ranking as a text table, at most twenty designs, with its status."""
        rows = [("sensors", f"{self.along} ({self.unit})", "score", *(f"± {name}" for name in self.parameters.names))]
        for k in range(min(20, len(self.scores))):
            expected = (f"{value:.3g}" for value in self.deviations[k])
            rows.append((", ".join(self.sensors[k]), f"{self.horizons[k]:.6g}", f"{self.scores[k]:.4g}", *expected))
        more = [f"and {len(self.scores) - 20} more"] if len(self.scores) > 20 else []
        return "\n".join([*table(rows), *more, "", *fixed_lines(self), self.status])

    def contents(self) -> Contents:
        """Everything as arrays over design and parameter."""
        told = {
            "parameters": [asdict(item) for item in self.parameters.declared],
            "sensors": self.sensors,
            "noise": dict(self.noise),
            "provenance": self.provenance,
        }
        return Contents(
            {
                "at": ("parameter", self.at),
                "horizons": ("design", self.horizons, {"units": self.unit}),
                "samples": ("design", self.samples),
                "scores": ("design", self.scores),
                "unseen": ("design", self.unseen),
                "deviations": (("design", "parameter"), self.deviations),
                "singular_values": (("design", "combination"), self.singular_values),
            },
            {"parameter": ("parameter", list(self.parameters.names))},
            stored_facts(self, (*FACTS, "status"), **told),
        )

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> Self:
        """The designs that :meth:`to_xarray` turned into a dataset."""
        told = told_of(dataset)
        a: dict[str, Any] = {str(name): variable.values for name, variable in dataset.data_vars.items()}
        return cls(
            parameters=Parameters(tuple(Parameter(**item) for item in told["parameters"])),
            **facts_of(cls, dataset, FACTS),
            noise=told["noise"],
            sensors=tuple(tuple(chosen) for chosen in told["sensors"]),
            provenance=told["provenance"],
            **a,
        )


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" + ("" if number == 1 else "s")
