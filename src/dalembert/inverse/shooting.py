"""Multiple shooting: chaotic motion is fitted in short segments that are made to meet."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain

import numpy as np

from dalembert.data import derivative
from dalembert.errors import InputError
from dalembert.inverse.continuity import Chain, Found
from dalembert.inverse.descent import End, descend
from dalembert.inverse.nodes import Nodes
from dalembert.inverse.noise import NoiseFloor
from dalembert.inverse.prefetch import prefetched
from dalembert.inverse.problem import Problem
from dalembert.inverse.segments import State
from dalembert.inverse.spread import spread_points
from dalembert.optimize import Squares
from dalembert.settings import expect_at_least

WORSE = 1.1
"""Ratio of misfits up to which fewer segments are taken to explain the data as well as more of them."""

TURN = 2 * np.pi


@dataclass(frozen=True)
class MultipleShooting:
    """The motion in segments with initial states of their own, which must meet; for chaotic motion.

    Parameters
    ----------
    states : mapping of str to State
        All parameters of the initial state, and the channels of the model that are the state later.
    segments : int
        To begin with: each long enough to tell its own initial state, and short enough that the motion does not forget
        it. They are merged two by two.

    Notes
    -----
    min Σ W (R − data)² over the parameters and the segments' initial states, subject to continuity. The gaps between
    segments weigh little at first and ever more, and multipliers close them at last (an augmented Lagrangian); every
    two neighbours are then merged from where they ended, until one run explains all samples. Where the motion forgets
    its beginning within the digits of the arithmetic, one run cannot, and the result is that of the fewest segments
    that can.

    Initial states begin at the measured values, at rates of change of measured ones, or where the segment before ends.

    Source: H. G. Bock, Recent advances in parameter identification techniques for O.D.E., in Numerical Treatment of
    Inverse Problems in Differential and Integral Equations, 1983 (multiple shooting with continuity as conditions);
    M. J. D. Powell, A method for nonlinear constraints in minimization problems, 1969 (multipliers).

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.data import Measurements
    >>> from dalembert.forward import PythonModel
    >>> from dalembert.inverse import identify
    >>> times = np.linspace(0, 10, 101)
    >>> swing = PythonModel(
    ...     lambda rate, place, speed: np.stack(
    ...         [
    ...             place * np.cos(rate * times) + speed / rate * np.sin(rate * times),
    ...             speed * np.cos(rate * times) - rate * place * np.sin(rate * times),
    ...         ],
    ...         axis=1,
    ...     ),
    ...     {"rate": (1.0, 9.0), "place": (-1.0, 1.0), "speed": (-9.0, 9.0)},
    ...     ["x", "v"],
    ...     times,
    ... )
    >>> data = Measurements.of(times, {"x": np.cos(6.3 * times)}, deviations=1e-3)
    >>> states = {"place": State("x", -1.5, 1.5), "speed": State("v", -10.0, 10.0)}
    >>> fit = identify(swing, data, shooting=MultipleShooting(states, segments=8), start=[4.0, 0.0, 0.0])
    >>> round(fit.values[0], 6), fit.nodes.segments
    (np.float64(6.3), 1)
    """

    states: Mapping[str, State]
    segments: int = 8

    def __post_init__(self) -> None:
        expect_at_least(self, 2, "segments")
        if not self.states:
            raise InputError(
                "MultipleShooting: no states were given; expected all parameters of the initial state, each with the "
                "channel that it is later"
            )


def shots(
    problem: Problem,
    shooting: MultipleShooting,
    method: Squares,
    floor: NoiseFloor,
    *,
    starts: int,
    seed: int,
    spread: str,
    start: np.ndarray,
) -> list[End]:
    """Ends of up to ``starts`` shots, the first from the search point ``start``, as soon as one reaches the floor."""
    ends: list[End] = []
    others = list(spread_points(problem, starts, seed, spread)[1:]) if starts > 1 else []
    for point in chain([start], prefetched(problem, partial(_ahead, shooting, method, floor), others)):
        values = problem.search.vectors(point)
        problem.journal.began(values)
        end = _shot(problem, shooting, method, floor, values)
        found = problem.search.vectors(end.point)
        problem.journal.ended(values, found, end.fitness, end.success, end.message)
        ends.append(end)
        if end.fitness <= floor.fitness:
            break
    return ends


def _ahead(shooting: MultipleShooting, method: Squares, floor: NoiseFloor, problem: Problem, point: np.ndarray) -> None:
    """The same shot on a worker of a cluster."""
    _shot(problem, shooting, method, floor, problem.search.vectors(point))


def _shot(problem: Problem, shooting: MultipleShooting, method: Squares, floor: NoiseFloor, values: np.ndarray) -> End:
    """Segments that meet, merged as far as they can be."""
    levels = list(_levels(problem, shooting, values))
    first = problem.search.points(_first(levels[-1], len(values)))
    one = descend([problem], method, first)
    met = [(chain, found) for chain, found in levels if found.met]
    least = min([one.fitness, *(found.misfit for _, found in met)])
    if not met or one.fitness <= max(WORSE * least, floor.fitness):
        return replace(one, nodes=_nodes(*met[0], 1) if met else None)
    chain, found = next(level for level in reversed(met) if level[1].misfit <= WORSE * least)
    count = len(chain.cuts) - 1
    return End(
        problem.search.points(_first((chain, found), len(values))),
        found.misfit,
        True,
        f"converged: {count} segments meet, and do not merge into one run",
        True,
        chain.linearised(found.point),
        _nodes(*met[0], count),
    )


def _levels(problem: Problem, shooting: MultipleShooting, values: np.ndarray) -> Iterator[tuple[Chain, Found]]:
    """Segments that were made to meet: all of them, then half of them, down to two."""
    cuts = np.rint(np.linspace(0, problem.samples - 1, shooting.segments + 1)).astype(int)
    chain = Chain(problem, shooting.states, cuts)
    guess = first_guess(chain, values)
    while True:
        found = chain.closed(chain.inner.search.points(guess))
        yield chain, found
        if len(cuts) <= 3:
            return
        ended = dict(zip(chain.pieces.parameters.names, chain.inner.search.vectors(found.point), strict=True))
        cuts = np.unique([*cuts[::2], cuts[-1]])
        chain = Chain(problem, shooting.states, cuts)
        guess = np.array([ended[name] for name in chain.pieces.parameters.names])


def first_guess(chain: Chain, values: np.ndarray) -> np.ndarray:
    """Parameters and states to begin with: measured ones, and where the segment before ends."""
    pieces, seen = chain.pieces, _seen(chain, values)
    names, channels = pieces.model.parameters.names, [channel.name for channel in pieces.model.channels]
    own = values.copy()
    for name, column in seen.items():
        if np.isfinite(column[0]):
            own[names.index(name)] = column[0]
    own = pieces.model.parameters.clip(own)
    guess = [own.copy()]
    for begin, end in zip(pieces.cuts[:-2], pieces.cuts[1:-1], strict=True):
        ran = pieces.model.first(int(end - begin) + 1).evaluate(own[None]).values[0, -1]
        for name, state in chain.states.items():
            value = seen[name][end] if np.isfinite(seen[name][end]) else ran[channels.index(state.channel)]
            value = value if np.isfinite(value) else (state.lower + state.upper) / 2
            own[names.index(name)] = np.clip(value, state.lower, state.upper)
        guess.append(own[[names.index(name) for name in chain.states]])
    chain.problem.journal.simulations += 1  # all of them together are one run
    return np.concatenate(guess)


def _seen(chain: Chain, values: np.ndarray) -> dict[str, np.ndarray]:
    """Each state as far as it was measured, or differentiated from what was: (samples,), NaN where it was not.

    Wrapping channels are without jumps, and by whole turns near the initial state.
    """
    data, names = chain.problem.data, chain.pieces.model.parameters.names
    continuous = dict(zip(data.channels, data.continuous.T, strict=True))
    seen = {}
    for name, state in chain.states.items():
        if state.channel in continuous:
            seen[name] = continuous[state.channel]
            if state.channel in data.wraps:
                first = seen[name][np.isfinite(seen[name])][0]
                seen[name] = seen[name] + TURN * np.rint((values[names.index(name)] - first) / TURN)
        elif state.rate_of is not None:
            seen[name] = derivative(data, state.rate_of).values
        else:
            seen[name] = np.full(chain.problem.samples, np.nan)
    return seen


def _first(level: tuple[Chain, Found], number: int) -> np.ndarray:
    """The model's own parameters where segments ended."""
    chain, found = level
    return chain.problem.model.parameters.clip(chain.inner.search.vectors(found.point)[:number])


def _nodes(chain: Chain, found: Found, segments: int) -> Nodes:
    pieces = chain.pieces
    begins, gaps, growth = chain.met(found.point)
    shape = (pieces.count - 1, len(chain.states))
    begins = begins.reshape(shape)
    ends = begins + gaps.reshape(shape)
    return Nodes(tuple(chain.states), pieces.cuts[1:-1], ends, begins, found.gap, growth, segments)
