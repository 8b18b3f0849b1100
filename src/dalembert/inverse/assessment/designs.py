"""The result of a design: experiments, ranked by how well they identify the parameters."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.contents import Contents
from dalembert.errors import counted, listed
from dalembert.findings import Finding
from dalembert.results import EndedResult
from dalembert.stored_fields import Over, StoredParameters
from dalembert.tables import Table, cell, cells, labelled, marks, noted, shown

CRITERIA = {"D": "geometric mean of the standard deviations", "E": "largest standard deviation"}


@dataclass(frozen=True, eq=False)
class Designs(EndedResult):
    """Experiments, the best first: those that leave fewer combinations undetermined, then those of the smaller score.

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
        In p/scale; infinite where a combination is not determined.
    unseen : array of int, shape (designs,)
        Number of combinations of the parameters that do not change the response.
    deviations : array, shape (designs, parameters)
        Standard deviations to be expected.
    singular_values : array, shape (designs, parameters)
        Of W^½ ∂R/∂p · scale, with the priors.
    simulations : int
    provenance : mapping
    """

    FORMAT: ClassVar[str] = "dalembert designs 1"
    TITLE: ClassVar[str] = "Design of the experiment"
    VERDICTS: ClassVar[tuple[str, str]] = ("ranked", "not ranked")

    parameters: StoredParameters
    at: Annotated[np.ndarray, Over("parameter")]
    criterion: str
    noise: Mapping[str, float]
    along: str
    unit: str
    sensors: tuple[tuple[str, ...], ...]
    horizons: Annotated[np.ndarray, Over("design")]
    samples: Annotated[np.ndarray, Over("design")]
    scores: Annotated[np.ndarray, Over("design")]
    unseen: Annotated[np.ndarray, Over("design")]
    deviations: Annotated[np.ndarray, Over("design", "parameter")]
    singular_values: Annotated[np.ndarray, Over("design", "combination")]
    simulations: int
    provenance: Mapping[str, Any]

    @property
    def success(self) -> bool:
        """Return True if one of the designs identifies all parameters."""
        return bool(self.unseen[0] == 0)

    def named(self, place: int) -> str:
        """A design in words, for example ``"x and y until time 2 s"``."""
        end = f"{self.along} {self.horizons[place]:.6g} {self.unit}".rstrip()
        return f"{listed(self.sensors[place])} until {end}"

    @property
    def outcome(self) -> tuple[Finding, ...]:
        """The best design, how much worse the others are, and which are not sufficient."""
        return tuple(self._outcome())

    def _outcome(self) -> Iterator[Finding]:
        if not self.success:
            lost = int(self.unseen[0])
            mixed = zip(self.parameters.names, np.isinf(self.deviations[0]), strict=True)
            names = listed([repr(name) for name, free in mixed if free])
            message = (
                f"No design identifies all parameters: even the best one, {self.named(0)}, does not determine "
                f"{counted(lost, 'combination')} of {names}."
            )
            advice = f"Measure other channels, or fix one of {names} for each combination."
            yield Finding("insufficient-design", "error", {"combinations": lost}, message, advice)
            return
        best, score = self.named(0), float(self.scores[0])
        message = f"The best design is {best}: {CRITERIA[self.criterion]} {score:.3g} of the scales."
        yield Finding("best-design", "note", {"design": best, "score": score}, message)
        enough = np.flatnonzero(self.unseen == 0)
        if len(enough) > 1:
            last, ratio = self.named(int(enough[-1])), float(self.scores[enough[-1]] / score)
            message = f"{last} is {ratio:.3g} times worse."
            yield Finding("worst-design", "note", {"design": last, "ratio": ratio}, message)
        lost = len(self.scores) - len(enough)
        if lost:
            message = f"{counted(lost, 'design')} would leave a combination of the parameters unidentifiable."
            yield Finding("unusable-designs", "note", {"designs": lost}, message)
        widths = (self.parameters.upper - self.parameters.lower) / np.sqrt(12)
        weak = [name for name, ill in zip(self.parameters.names, self.deviations[0] > widths, strict=True) if ill]
        if weak:
            yield Finding(
                "weakly-identifiable-parameter",
                "warning",
                {"parameter": ", ".join(weak)},
                f"Even the best design hardly identifies {listed(list(map(repr, weak)))}.",
                "Measure more exactly, or longer.",
            )
        at = listed([f"{name} = {value:.6g}" for name, value in self.parameters.mapping(self.at).items()])
        advice = "Compare designs elsewhere too if the true values may be far from these."
        yield Finding("local-design", "note", {}, f"The ranking holds near {at}.", advice)

    def facts(self) -> dict[str, str]:
        return {
            "best sensors": ", ".join(self.sensors[0]),
            f"until {self.along}": f"{shown(float(self.horizons[0]))} {self.unit}".rstrip(),
            "criterion": self.criterion,
            "designs": str(len(self.scores)),
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the designs, the best first."""
        lost = list(map(int, self.unseen))
        columns = {
            "rank": range(1, len(self.scores) + 1),
            "sensors": map(", ".join, self.sensors),
            labelled(self.along, self.unit): self.horizons,
            "score": [cell(score, digits=4, mark=count > 0) for score, count in zip(self.scores, lost, strict=True)],
            **{
                f"± {labelled(item.name, item.unit)}": cells(deviations, 3)
                for item, deviations in zip(self.parameters, self.deviations.T, strict=True)
            },
            "note": marks(f"{count} unseen" if count else "" for count in lost),
        }
        caption = "Designs, the best first, with the deviations to be expected"
        return (noted(Table.of("designs", caption, columns)),)

    def contents(self) -> Contents:
        contents = super().contents()
        horizons = ("design", self.horizons, {"units": self.unit})
        return replace(contents, variables={**contents.variables, "horizons": horizons})
