"""Pose an identification: model, data, weights and loss as a misfit problem."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data import Measurements
from dalembert.errors import InputError, require_known
from dalembert.forward import Executor, ForwardModel
from dalembert.forward.adjoint import GRADIENTS
from dalembert.inverse.events import OnEvent
from dalembert.inverse.experiments.experiment import Experiment, ExperimentPart
from dalembert.inverse.experiments.experiments import begun, placed
from dalembert.inverse.experiments.joined import joined
from dalembert.inverse.noise.likelihood.placing import Noise
from dalembert.inverse.noise.noise_floor import NoiseFloor, noise_floor
from dalembert.inverse.noise.smoothed import smooth_noise
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.loss import loss_of
from dalembert.inverse.problem.matching import weights_of
from dalembert.inverse.problem.problem import MisfitProblem, pose
from dalembert.inverse.validation.validation import HeldOut, Split, split


@dataclass(frozen=True, eq=False)
class PosedIdentification:
    """A misfit problem, the part of it that is fitted, and the noise that its data are known to have."""

    # model, data: as they were given, the model first built where the search starts.
    model: ForwardModel | Sequence[Experiment]
    data: Measurements | None
    parts: tuple[ExperimentPart, ...]
    split: Split
    validation: HeldOut
    first_point: np.ndarray  # search point (parameters,) of the first guesses
    floor: NoiseFloor  # of the fitted part
    noise: Noise | None  # to estimate with the parameters
    smooth_noise: np.ndarray | None  # deviations (channels,) that local polynomials give to data without any
    noise_is_given: bool  # whether the weights follow from standard deviations of the data
    weights_source: str  # "noise", "given", "data" or "smoothed"

    @property
    def whole(self) -> MisfitProblem:
        """The problem of all data."""
        return self.split.whole

    @property
    def problem(self) -> MisfitProblem:
        """The problem of the fitted part of the data."""
        return self.split.part


def pose_identification(
    model: ForwardModel | Sequence[Experiment],
    data: Measurements | None,
    *,
    start: Mapping[str, float] | ArrayLike | None,
    weights: ArrayLike | Mapping[str, ArrayLike] | None,
    noise: Noise | None,
    loss: str,
    loss_scale: float | None,
    validation: HeldOut,
    shooting: object,
    derivative: str,
    on_event: OnEvent | None,
    executor: Executor,
) -> PosedIdentification:
    """Return the problem of a model, or of experiments, by the arguments of :func:`dalembert.identify`."""
    if shooting is not None and validation is not None:
        raise InputError(
            "shooting: validation was given, but a chaotic motion cannot be predicted; leave one of the two out"
        )
    require_known("derivative", str(derivative), GRADIENTS)
    model = begun(placed(model, executor), start)
    joint, measured, weights, parts = joined("identify", model, data, weights)
    counted, weights = (None, weights) if noise is None else (_counted_values(weights, measured), None)
    _check_noise(noise, loss=loss, shooting=shooting)
    deviations_are_known = measured.deviations is not None and weights is None
    smoothing = shooting is not None or (noise is not None and len(joint.parameters.square_priors) > 0)
    smooth = smooth_noise(measured, parts) if smoothing and not deviations_are_known and weights is None else None
    journal = Journal(len(measured.coordinate.values), on_event)
    weighed = weights if smooth is None else np.broadcast_to(smooth**-2.0, measured.values.shape)
    whole = replace(
        pose(joint, measured, weighed, journal, noise_known=noise is not None),
        loss=loss_of(loss, loss_scale, known=deviations_are_known),
        derivative=derivative,
    )
    parted = split(whole if counted is None else replace(whole, weights=whole.weights * counted), validation)
    problem, journal.samples = parted.part, parted.part.samples
    first = problem.model.parameters.start_vector(joint.parameters.start if start is None else start)
    usual = "data" if smooth is None else "smoothed"
    return PosedIdentification(
        model=model,
        data=data,
        parts=parts,
        split=parted,
        validation=validation,
        first_point=problem.search.points(first),
        floor=noise_floor(problem, smooth),
        noise=noise,
        smooth_noise=smooth,
        noise_is_given=deviations_are_known,
        weights_source="noise" if noise is not None else usual if weights is None else "given",
    )


def _counted_values(weights: ArrayLike | None, data: Measurements) -> np.ndarray | None:
    """Return which values count, 1 or 0, beside a noise model, from which all other weights follow."""
    if weights is None:
        return None
    counted = weights_of(weights, data.values.shape)
    other = counted[(counted != 0) & (counted != 1)]
    if len(other):
        raise InputError(
            f"weights: {other[0]:.6g} was given beside a noise model, from which the weights follow; expected 1, or 0 "
            "for a value to leave out"
        )
    return counted


def _check_noise(noise: Noise | None, *, loss: str, shooting: object) -> None:
    """Refuse what cannot be combined with a noise model."""
    if noise is None:
        return
    if loss != "linear":
        raise InputError(
            f"loss: a noise model was given, whose likelihood is that of normal noise; leave the loss {loss!r} or the "
            "noise out"
        )
    if shooting is not None:
        raise InputError(
            "shooting: a noise model was given, but segments that must meet leave no likelihood of one run; leave one "
            "of the two out"
        )
