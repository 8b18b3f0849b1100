"""Motions cut where their growth of errors asks for it, at states that are estimated from the data."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from dalembert.errors import DalembertError, InputError, SolveError
from dalembert.forward import Restartable, StateChart, restartable, restarted
from dalembert.inverse.experiments.tracks import Track
from dalembert.inverse.noise.smoothed import Smoothed, smoothed
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.shooting.cuts import TURN, Cut, SegmentNode

GROWTH = 10.0
"""Growth of a small change of the state within a segment, at most."""

FINE = 2.5
"""The same for segments that lead from far away, where wrong parameters soon leave the data."""

TRIED = 80
"""Nodes of a motion at which growth is measured, at most."""

FEWEST = 4
"""Segments of a motion, at least, where it has the samples: each brings what was measured in its midst."""

MOST_STATES = 60
"""Numbers of a state, at most."""

REACH = 10.0
"""Half width of the bounds of a state, in parts of its range."""

SMALL = 0.01
"""Least range of a coordinate, in parts of the largest one of its motion."""

FREE = 10.0
"""Standard deviation of a state that is not measured around what the segment before leads to, in typical sizes."""

ITERATIONS = 4


def natural_cuts(
    problem: MisfitProblem, tracks: Iterable[Track], values: np.ndarray, count: int | None
) -> tuple[list[Cut], np.ndarray]:
    """Return all motions in segments, and the parameters (parameters,) with initial states as measured.

    ``values`` (parameters,). ``count``: even segments of each motion; if None as many as its growth of errors asks for.
    """
    cuts, lower, upper = [], problem.model.parameters.lower, problem.model.parameters.upper
    for track in tracks:
        estimates = _Estimates(track, smoothed(track.data))
        values = values.copy()
        values[track.wiring] = np.clip(estimates.fitted(values[track.wiring]), lower[track.wiring], upper[track.wiring])
        # a segment has at least twice as many values as numbers of its state
        fewest = max(4, -(-2 * len(estimates.start.names) // len(track.columns)))
        tried = min(TRIED, (len(track.times) - 1) // fewest) if count is None else count
        if tried < 2 or (len(track.times) - 1) // tried < 2:
            raise InputError(
                f"shooting: {track.where}{len(track.times)} samples are too few for {max(tried, 2)} segments; expected "
                f"more than {fewest if count is None else 2} each"
            )
        places = np.rint(np.linspace(0, len(track.times) - 1, tried + 1)).astype(int)
        nodes = estimates.nodes(values[track.wiring], places[:-1].tolist())
        problem.journal.simulations += 1  # all of them together are one run
        if count is None:
            problem.journal.simulations += 1 + len(track.wiring)
            own = values[track.wiring]
            grown = [_passed(track, begin, end, own) for begin, end in pairwise(nodes)]
            nodes = [nodes[0], *_chosen(nodes[1:], grown[1:], FINE, len(places) // FEWEST)]
        cuts.append(Cut(track, tuple(nodes[1:])))
    return cuts, values


def coarser(cuts: Sequence[Cut], grown: Sequence[Sequence[np.ndarray]]) -> list[Cut]:
    """Return motions in fewer segments, within which a small change of the state grows by ``GROWTH`` at most. ``grown``
    are the derivatives of each node's state by that of the node before, (states, states), in parts of the ranges; one
    list a motion.
    """
    return [
        replace(cut, nodes=tuple(_chosen(cut.nodes, own, GROWTH, max(1, len(cut.nodes) // (FEWEST - 1)))))
        for cut, own in zip(cuts, grown, strict=True)
    ]


def _chosen(
    nodes: Sequence[SegmentNode], grown: Sequence[np.ndarray | None], growth: float, most: int
) -> list[SegmentNode]:
    """Nodes between which a small change of the state grows by ``growth`` at most, at most ``most`` nodes apart.

    A node is left out where the growth up to the node behind it is small enough.
    """
    chosen, passed, length = [nodes[0]], np.eye(len(nodes[0].names)), 0
    for before, node, step in zip(nodes[:-1], nodes[1:], grown, strict=True):
        following = None if step is None else step @ passed
        length += 1
        if before is not chosen[-1] and (following is None or np.linalg.norm(following, 2) > growth or length > most):
            chosen.append(before)
            passed, length = np.eye(len(node.names)) if step is None else step, 1
        else:
            passed = np.eye(len(node.names)) if following is None else following
    return chosen


def _passed(track: Track, begin: SegmentNode, end: SegmentNode, own: np.ndarray) -> np.ndarray | None:
    """Derivative of one node's state by that of the node before, in parts of the ranges; None where a run fails."""
    span = float(track.times[end.sample] - track.times[begin.sample])
    model = restarted(track.model, float(track.times[begin.sample]), [span], begin.chart, end.chart)
    try:
        _, jacobian = model.linearise(np.concatenate([own, begin.values]))
    except SolveError:
        return None
    slopes = jacobian[-1, len(track.model.channels) :, len(own) :]
    return slopes * begin.ranges / end.ranges[:, None] if np.all(np.isfinite(slopes)) else None


@dataclass(eq=False)
class _Estimates:
    """States of a motion that agree with its measurements."""

    track: Track
    seen: Smoothed

    def __post_init__(self) -> None:
        found = restartable(self.track.model)
        assert found is not None
        self.model: Restartable = found
        self.start = found.state_chart(self.track.model.parameters.start)
        if len(self.start.names) > MOST_STATES:
            raise InputError(
                f"shooting: {self.track.where}the state has {len(self.start.names)} numbers; expected at most "
                f"{MOST_STATES}, as of rigid bodies; leave shooting out"
            )
        spread = np.std(self.seen.values, axis=0)
        quick = [
            np.sqrt(np.mean(rates**2)) / size
            for rates, size in zip(self.seen.rates.T, spread, strict=True)
            if size > 0 and np.all(np.isfinite(rates))
        ]
        self.frequency = max([*quick, 1 / max(float(np.ptp(self.track.times)), 1e-300)])
        self.offsets = np.zeros(len(spread))

    def fitted(self, own: np.ndarray) -> np.ndarray:
        """Parameters (parameters,) whose initial state is nearer to the measured one, as far as they determine it."""
        track, number = self.track, len(own)
        width = track.model.parameters.upper - track.model.parameters.lower
        for _ in range(2):
            try:
                start = self.model.state_chart(own)
                self.offsets = self._turns(own, start)
                wanted = self.estimated(own, start, 0)
                model = restarted(track.model, 0.0, [0.0, self._instant], None, start)
                values, jacobian = model.linearise(own)
            except SolveError:
                return own
            sizes = self._sizes(start)
            channels = len(track.model.channels)
            rows = jacobian[0, channels:] * width / sizes[:, None]
            left = (wanted - values[0, channels:]) / sizes
            step = np.linalg.lstsq(
                np.concatenate([rows, 1e-3 * np.eye(number)]), np.concatenate([left, np.zeros(number)]), rcond=None
            )[0]
            own = track.model.parameters.clip(own + step * width)
        return own

    def nodes(self, own: np.ndarray, places: Sequence[int]) -> list[SegmentNode]:
        """Nodes at samples, the first one at the beginning: each near where the one before leads to, and measured."""
        track = self.track
        chart = self.model.state_chart(own)
        found = [(0, chart, self.estimated(own, chart, 0))]
        for place in places[1:]:
            sample, chart, state = found[-1]
            chart = self._next(own, chart, state, track.times[sample], track.times[place])
            chart = self._counted(own, chart, int(place))
            found.append((int(place), chart, self.estimated(own, chart, int(place))))
        return _bounded(found)

    def estimated(self, own: np.ndarray, chart: StateChart, sample: int) -> np.ndarray:
        """Numbers of a state that agree with what was measured at a sample, and else with the chart's values. Least
        squares by Gauss and Newton: channels have the measured values, and their derivative by the coordinates times
        the rates gives the measured rates of change.
        """
        track, seen, numbers = self.track, self.seen, chart.values
        half, channels, sizes = len(numbers) // 2, track.picked, self._sizes(chart)
        model = restarted(track.model, float(track.times[sample]), [0.0, self._instant], chart, None)
        far, closed = FREE * sizes, chart.values
        for _ in range(ITERATIONS):
            try:
                values, jacobian = model.linearise(np.concatenate([own, numbers]))
            except SolveError:  # no such state: a part of the way
                numbers = closed + (numbers - closed) / 4
                continue
            closed = numbers
            slopes = jacobian[0][channels][:, len(own) :]
            placed = np.abs(slopes[:, half:]).max(axis=1) * self.frequency <= 1e-6 * np.abs(slopes).max(axis=1)
            noise = np.maximum(seen.deviations, 1e-6 * np.abs(slopes * sizes).max(axis=1) + 1e-300)
            rows = [slopes / noise[:, None], np.diag(1 / far)]
            left = [(seen.values[sample] + self.offsets - values[0, channels]) / noise, (chart.values - numbers) / far]
            for channel in np.flatnonzero(placed & np.isfinite(seen.rates[sample])):
                rate = np.concatenate([np.zeros(half), slopes[channel, :half]])
                rows.append(rate[None] / seen.errors[channel])
                left.append([(seen.rates[sample, channel] - rate @ numbers) / seen.errors[channel]])
            step = np.linalg.lstsq(np.concatenate(rows), np.concatenate(left), rcond=None)[0]
            numbers = chart.values + np.clip(numbers + step - chart.values, -far, far)
            if np.all(np.abs(step) <= 1e-4 * sizes):
                break
        return closed if model.evaluate(np.concatenate([own, numbers])[None]).failures else numbers

    def _next(self, own: np.ndarray, chart: StateChart, state: np.ndarray, begin: float, end: float) -> StateChart:
        """Chart where a segment ends; where it began if it cannot be simulated."""
        ends = self.model.state_chart(own, chart.near, whole=True)
        model = restarted(self.track.model, float(begin), [float(end - begin)], chart, ends)
        found = model.evaluate(np.concatenate([own, state])[None])
        reached = found.values[0, -1, len(self.track.model.channels) :]
        near = reached if np.all(np.isfinite(reached)) else chart.near
        try:
            return self.model.state_chart(own, near, like=self.start)
        except DalembertError:
            return replace(chart)

    def _counted(self, own: np.ndarray, chart: StateChart, sample: int) -> StateChart:
        """The chart with the whole turns that were measured: the segment before may have lost some."""
        track = self.track
        places = {track.model.channels[column].name: place for place, column in enumerate(track.picked)}
        if not any(name in places for name in chart.turning):
            return chart
        model = restarted(track.model, float(track.times[sample]), [0.0, self._instant], chart, None)
        values = model.evaluate(np.concatenate([own, chart.values])[None]).values[0, 0][track.picked]
        apart = np.rint((self.seen.values[sample] - values) / TURN)
        apart = np.where(track.data.wrapping | ~np.isfinite(apart), 0.0, apart)
        return chart.turned(np.array([apart[places[name]] if name in places else 0.0 for name in chart.turning]))

    def _turns(self, own: np.ndarray, start: StateChart) -> np.ndarray:
        """Whole turns by which measured angles that wrap differ from the model's at the beginning, (channels,)."""
        track = self.track
        model = restarted(track.model, 0.0, [0.0, self._instant], None, start)
        values = model.evaluate(own[None]).values[0, 0][track.picked]
        apart = TURN * np.rint((values - self.seen.values[0]) / TURN)
        return np.where(track.data.wrapping & np.isfinite(apart), apart, 0.0)

    def _sizes(self, chart: StateChart) -> np.ndarray:
        """Typical sizes of the numbers of a state."""
        half = len(chart.scales) // 2
        return chart.scales * np.repeat([1.0, self.frequency], half)

    @property
    def _instant(self) -> float:
        return float(np.min(np.diff(self.track.times)))


def _bounded(found: Sequence[tuple[int, StateChart, np.ndarray]]) -> list[SegmentNode]:
    """Nodes whose bounds and ranges are those of all of them."""
    over: dict[str, list[float]] = {}
    scales: dict[str, float] = {}
    for _, chart, state in found:
        half = len(chart.names) // 2
        compared = state + chart.offsets
        for number, (name, value, scale) in enumerate(zip(chart.names, compared, chart.scales, strict=True)):
            over.setdefault(name, []).append(float(value))
            scales[name] = float(scale) * (1 if number < half else -1)
    ranges = {name: float(np.ptp(values)) for name, values in over.items()}
    for sign in (1, -1):  # coordinates, then rates
        own = [name for name, scale in scales.items() if np.sign(scale) == sign]
        largest = max(ranges[name] / abs(scales[name]) for name in own) or 1.0
        for name in own:
            ranges[name] = max(ranges[name], SMALL * largest * abs(scales[name]))
    nodes = []
    for sample, chart, state in found:
        size = np.array([ranges[name] for name in chart.names])
        middle = np.array([(max(over[name]) + min(over[name])) / 2 for name in chart.names]) - chart.offsets
        lower, upper = np.maximum(middle - REACH * size, -chart.reach), np.minimum(middle + REACH * size, chart.reach)
        nodes.append(SegmentNode(sample, chart.names, chart.units, state, lower, upper, size, replace(chart)))
    return nodes
