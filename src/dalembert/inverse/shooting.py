"""Multiple shooting: chaotic motion is fitted in short segments first, which merge into longer ones."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from dalembert.data import Measurements
from dalembert.errors import InputError, unknown
from dalembert.forward import ForwardModel
from dalembert.inverse.fit import Fit
from dalembert.inverse.identify import identify
from dalembert.inverse.matching import check_samples, columns_of
from dalembert.inverse.segments import Segments, State
from dalembert.optimize import LeastSquares

LEADING = LeastSquares(trials=50, tolerance=1e-6, gain=1e-3)
"""Of the fits in segments, which only lead the way."""


def shooting(
    model: ForwardModel,
    data: Measurements,
    states: Mapping[str, State],
    *,
    segments: int = 8,
    tightness: float = 0.01,
    **options: Any,
) -> Fit:
    """Parameters and initial state of a chaotic motion, in which a single run soon forgets where it began.

    The motion is cut into segments with initial states of their own, which nearly meet; every two neighbours are then
    merged, each time from where the last fit ended, until one run explains all samples.

    Parameters
    ----------
    model : ForwardModel
        Autonomous: what comes next depends on the state alone. Its samples are even, and begin with the motion.
    data : Measurements
        With deviations.
    states : mapping of str to State
        All parameters of the initial state, and the channels of the model that are the state later.
    segments : int
        To begin with; a power of 2, each of them short enough not to be chaotic.
    tightness : float
        Standard deviation of the gaps between segments, as a part of the states' ranges.
    **options
        Of :func:`dalembert.identify` for the last fit, which is that of one run.

    Returns
    -------
    Fit
        Of the whole motion by one run; its simulations are those of the last fit.

    Raises
    ------
    InputError
        For a number of segments that does not halve, samples that are not even, unknown parameters or channels.

    Notes
    -----
    Source: H. G. Bock, Recent advances in parameter identification for ordinary differential equations, 1983; here the
    segments meet by penalty and merge, in place of exact constraints.
    """
    cuts = _cuts(model, data, states, segments)
    found: dict[str, float] = dict(zip(model.parameters.names, model.parameters.start.tolist(), strict=True))
    found |= {} if "start" not in options else model.parameters.mapping(model.parameters.vector(options.pop("start")))
    measured = dict(zip(data.channels, data.continuous.T, strict=True))
    while len(cuts) > 2:
        pieces = Segments(model, states, data.channels, cuts)
        for cut in cuts[1:-1]:
            for name, state in states.items():
                seen = measured[state.channel][cut] if state.channel in measured else np.nan
                guess = seen if np.isfinite(seen) else (state.lower + state.upper) / 2
                found.setdefault(f"{name} at {cut}", float(np.clip(guess, state.lower, state.upper)))
        start = {name: found[name] for name in pieces.parameters.names}
        leading = identify(pieces, pieces.data(data, tightness), method=LEADING, start=start, starts=1, horizon=None)
        found |= leading.estimates
        cuts = cuts[::2]
    start = {name: found[name] for name in model.parameters.names}
    return identify(model, data, start=start, **{"starts": 1, "horizon": None, **options})


def _cuts(model: ForwardModel, data: Measurements, states: Mapping[str, State], segments: int) -> np.ndarray:
    """Samples at which the segments begin and end, after checks."""
    columns_of(model, data)
    check_samples(model, data)
    if segments < 2 or segments & (segments - 1):
        raise InputError(f"shooting: segments is {segments}; expected a power of 2, such as 8, so that they can merge")
    if data.deviations is None:
        raise InputError("shooting: the data have no deviations, which say how closely segments must meet; give them")
    along = data.coordinate
    apart = np.diff(along.values)
    if np.ptp(apart) > 1e-9 * np.mean(apart):
        raise InputError(
            f"shooting: the samples are between {np.min(apart):.6g} and {np.max(apart):.6g} {along.unit} apart; "
            "expected even ones, so that each segment is like the beginning; resample the data"
        )
    names = [channel.name for channel in model.channels]
    for name, state in states.items():
        if name not in model.parameters.names:
            raise InputError(unknown("parameter", name, model.parameters.names, "shooting, states"))
        if state.channel not in names:
            raise InputError(unknown("channel", state.channel, names, f"shooting, state {name!r}"))
    if len(along.values) <= 2 * segments:
        raise InputError(
            f"shooting: {len(along.values)} samples are too few for {segments} segments; expected more than two each"
        )
    return np.rint(np.linspace(0, len(along.values) - 1, segments + 1)).astype(int)
