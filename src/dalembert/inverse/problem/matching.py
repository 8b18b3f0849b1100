"""Whether data along a coordinate, measurements or bands, fit to a model."""

import numpy as np
from numpy.typing import ArrayLike

from dalembert.data import Bands, Measurements
from dalembert.errors import DataError, InputError, shown, unknown
from dalembert.forward import ForwardModel
from dalembert.units import wrong_kind


def check_kinds(owner: str, model: object, data: object, kind: type = Measurements) -> None:
    """Refuse what is not a model with parameters, or not data of a kind."""
    if not isinstance(model, ForwardModel):
        raise InputError(
            f"{owner}: {shown(model)} was given as the model; expected a forward model, such as TimeResponse or "
            "PythonModel"
        )
    model.parameters.check_some(owner)
    if not isinstance(data, kind):
        raise InputError(
            f"{owner}: {shown(data)} was given as the data; expected {kind.__name__}, see {kind.__name__}.of"
        )


def columns_of(model: ForwardModel, data: Measurements | Bands) -> np.ndarray:
    """Where the data's channels stand among the model's, shape (channels,)."""
    names = tuple(channel.name for channel in model.channels)
    for channel in data.channels:
        if channel not in names:
            raise DataError(unknown("channel", channel, names, "the data name a channel that the model does not give"))
    _check_kinds(model, data)
    return np.array([names.index(channel) for channel in data.channels])


def _check_kinds(model: ForwardModel, data: Measurements | Bands) -> None:
    """Refuse channels that were measured in a unit of another kind, and turns of what is no angle.

    A sensor of unknown gain may have any unit.
    """
    scaled = getattr(model, "scaled", frozenset())
    units = {channel.name: channel.unit for channel in model.channels if channel.name not in scaled}
    for channel, unit in data.source_units.items():
        if (expected := units.get(channel)) and (sentence := wrong_kind(unit, expected)):
            raise DataError(
                f"the data of channel {channel!r}: {sentence}; choose another column, or correct its unit in units"
            )
    for channel in getattr(data, "wraps", ()):
        if (expected := units.get(channel)) and wrong_kind("rad", expected):
            raise DataError(f"wraps names the channel {channel!r}, which is in {expected} and no angle; leave it out")


def check_samples(model: ForwardModel, data: Measurements | Bands) -> None:
    """Refuse data whose samples lie elsewhere than the model's."""
    ours, theirs = model.coordinate, data.coordinate
    advice = "build the model with the samples of the data"
    if len(ours.values) != len(theirs.values):
        raise DataError(
            f"the data have {len(theirs.values)} samples and the model {len(ours.values)}; expected the same; {advice}"
        )
    apart = np.abs(ours.values - theirs.values)
    if np.max(apart) > 1e-9 * max(1.0, float(np.max(np.abs(ours.values)))):
        sample = int(np.argmax(apart))
        raise DataError(
            f"sample {sample}: the data lie at {theirs.name} {theirs.values[sample]:.10g} {theirs.unit}, "
            f"the model's response at {ours.values[sample]:.10g} {ours.unit}; expected the same; {advice}"
        )


def check_finite(data: Measurements) -> None:
    """Refuse measurements with a value that is not a number, unless NaN is to be left out and something remains."""
    leave_out = data.missing == "leave-out"
    missing = np.argwhere(np.isinf(data.values) if leave_out else ~np.isfinite(data.values))
    if len(missing):
        sample, column = missing[0]
        raise DataError(
            f"channel {data.channels[column]!r}, sample {sample} ({data.coordinate.name} "
            f"{data.coordinate.values[sample]:.10g} {data.coordinate.unit}): {data.values[sample, column]}; "
            f"expected a finite number ({len(missing)} are not); leave out these samples or the channel"
        )
    empty = ~np.any(data.present, axis=0)
    if np.any(empty):
        name = data.channels[int(np.argmax(empty))]
        raise DataError(f"channel {name!r}: not one value is there; expected at least one; leave out the channel")


MOST = 1e50
"""Largest size of data, whose squares then lie well within the range of floating point; 1/MOST is the smallest."""


def check_sizes(data: Measurements) -> None:
    """Refuse values and deviations whose squares would leave the range of floating point."""
    sizes = np.max(np.abs(np.where(data.present, data.values, 0.0)), axis=0)
    limits = [("largest absolute value", sizes, 0.0, f"at most {MOST:g}")]
    if data.deviations is not None:
        limits.append(("deviation", data.deviations, 1 / MOST, f"{1 / MOST:g} to {MOST:g}"))
    for what, numbers, least, expected in limits:
        for name, number in zip(data.channels, numbers, strict=True):
            if not least <= number <= MOST:
                raise DataError(f"channel {name!r}: its {what} is {number:.3g}; expected {expected}; {UNITS}")


UNITS = "use other units"


def check_weighted(data: Measurements, weights: np.ndarray) -> None:
    """Refuse data whose weighted squares would leave the range of floating point, where they are not zero."""
    largest = float(np.max(np.sqrt(weights) * np.abs(np.where(data.present, data.values, 0.0))))
    if largest > 0 and not 1 / MOST <= largest <= MOST:
        raise DataError(
            f"the weighted data, √W·|data|, are {largest:.3g} at most; expected {1 / MOST:g} to {MOST:g}, in which "
            f"squares can be computed; {UNITS} or other weights"
        )


def weights_of(given: ArrayLike | None, shape: tuple[int, ...]) -> np.ndarray:
    """Weights of shape (samples, channels), 1 where none are given."""
    if given is None:
        return np.broadcast_to(1.0, shape)
    try:
        weights = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise InputError(
            f"weights are {shown(given)}; expected an array of numbers, (channels,) or (samples, channels)"
        ) from None
    if weights.shape not in (shape, shape[1:]):
        raise InputError(
            f"weights of shape {weights.shape} were given; expected (channels,) = {shape[1:]} or "
            f"(samples, channels) = {shape}"
        )
    wrong = weights[~(np.isfinite(weights) & (weights >= 0))]
    if len(wrong):
        raise InputError(f"weights have the value {wrong[0]:g}; expected finite numbers that are not negative")
    if not np.any(weights > 0):
        raise InputError("all weights are 0, so that nothing is fitted; expected at least one positive weight")
    return np.broadcast_to(weights, shape)


def place(data: Measurements | Bands, output: int) -> str:
    """Where one of samples × channels outputs lies, for example ``"channel 'AB.end.x', time 0.5 s"``."""
    sample, column = divmod(output, len(data.channels))
    along = data.coordinate
    return f"channel {data.channels[column]!r}, {along.name} {along.values[sample]:.6g} {along.unit}".rstrip()
