"""Samples or experiments that are not fitted, but predicted."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from dalembert.errors import InputError, require_known
from dalembert.inverse.experiments.experiment import ExperimentPart
from dalembert.inverse.experiments.experiments import JointModel
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.validation.explained import WORSE, Explained, explained, percentages
from dalembert.stored_fields import Over

HeldOut = float | str | Sequence[str] | Mapping[str, float] | None
"""Share of the samples, names of experiments, or lengths of their first parts by name, in their coordinate's unit."""


@dataclass(frozen=True, eq=False)
class Validation:
    """How well a fit predicts what it was not fitted to.

    Parameters
    ----------
    what : str
        What was not fitted, in words.
    weights : array, shape (samples, channels)
        W of the values that were not fitted, 0 for the others.
    misfit, fitted : float
        Root mean square of W^½ (R − data) over the values that were not fitted, and over those that were.
    explained : tuple of Explained
        Share of the variation that the response explains, of each record and channel.
    covered : float
        Share of the values that were not fitted which lie inside their 95 % bands; NaN without bands.
    """

    what: str
    weights: Annotated[np.ndarray, Over("sample", "channel", name="validation_weights")]
    misfit: float
    fitted: float
    explained: tuple[Explained, ...] = ()
    covered: float = np.nan

    def __str__(self) -> str:
        covered = f"The 95 % bands contain {100 * self.covered:.3g} % of these values."
        texts = [self._compared, percentages(self.explained), "" if np.isnan(self.covered) else covered]
        return " ".join(filter(None, texts))

    @property
    def _compared(self) -> str:
        text = f"Not fitted: {self.what}. There the weighted residuals are {self.misfit:.3g} in the root mean square"
        if self.fitted == 0:
            return f"{text}, those of the fit 0."
        ratio = self.misfit / self.fitted
        advice = (
            "; the model lacks something that shows there, or the fitted data do not determine all parameters"
            if ratio > WORSE
            else ""
        )
        return f"{text}, {ratio:.3g} times those of the fit{advice}."


@dataclass(frozen=True, eq=False)
class Split:
    """A problem, the part of it that is fitted, and what the other part is, in words.

    ``fitted`` (samples, channels) masks the values of the whole problem that are fitted.
    """

    whole: MisfitProblem
    part: MisfitProblem
    fitted: np.ndarray
    what: str

    def validation(self, response: np.ndarray) -> Validation | None:
        """How a response (samples, channels) predicts what was not fitted; None if all was."""
        if self.part is self.whole:
            return None
        weights = np.where(self.fitted, 0.0, self.whole.weights)
        squares = self.whole.unweighted_residual(response) ** 2
        of_fit = self.whole.weights - weights
        misfit, fitted = (
            float(np.sqrt(np.sum(weights_here * squares) / max(1, np.count_nonzero(weights_here))))
            for weights_here in (weights, of_fit)
        )
        return Validation(self.what, weights, misfit, fitted, explained(self.whole, response, weights, fitted))

    def whole_table(self, table: np.ndarray, missing: float) -> np.ndarray:
        """Return a table (samples, channels, ...) of the fitted part in one of the whole problem."""
        if self.part is self.whole:
            return table
        full = np.full((*self.whole.weights.shape, *table.shape[2:]), missing)
        columns = [self.whole.data.channels.index(name) for name in self.part.data.channels]
        full[: self.part.samples, columns] = table
        return full


def split(problem: MisfitProblem, validation: HeldOut) -> Split:
    """A problem without a share of its last samples, or without some experiments after their first parts."""
    everything = np.ones(problem.weights.shape, dtype=bool)
    if validation is None:
        return Split(problem, problem, everything, "nothing")
    if isinstance(validation, (int, float)):
        return _ends(problem, float(validation), everything)
    if isinstance(validation, str):
        validation = (validation,)
    lengths = dict(validation) if isinstance(validation, Mapping) else dict.fromkeys(validation, 0.0)
    return _experiments(problem, lengths, everything)


def _ends(problem: MisfitProblem, share: float, fitted: np.ndarray) -> Split:
    if not 0 < share < 1:
        raise InputError(f"validation is {share:g}; expected a share of the samples between 0 and 1, such as 0.25")
    kept = problem.samples - round(share * problem.samples)
    if kept < 2 or kept == problem.samples:
        raise InputError(
            f"validation is {share:g}, which leaves {kept} of {problem.samples} samples to be fitted and "
            f"{problem.samples - kept} to be predicted; expected at least 2 and 1"
        )
    fitted[kept:] = False
    along = problem.data.coordinate
    what = (
        f"what comes after {100 * along.values[kept - 1]:.3g} % of each experiment's time"
        if isinstance(problem.model, JointModel)
        else f"the last {problem.samples - kept} of {problem.samples} samples"
    )
    return Split(problem, problem.first(kept), fitted, what)


def _experiments(problem: MisfitProblem, lengths: Mapping[str, float], fitted: np.ndarray) -> Split:
    """The problem without experiments but for first parts of these lengths, in the unit of their coordinate."""
    model, names = problem.model, tuple(lengths)
    if not isinstance(model, JointModel):
        raise InputError(
            f"validation is {', '.join(map(repr, names))}, but there is one experiment; expected a share such as 0.25"
        )
    known = [part.name for part in model.parts]
    for name in names:
        require_known("experiment", name, known, "validation")
    if not names or len(names) == len(known):
        raise InputError("validation: expected at least one experiment to be fitted, and one to be predicted")
    kept = [name for name in known if name not in names or lengths[name] > 0]
    missing = np.zeros_like(fitted)
    for part in (part for part in model.parts if part.name in names):
        begun = _samples_until(part, lengths[part.name])
        missing[part.rows[begun:, None], part.columns] = True
    fitted &= ~missing
    told = {
        index for part, wiring in zip(model.parts, model.wiring, strict=True) if part.name in kept for index in wiring
    }
    for index, name in enumerate(model.parameters.names):
        if index not in told:
            raise InputError(
                f"parameter {name!r} belongs to experiments for validation alone, so that nothing determines it. Fit "
                f"the first part of one of them, as by validation={{{names[0]!r}: 0.5}}, or fix the parameter"
            )
    columns = np.concatenate([part.columns for part in model.parts if part.name in kept])
    data, weights = problem.data, np.where(missing, 0.0, problem.weights)
    channels = tuple(data.channels[column] for column in columns)
    both = ExperimentPart("", data.coordinate, channels, np.arange(problem.samples), columns)
    part = replace(
        problem,
        model=model.only(kept),
        columns=problem.columns[columns],
        weights=weights[:, columns],
        data=both.data(replace(data, values=np.where(missing, np.nan, data.values))),
    )
    return Split(problem, part, fitted, _in_words(model, lengths))


def _samples_until(part: ExperimentPart, length: float) -> int:
    """Number of samples of an experiment that is predicted which belong to its first part, which is fitted."""
    along = part.coordinate
    if length == 0:
        return 0
    count = int(np.searchsorted(along.values, along.values[0] + length, side="right"))
    if not (np.isfinite(length) and 2 <= count < len(along.values)):
        raise InputError(
            f"validation: the first {length:g} {along.unit} of experiment {part.name!r} are to be fitted, which are "
            f"{max(0, count)} of its {len(along.values)} samples. Give a length between "
            f"{along.values[1] - along.values[0]:.6g} and {along.values[-1] - along.values[0]:.6g} {along.unit}"
        )
    return count


def _in_words(model: JointModel, lengths: Mapping[str, float]) -> str:
    """What is not fitted."""
    units = {part.name: part.coordinate.unit for part in model.parts}
    texts = [
        repr(name) + (f" after its first {length:g} {units[name]}" if length else "")
        for name, length in lengths.items()
    ]
    return f"the experiment{'s' if len(texts) > 1 else ''} {', '.join(texts)}"
