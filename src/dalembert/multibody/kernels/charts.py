"""Charts: how increments, which Newton's method solves for, change coordinates that internal constraints hold."""

from collections.abc import Callable
from typing import Any, NamedTuple

from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import stack

Function = Callable[..., Any]


class Chart(NamedTuple):
    """A local parametrisation of some coordinates, such as those of a rotation by three angles.

    Its functions take local vectors, in real and in complex numbers. ``N`` is the derivative of the coordinates by the
    increments, a basis of the null space of the internal constraints' gradients. ``size``, ``increments``: numbers of
    coordinates, and of increments of them: the coordinates less the internal constraints.

    ``spread(x, d, dx)`` fills ``dx`` (size,) with N(x) d. A chart without it is flat: its increments are those of the
    coordinates.
    ``change(x, d, dx)`` fills ``dx`` with what a finite increment ``d`` changes: x + dx satisfies the internal
    constraints if x does, and dx = N(x) d + O(d^2). Without cancellation: accelerations follow from it.
    ``restore(x, p, m, dx)`` fills ``dx`` with what moves coordinates near the internal constraints onto them; p and m
    are the columns of the kind that has the chart.
    ``project(x, r, s)`` fills ``s`` (increments,) with N(x)^T r, where that is faster than by ``spread``.
    ``balance(x, r, dx)`` fills the first entries of ``dx`` with the multipliers of the internal constraints, whose
    forces balance forces r on the coordinates as far as they can. Only the adjoint needs it.
    """

    size: int
    increments: int
    spread: Function | None = None
    change: Function | None = None
    restore: Function | None = None
    project: Function | None = None
    balance: Function | None = None

    @property
    def is_flat(self) -> bool:
        """Whether increments are simply those of the coordinates."""
        return self.spread is None


def flat(size: int) -> Chart:
    """The chart of coordinates without internal constraints."""
    return Chart(size, size)


def spreading(charts: tuple[Chart, ...]) -> Function:
    """A function (x, d, dx): what increments d change in coordinates that stand one chart after the other."""
    return _chain(charts, _spread_one)


def projecting(charts: tuple[Chart, ...]) -> Function:
    """A function (x, r, s): forces r on the coordinates as forces s on the increments."""
    return _chain(charts, _project_one)


def _chain(charts: tuple[Chart, ...], function_of: Callable[[Chart, int, int], Function]) -> Function:
    steps, coordinate, increment = [], 0, 0
    for chart in charts:
        steps.append(function_of(chart, coordinate, increment))
        coordinate, increment = coordinate + chart.size, increment + chart.increments
    # Functions are composed in pairs, since compiled code has no loop over functions; LLVM inlines the chain.
    chain = steps.pop()
    while steps:
        chain = _both(steps.pop(), chain)
    return chain


def _both(first: Function, second: Function) -> Function:
    @inlined
    def both(x, given, answer):
        first(x, given, answer)
        second(x, given, answer)

    return both


def _copy(size: int, source: int, target: int) -> Function:
    @inlined
    def copy(x, given, answer):
        for i in range(size):
            answer[target + i] = given[source + i]

    return copy


def _spread_one(chart: Chart, at: int, row: int) -> Function:
    function, end, last = chart.spread, at + chart.size, row + chart.increments
    if function is None:
        return _copy(chart.size, row, at)

    @inlined
    def spread(x, d, dx):
        function(x[at:end], d[row:last], dx[at:end])

    return spread


def _project_one(chart: Chart, at: int, row: int) -> Function:
    if chart.is_flat:
        return _copy(chart.size, at, row)
    function, end, last = chart.project or _projected(chart), at + chart.size, row + chart.increments

    @inlined
    def project(x, r, s):
        function(x[at:end], r[at:end], s[row:last])

    return project


def _projected(chart: Chart) -> Function:
    """The transposed product, by a unit vector for each increment."""
    function: Any = chart.spread
    size, increments = chart.size, chart.increments

    @inlined
    def project(x, r, s):
        d, dx = stack(x, increments), stack(x, size)
        for j in range(increments):
            d[j] = 0.0
        for j in range(increments):
            # Row j of N^T r is the product of the column N e_j with r.
            d[j] = 1.0
            function(x, d, dx)
            d[j] = 0.0
            s[j] = dx[0] * r[0]
            for i in range(1, size):
                s[j] += dx[i] * r[i]

    return project
