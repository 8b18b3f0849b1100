"""Whether motions can be cut into segments that begin anew."""

from collections.abc import Sequence

import numpy as np

from dalembert.errors import InputError, require_known, unknown
from dalembert.forward import begun_later, restartable
from dalembert.inverse.experiments.tracks import Track, tracks
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.shooting.shooting import MultipleShooting

SAME = 1e-6
"""Difference, as a part of a state's range, up to which a motion is said to begin with it."""

CONTINUED = 0.02
"""Difference, as a part of a channel's span, up to which a segment is said to continue the motion: an integrator that
begins anew differs by some of its error."""


def check_segments(problem: MisfitProblem, shooting: MultipleShooting) -> None:
    """Refuse what cannot be cut into segments."""
    for track in tracks(problem):
        if shooting.states is not None:
            _check_named(track, shooting)
        elif restartable(track.model) is None:
            raise InputError(
                f"shooting: {track.where}the model cannot begin at a later state; leave out sensors and an unknown "
                "start, or name its states: MultipleShooting({parameter: ShootingState(channel, lower, upper)})"
            )


def _check_named(track: Track, shooting: MultipleShooting) -> None:
    """Refuse states that are not named, and samples of a model that cannot begin later, where they are not even."""
    along, data = track.data.coordinate, track.data
    apart = np.diff(along.values)
    if np.ptp(apart) > 1e-9 * np.mean(apart) and begun_later(track.model, 0.0, along.values) is None:
        raise InputError(
            f"shooting: the samples are between {np.min(apart):.6g} and {np.max(apart):.6g} {along.unit} apart; "
            "expected even ones, so that each segment is like the beginning; resample the data"
        )
    names = [channel.name for channel in track.model.channels]
    for name, state in (shooting.states or {}).items():
        track.model.parameters.check_name(name, where="shooting, states")
        require_known("channel", state.channel, names, f"shooting, state {name!r}")
        if state.rate_of is not None and state.rate_of not in data.channels:
            raise InputError(unknown("channel", state.rate_of, data.channels, f"shooting, state {name!r}, rate_of"))
    if len(along.values) <= 2 * shooting.count:
        raise InputError(
            f"shooting: {len(along.values)} samples are too few for {shooting.count} segments; expected more than two "
            "each"
        )


def check_restart(problem: MisfitProblem, shooting: MultipleShooting, values: np.ndarray) -> None:
    """Refuse states from which a motion does not continue: compare one run with one restarted at the second segment."""
    for track in tracks(problem):
        if shooting.states is None:
            _check_begun(track, shooting.segments or 2, values[track.wiring])
        else:
            _check_continued(track, shooting, values[track.wiring])
    problem.journal.simulations += 1


def _check_begun(track: Track, count: int, own: np.ndarray) -> None:
    """Refuse a mechanism whose motion depends on more than coordinates and rates."""
    model = restartable(track.model)
    assert model is not None
    last = max(2, min(2 * (len(track.times) // count), len(track.times) - 1))
    middle = last // 2
    start = model.state_chart(own)
    sample = float(track.times[middle])
    whole = model.restarted(0.0, track.times[: last + 1], None, model.state_chart(own, whole=True))
    values = whole.evaluate(own[None]).values[0]
    number = len(track.model.channels)
    if not np.all(np.isfinite(values)):
        return
    chart = model.state_chart(own, values[middle, number:], like=start)
    anew = model.restarted(sample, track.times[middle : last + 1] - sample, chart, None)
    again = anew.evaluate(np.concatenate([own, chart.values])[None]).values[0]
    names = [channel.name for channel in track.model.channels]
    _check_same(names, middle, values[:, :number], again, "coordinates and rates")


def _check_continued(track: Track, shooting: MultipleShooting, own: np.ndarray) -> None:
    model, states = track.model, shooting.states or {}
    names = [channel.name for channel in model.channels]
    length = len(track.times) // shooting.count
    whole = model.first(2 * length + 1).evaluate(own[None]).values[0]
    if not np.all(np.isfinite(whole)):
        return
    again = own.copy()
    for name, state in states.items():
        place, column = model.parameters.names.index(name), names.index(state.channel)
        if abs(whole[0, column] - own[place]) > SAME * (state.upper - state.lower):
            raise InputError(
                f"shooting, state {name!r}: the motion begins with {state.channel!r} at {whole[0, column]:.6g} where "
                f"the parameter is {own[place]:.6g}; expected the same; name the channel that begins with the "
                "parameter, and give bodies velocities that go together"
            )
        again[place] = whole[length, column]
    anew = track.between(length, 2 * length).evaluate(again[None]).values[0]
    _check_same(names, length, whole, anew, f"states, which are {', '.join(map(repr, states))}")


def _check_same(names: Sequence[str], sample: int, whole: np.ndarray, anew: np.ndarray, where: str) -> None:
    if not np.all(np.isfinite(anew)):
        return
    apart = np.max(np.abs(anew - whole[sample:]), axis=0)
    for column in np.flatnonzero(apart > CONTINUED * np.maximum(np.ptp(whole, axis=0), np.finfo(float).tiny)):
        raise InputError(
            f"shooting: a segment that begins with the states at sample {sample} does not continue the motion: "
            f"{names[int(column)]!r} differs by {apart[column]:.3g}; expected a model that does not depend on time but "
            f"through its state, and all of its state in {where}"
        )
