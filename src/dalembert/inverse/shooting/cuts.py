"""How motions are cut into segments: at samples where each begins anew at a state."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from dalembert.data import derivative
from dalembert.forward import StateChart, restarted
from dalembert.inverse.experiments.tracks import Track
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.shooting.segments import Piece, Segments, ShootingState
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

TURN = 2 * np.pi


@dataclass(frozen=True, eq=False)
class SegmentNode:
    """A sample of one motion at which a segment begins."""

    sample: int
    # names, units: of the numbers that the segment begins at
    names: tuple[str, ...]
    units: tuple[str, ...]
    values: np.ndarray  # (states,): first guess
    # lower, upper, ranges: (states,): bounds, and the sizes that gaps are measured by
    lower: np.ndarray
    upper: np.ndarray
    ranges: np.ndarray
    chart: StateChart | None = None  # what the numbers are in a model that can begin anew at them

    def unknowns(self, track: Track) -> list[Parameter]:
        """The state at the cut as parameters; those of a chart, independent coordinates, have a scale and no log."""
        free = self.chart is not None
        return [
            Parameter(
                f"{track.prefix}{name} at {self.sample}", low, high, unit,
                scale=size if free else None, log=False if free else None,
            )
            for name, low, high, unit, size in zip(
                self.names, self.lower, self.upper, self.units, self.ranges, strict=True
            )
        ]  # fmt: skip


@dataclass(frozen=True, eq=False)
class Cut:
    """One motion with the nodes at which it is cut."""

    track: Track
    nodes: tuple[SegmentNode, ...]
    # states: by the model's parameters of the initial state, which the segments' states are. Without any, segments
    # begin at independent coordinates and rates of a model that can begin anew at them.
    states: Mapping[str, ShootingState] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """Number of segments."""
        return len(self.nodes) + 1

    def merged(self) -> "Cut":
        """Return the cut with every second node; of three nodes the middle one is left."""
        return self if len(self.nodes) < 2 else replace(self, nodes=self.nodes[1::2])

    def piece(self, begin: SegmentNode | None, end: SegmentNode | None, own: np.ndarray, after: np.ndarray) -> Piece:
        """Return a segment; ``begin``, ``end`` are none at the first sample and the last one. ``own``, ``after``
        (states,): where the numbers of both nodes stand among all unknowns.
        """
        track, sample = self.track, 0 if begin is None else begin.sample
        last = len(track.times) - 1 if end is None else end.sample
        if self.states:  # the beginning of the motion with other parameters of the initial state
            names, channels = track.model.parameters.names, [channel.name for channel in track.model.channels]
            model, places = track.between(sample, last), track.wiring.copy()
            if begin is not None:
                places[[names.index(name) for name in self.states]] = own
            ends = [] if end is None else [channels.index(state.channel) for state in self.states.values()]
            kept = np.array(ends, dtype=int)
        else:
            origin = float(track.times[sample]) if begin is not None else 0.0
            chart, later = (None if node is None else node.chart for node in (begin, end))
            model = restarted(track.model, origin, track.times[sample : last + 1] - origin, chart, later)
            places = np.concatenate([track.wiring, own])
            kept = len(track.model.channels) + np.arange(len(after))
        rows = track.rows[sample + (sample > 0) : last + 1]
        return Piece(model, places, rows, track.columns, track.picked, kept, after)


def segments(problem: MisfitProblem, cuts: Sequence[Cut]) -> Segments:
    """Return the segments of all motions as functions of the parameters and of the states at the nodes."""
    number = len(problem.model.parameters)
    states = [one for cut in cuts for node in cut.nodes for one in node.unknowns(cut.track)]
    pieces, place = [], number
    for cut in cuts:
        own = np.zeros(0, dtype=int)
        ends: list[SegmentNode | None] = [*cut.nodes, None]
        for begin, end in zip([None, *cut.nodes], ends, strict=True):
            after = place + np.arange(0 if end is None else len(end.names))
            pieces.append(cut.piece(begin, end, own, after))
            own, place = after, place + len(after)
    ranges = [node.ranges for cut in cuts for node in cut.nodes]
    parameters = Parameters((*problem.model.parameters.declared, *states))
    return Segments(tuple(pieces), parameters, np.concatenate(ranges), problem.weights.shape)


def guess(values: np.ndarray, cuts: Sequence[Cut]) -> np.ndarray:
    """First guess of all unknowns: parameters (parameters,), then the states of the nodes."""
    return np.concatenate([values, *(node.values for cut in cuts for node in cut.nodes)])


def named_cut(
    track: Track, states: Mapping[str, ShootingState], count: int, values: np.ndarray
) -> tuple[Cut, np.ndarray]:
    """Return a motion in ``count`` even segments, and its parameters (parameters,) with the measured initial state.

    States begin at measured values, at rates of change of measured ones, or where the segment before ends.
    """
    seen = _seen(track, states, values)
    names, channels = track.model.parameters.names, [channel.name for channel in track.model.channels]
    for name, column in seen.items():
        if np.isfinite(column[0]):
            values = values.copy()
            values[names.index(name)] = column[0]
    values = track.model.parameters.clip(values)
    units = tuple(next(item.unit for item in track.model.parameters if item.name == name) for name in states)
    lower, upper = (np.array([getattr(state, side) for state in states.values()]) for side in ("lower", "upper"))
    own, nodes = values.copy(), []
    places = np.rint(np.linspace(0, len(track.times) - 1, count + 1)).astype(int)
    for begin, end in pairwise(places[:-1]):
        ran = track.between(begin, end).evaluate(own[None]).values[0, -1]
        for name, state in states.items():
            value = seen[name][end] if np.isfinite(seen[name][end]) else ran[channels.index(state.channel)]
            value = value if np.isfinite(value) else (state.lower + state.upper) / 2
            own[names.index(name)] = np.clip(value, state.lower, state.upper)
        state = own[[names.index(name) for name in states]]
        nodes.append(SegmentNode(int(end), tuple(states), units, state, lower, upper, upper - lower))
    return Cut(track, tuple(nodes), states), values


def _seen(track: Track, states: Mapping[str, ShootingState], values: np.ndarray) -> dict[str, np.ndarray]:
    """Each state as far as it was measured, or differentiated from what was: (samples,), NaN where it was not.

    Wrapping channels are without jumps, and by whole turns near the initial state.
    """
    data, names = track.data, track.model.parameters.names
    continuous = dict(zip(data.channels, data.continuous.T, strict=True))
    seen = {}
    for name, state in states.items():
        if state.channel in continuous:
            seen[name] = continuous[state.channel]
            if state.channel in data.wraps:
                first = seen[name][np.isfinite(seen[name])][0]
                seen[name] = seen[name] + TURN * np.rint((values[names.index(name)] - first) / TURN)
        elif state.rate_of is not None:
            seen[name] = derivative(data, state.rate_of).values
        else:
            seen[name] = np.full(len(track.times), np.nan)
    return seen
