"""Whether a motion can be cut into segments that begin anew."""

from collections.abc import Mapping

import numpy as np

from dalembert.data import Measurements
from dalembert.errors import InputError, unknown
from dalembert.forward import ForwardModel
from dalembert.inverse.experiments import JointModel
from dalembert.inverse.problem import Problem
from dalembert.inverse.segments import State

SAME = 1e-6
"""Difference, as a part of a state's range, up to which a motion is said to begin with it."""

CONTINUED = 0.02
"""Difference, as a part of a channel's span, up to which a segment is said to continue the motion: an integrator that
begins anew differs by some of its error."""


def check_segments(
    model: ForwardModel, data: Measurements, states: Mapping[str, State], segments: int, *, weighed: bool
) -> None:
    """Refuse what cannot be cut into segments.

    Raises
    ------
    InputError
        For several experiments, data of unknown noise, samples that are not even or too few, unknown names.
    """
    if isinstance(model, JointModel):
        raise InputError("shooting: several experiments were given; expected one, or leave shooting out")
    if data.deviations is None and not weighed:
        raise InputError(
            "shooting: the data have no deviations, which say how a misfit weighs against a gap between segments; give "
            "them, or weights"
        )
    along = data.coordinate
    apart = np.diff(along.values)
    if np.ptp(apart) > 1e-9 * np.mean(apart):
        raise InputError(
            f"shooting: the samples are between {np.min(apart):.6g} and {np.max(apart):.6g} {along.unit} apart; "
            "expected even ones, so that each segment is like the beginning; resample the data"
        )
    names = [channel.name for channel in model.channels]
    for name, state in states.items():
        model.parameters.check_name(name, where="shooting, states")
        if state.channel not in names:
            raise InputError(unknown("channel", state.channel, names, f"shooting, state {name!r}"))
        if state.rate_of is not None and state.rate_of not in data.channels:
            raise InputError(unknown("channel", state.rate_of, data.channels, f"shooting, state {name!r}, rate_of"))
    if len(along.values) <= 2 * segments:
        raise InputError(
            f"shooting: {len(along.values)} samples are too few for {segments} segments; expected more than two each"
        )


def check_restart(problem: Problem, states: Mapping[str, State], segments: int, values: np.ndarray) -> None:
    """Refuse states with which a motion does not go on as it did: one run over two segments, the second one anew.

    Raises
    ------
    InputError
        Where the motion at parameters ``values`` does not begin with the given states, or a segment that begins with
        the states in its midst does not continue it. A simulation that fails says neither.
    """
    model, names = problem.model, [channel.name for channel in problem.model.channels]
    length = problem.samples // segments
    problem.journal.simulations += 1
    whole = model.first(2 * length + 1).evaluate(values[None]).values[0]
    if not np.all(np.isfinite(whole)):
        return
    again = values.copy()
    for name, state in states.items():
        place, column = model.parameters.names.index(name), names.index(state.channel)
        if abs(whole[0, column] - values[place]) > SAME * (state.upper - state.lower):
            raise InputError(
                f"shooting, state {name!r}: the motion begins with {state.channel!r} at {whole[0, column]:.6g} where "
                f"the parameter is {values[place]:.6g}; expected the same; name the channel that begins with the "
                "parameter, and give bodies velocities that go together"
            )
        again[place] = whole[length, column]
    anew = model.first(length + 1).evaluate(again[None]).values[0]
    if not np.all(np.isfinite(anew)):
        return
    apart = np.max(np.abs(anew - whole[length:]), axis=0)
    for column in np.flatnonzero(apart > CONTINUED * np.maximum(np.ptp(whole, axis=0), np.finfo(float).tiny)):
        raise InputError(
            f"shooting: a segment that begins with the states at sample {length} does not continue the motion: "
            f"{names[column]!r} differs by {apart[column]:.3g}; expected a model that does not depend on time but "
            f"through its state, and all of its state in states, which are {', '.join(map(repr, states))}"
        )
