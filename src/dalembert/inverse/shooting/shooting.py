"""Multiple shooting: chaotic motion is fitted in short segments that are made to meet."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain

import numpy as np

from dalembert.arguments import Checked, limited
from dalembert.errors import InputError, SolveError
from dalembert.inverse.experiments.tracks import tracks
from dalembert.inverse.least_squares.descent import End, descend, recorded
from dalembert.inverse.noise.noise_floor import NoiseFloor
from dalembert.inverse.problem.nodes import Nodes
from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.inverse.shooting.continuity import Chain, ChainEnd
from dalembert.inverse.shooting.cuts import Cut, guess, named_cut, segments
from dalembert.inverse.shooting.natural_cuts import coarser, natural_cuts
from dalembert.inverse.shooting.segments import ShootingState
from dalembert.inverse.starts.spread import spread_points
from dalembert.optimize import Squares
from dalembert.threads import single_thread

WORSE = 1.1
"""Ratio of misfits up to which fewer segments are taken to explain the data as well as more of them."""

USUAL = 8
"""Segments to begin with, where states are named and their number is not given."""


@dataclass(frozen=True)
class MultipleShooting(Checked):
    """The motion in segments with separate initial states, which must meet; for chaotic motion.

    Parameters
    ----------
    states : mapping of str to ShootingState, optional
        All parameters of the initial state, and the channels of the model that are the state later. A model that can
        begin at a later state, such as :class:`~dalembert.multibody.TimeResponse`, does not need them: its segments
        begin at independent coordinates and rates, which the jacobian of the constraints shows, and the joints make
        the others.
    segments : int, optional
        Of each motion to begin with; they are merged two by two. If not given, a small change of the state grows at
        most tenfold within each of them, as sensitivities of the state show; 8 where states are named.

    Notes
    -----
    min Σ W (R − data)² over the parameters and the segments' initial states, subject to continuity. The gaps between
    segments weigh little at first and ever more. Steps of Gauss and Newton under the linearised conditions then close
    them, or, where these fail, multipliers (an augmented Lagrangian). Every two neighbours are merged from where they
    ended, until one run explains all samples. Where the motion forgets its beginning within the digits of the
    arithmetic, one run cannot, and the result is that of the fewest segments that can. Standard deviations are those
    along segments that meet: the derivatives of a whole chaotic motion are too large for them.

    Without states and a number of segments, the first ones are shorter: a small change grows at most 2.5 times, so
    that wrong parameters do not lead away from the data. The growth is measured again where they end.

    Initial states begin at the measured values, at rates of change of measured ones, or where the segment before ends.

    Segments begin at their own time: loads, motions and measured inputs are read there. The samples may be uneven, and
    several experiments are cut each for itself. Of a model that cannot begin later, such as a
    :class:`~dalembert.forward.PythonModel`, the motion must not depend on time but through its state, and the samples
    must be even.

    Data without deviations and weights are weighed by the noise that local polynomials leave of them.

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
    >>> states = {"place": ShootingState("x", -1.5, 1.5), "speed": ShootingState("v", -10.0, 10.0)}
    >>> fit = identify(swing, data, shooting=MultipleShooting(states, segments=8), start=[4.0, 0.0, 0.0])
    >>> round(fit.values[0], 6), fit.nodes.segments
    (np.float64(6.3), 1)
    """

    states: Mapping[str, ShootingState] | None = None
    segments: int | None = limited(None, least=2)

    def __post_init__(self) -> None:
        if self.states is not None and not self.states:
            raise InputError(
                "MultipleShooting: no states were given; expected all parameters of the initial state, each with the "
                "channel that it is later; or leave states out for a mechanism"
            )

    @property
    def count(self) -> int:
        """Segments of a motion whose states are named."""
        return USUAL if self.segments is None else self.segments


def shots(
    problem: MisfitProblem,
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
    shot = partial(_shot, shooting, method, floor)
    for point in chain([start], problem.prefetched(shot, others)):
        ends.append(recorded(problem, point, partial(shot, problem, point)))
        if ends[-1].misfit <= floor.misfit:
            break
    return ends


@dataclass(frozen=True, eq=False)
class SegmentLevel:
    """Segments that were made to meet, and where they ended."""

    cuts: Sequence[Cut]
    chain: Chain
    found: ChainEnd


def _shot(
    shooting: MultipleShooting, method: Squares, floor: NoiseFloor, problem: MisfitProblem, point: np.ndarray
) -> End:
    """Segments that meet, from a search point, merged as far as they can be."""
    values = problem.search.vectors(point)
    with single_thread():  # for the many small linear systems
        try:
            return _merged(problem, list(_levels(problem, shooting, values)), method, floor, len(values))
        except SolveError as error:
            return End(problem.search.points(values), np.inf, False, f"the segments could not be simulated: {error}")


def _merged(
    problem: MisfitProblem, levels: Sequence[SegmentLevel], method: Squares, floor: NoiseFloor, number: int
) -> End:
    """End of one run where segments merge into it, else of the fewest segments that explain the data as well."""
    last = next((level for level in reversed(levels) if level.found.closed), levels[-1])
    one = descend([problem], method, problem.search.points(_first(last, number)))
    met = [level for level in levels if level.found.closed]
    least = min([one.misfit, *(level.found.misfit for level in met)])
    nodes = next(iter(met or levels))
    spread = nodes.chain.spread(nodes.found.point)
    if not met or one.misfit <= max(WORSE * least, floor.misfit):
        return replace(one, nodes=_nodes(nodes, 1), spread=spread if met else None)
    level = next(level for level in reversed(met) if level.found.misfit <= WORSE * least)
    count = max(cut.count for cut in level.cuts)
    return End(
        problem.search.points(_first(level, number)),
        level.found.misfit,
        True,
        f"converged: {count} segments meet, and do not merge into one run",
        True,
        level.chain.linearised(level.found.point),
        _nodes(nodes, count),
        spread=spread,
    )


def _levels(problem: MisfitProblem, shooting: MultipleShooting, values: np.ndarray) -> Iterator[SegmentLevel]:
    """Segments that were made to meet: all of them, then half of them, down to two."""
    cuts, values = first_cuts(problem, shooting, values)
    start, merged = guess(values, cuts), False
    if shooting.states is None and shooting.segments is None:
        chain = Chain(problem, segments(problem, cuts))
        found = chain.led(chain.search.points(chain.segments.parameters.clip(start)))
        cuts, start = _continued(chain, found, coarser(cuts, chain.passed(found.point)))
    while True:
        chain = Chain(problem, segments(problem, cuts))
        found = chain.closed(chain.search.points(chain.segments.parameters.clip(start)), merged=merged)
        yield SegmentLevel(cuts, chain, found)
        if all(len(cut.nodes) < 2 for cut in cuts) or (merged and not found.closed):
            return
        merged = found.closed
        cuts, start = _continued(chain, found, [cut.merged() for cut in cuts])


def _continued(chain: Chain, found: ChainEnd, cuts: list[Cut]) -> tuple[list[Cut], np.ndarray]:
    """Motions in fewer segments, and the unknowns where the longer chain ended."""
    ended = dict(zip(chain.segments.parameters.names, chain.search.vectors(found.point), strict=True))
    names = [one.name for cut in cuts for node in cut.nodes for one in node.unknowns(cut.track)]
    return cuts, np.array([ended[name] for name in (*chain.problem.model.parameters.names, *names)])


def first_cuts(problem: MisfitProblem, shooting: MultipleShooting, values: np.ndarray) -> tuple[list[Cut], np.ndarray]:
    """Return all motions in segments that begin at measured states, and the parameters with such initial states."""
    own = tracks(problem)
    if shooting.states is None:
        return natural_cuts(problem, own, values, shooting.segments)
    cuts = []
    for track in own:
        cut, found = named_cut(track, shooting.states, shooting.count, values[track.wiring])
        values = values.copy()
        values[track.wiring] = found
        cuts.append(cut)
    problem.journal.simulations += 1  # all of them together are one run
    return cuts, values


def _first(level: SegmentLevel, number: int) -> np.ndarray:
    """The model's own parameters where segments ended."""
    return level.chain.problem.model.parameters.clip(level.chain.search.vectors(level.found.point)[:number])


def _nodes(level: SegmentLevel, count: int) -> Nodes:
    """The states at which segments met; of several motions one after the other."""
    begins, gaps = level.chain.met(level.found.point)
    nodes = [(cut.track, node) for cut in level.cuts for node in cut.nodes]
    units = {name: unit for _, node in nodes for name, unit in zip(node.names, node.units, strict=True)}
    rows = np.repeat(np.arange(len(nodes)), [len(node.names) for _, node in nodes])
    columns = [list(units).index(name) for _, node in nodes for name in node.names]
    table = np.full((2, len(nodes), len(units)), np.nan)
    table[:, rows, columns] = begins + gaps, begins
    wiring = [
        np.array([cut.track.wiring[cut.track.model.parameters.names.index(name)] for name in cut.states], dtype=int)
        for cut in level.cuts
        if cut.states
    ]
    return Nodes(
        tuple(units),
        np.array([node.sample for _, node in nodes]),
        table[0],
        table[1],
        level.found.gap,
        level.chain.growth(level.found.point, wiring),
        count,
        tuple(units.values()),
        tuple(track.name for track, _ in nodes),
        np.array([track.times[node.sample] for track, node in nodes]),
    )
