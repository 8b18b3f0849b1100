"""A step of collocation: independent coordinates as a polynomial, the others by the constraints."""

from typing import NamedTuple

import numpy as np

from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Integers, Reals, Reals2, Reals3
from dalembert.multibody.integrators.collocation.collocation_rule import Rule
from dalembert.multibody.integrators.shared.consistent import Consistency, accelerate, consistency
from dalembert.multibody.integrators.shared.ends import write
from dalembert.multibody.integrators.shared.partitioning import (
    DEPENDENT,
    Partition,
    choose,
    dependence,
    invert,
    linearise,
    scratch,
    settle,
)
from dalembert.multibody.integrators.shared.problem import (
    DONE,
    NEWTON_FAILED,
    SINGULAR,
    VELOCITY,
    IntegrationProblem,
    SampleModels,
)
from dalembert.multibody.kernels.assembly import set_signals
from dalembert.multibody.kernels.block_table import Call
from dalembert.multibody.kernels.slopes import one
from dalembert.multibody.kernels.states import Histories, MotionState, MotionStates, copy, resting, row, rows
from dalembert.multibody.model.turns import STEP_END, count_turns

_GROWN = 4.0  # dependence, against that of the first choice, at which other coordinates are chosen


class Schedule(NamedTuple):
    """Begins and ends of the steps, a time within each one's smooth stretch, whether it opens one, its first output."""

    begins: Reals
    ends: Reals
    within: Reals
    opens: Integers
    due: Integers


class ScheduleStep(NamedTuple):
    """One step of a schedule: begin and end, s, a time within its smooth stretch, whether it opens one, its outputs."""

    begin: float
    end: float
    within: float
    opens: bool
    first: int
    last: int


@inner
def step_of(schedule, number):
    """A step by its number."""
    return ScheduleStep(
        schedule.begins[number], schedule.ends[number], schedule.within[number], schedule.opens[number] != 0,
        schedule.due[number], schedule.due[number + 1],
    )  # fmt: skip


class CollocationRun(NamedTuple):
    """State and work of a run. ``c`` (count u,): the unknown accelerations of u independent coordinates; ``dc``
    (directions, count u). ``points`` (g, N + 1): states at the Gauss points. ``dpoint``: a state's derivatives by c,
    ``dall``: by c and along the directions. ``gaps`` (g, N + 1), ``slopes`` (g, directions of dall, N + 1): what
    remains, and its derivatives. ``chosen``: dependence at the choice of the independent coordinates; 0: none was made,
    or the last step had another. ``linear``: whether the equations of motion are linear in the multipliers.
    """

    old: MotionState
    new: MotionState
    dold: MotionStates
    dnew: MotionStates
    c: Reals
    dc: Reals2
    points: MotionStates
    dpoint: MotionStates
    dall: MotionStates
    gaps: Reals2
    slopes: Reals3
    shape: Reals2
    chosen: Reals
    linear: bool
    partition: Partition
    consistency: Consistency


def prepare(
    problem: IntegrationProblem, rule: Rule, call: Call, complex_call: Call, directions: int, linear: bool
) -> CollocationRun:
    """Workspace of a run along that many directions, whose calls the caller keeps alive; ``linear`` as in the class."""
    width = problem.exact_layout.size + 1
    count, points = len(rule.powers), len(rule.nodes)
    unknowns = count * (2 * problem.n - width + 1)
    both = unknowns + directions
    return CollocationRun(
        resting(width), resting(width), resting(directions, width), resting(directions, width), np.zeros(unknowns),
        np.zeros((directions, unknowns)), resting(points, width), resting(unknowns, width), resting(both, width),
        np.zeros((points, width)), np.zeros((points, both, width)), np.zeros((3, count)), np.zeros(2), linear,
        scratch(problem, both), consistency(problem, call.address, complex_call.address, directions),
    )  # fmt: skip


@inner
def _choose(problem, own, chosen):
    """Keep the independent coordinates, or choose others; whether there are as many as at first."""
    # The choice is kept as long as dependent coordinates follow the independent ones well: a new one needs complete
    # pivoting, and starts without extrapolation.
    if chosen[0] > 0.0 and invert(problem, own) and dependence(problem, own) <= chosen[0]:
        return True
    choose(problem, own, DEPENDENT)
    chosen[1] = 0.0  # accelerations of the last step are those of other coordinates
    if own.rank[0] < len(own.rows) or not invert(problem, own):
        return False
    chosen[0] = _GROWN * max(1.0, dependence(problem, own))
    return True


@inner
def _predict(ahead, columns, a, chosen, last, c):
    """Accelerations ``c`` of the step: extrapolated, or those of the independent ``columns`` at its beginning, ``a``.

    ``last``: workspace for those of the last step.
    """
    count, independent = len(ahead), len(columns)
    for i in range(independent):
        # Extrapolated accelerations of the polynomial before, with the weight of the consistent ones at the start of
        # the step.
        now = a[columns[i]]
        for k in range(count):
            last[k] = c[k * independent + i]
        for k in range(count):
            extrapolated = ahead[k, count] * now
            for j in range(count):
                extrapolated += ahead[k, j] * last[j]
            c[k * independent + i] = extrapolated if chosen[1] > 0.0 else now
    chosen[1] = 1.0


@inner
def _guess(n, h, old, state):
    """All coordinates after a time h of constant accelerations."""
    copy(old, state)
    for i in range(n):
        state.x[i] += h * (old.v[i] + 0.5 * h * old.a[i])
        state.v[i] += h * old.a[i]


@inner
def place(columns, h, s, shape, old, c, state):
    """Independent entries (``columns``) of a state by the polynomial at the fraction s of the step.

    u'' = sum_k c_k l_k(s), u' and u its integrals from u'_0 and u_0 (`docs/theory/collocation.md`).
    """
    independent = len(columns)
    for i in range(independent):
        own = columns[i]
        # The polynomial is that of the accelerations: coordinates and velocities are its exact integrals, so that
        # positions of a step join to those before without conditions.
        x, v, a = 0.0, 0.0, 0.0
        for k in range(shape.shape[1]):
            x += shape[0, k] * c[k * independent + i]
            v += shape[1, k] * c[k * independent + i]
            a += shape[2, k] * c[k * independent + i]
        state.x[own] = old.x[own] + h * (s * old.v[own] + h * x)
        state.v[own] = old.v[own] + h * v
        state.a[own] = a


@inner
def _shape(powers, s, shape):
    """The double and the single integral of Lagrange's polynomials, and themselves, at s."""
    for k in range(len(powers)):
        shape[0, k], shape[1, k], shape[2, k] = 0.0, 0.0, 0.0
        # l_k(s) = sum_j powers[k, j] s^j; each power is integrated once and twice.
        power = 1.0
        for j in range(len(powers)):
            shape[0, k] += powers[k, j] * power * s * s / ((j + 1) * (j + 2))
            shape[1, k] += powers[k, j] * power * s / (j + 1)
            shape[2, k] += powers[k, j] * power
            power *= s


@kernel
def begin(
    problem: IntegrationProblem, rule: Rule, models: SampleModels, step: ScheduleStep, walk: CollocationRun
) -> int:
    """Begin a step: accelerations at a jump of the loads, independent coordinates, a prediction."""
    t, within = step.begin, step.within
    # Behind a jump the accelerations before it say nothing.
    if step.opens:
        walk.chosen[1] = 0.0
        if not accelerate(problem, models, t, within, walk.old, walk.dold, walk.consistency):
            return SINGULAR
        count_turns(models.turns, t, walk.old, STEP_END)
    old, own, work = walk.old, walk.partition, walk.consistency.complex_work
    set_signals(models.tangents, t, within, work)
    # Independent coordinates are chosen by the Jacobian at the start of the step.
    linearise(problem, models.tangents, old, work, own)
    if not _choose(problem, own, walk.chosen):
        return SINGULAR
    _predict(rule.ahead, own.columns[own.rank[0] : problem.n], old.a, walk.chosen, walk.shape[0], walk.c)
    points, nodes = walk.points, rule.nodes
    for s in range(len(nodes)):
        # All coordinates, the dependent ones too: the start of Newton's iteration at each Gauss point.
        _guess(problem.n, nodes[s] * (step.end - t), old, row(points, s))
    return DONE


@inner
def _reach(problem, rule, models, step, walk, share):
    """The state at a fraction of a step, consistent at all levels, with its derivatives, into ``walk.new``."""
    own, c, shape, old, new, dnews = walk.partition, walk.consistency, walk.shape, walk.old, walk.new, walk.dnew
    h = step.end - step.begin
    t, columns = step.end if share == 1.0 else step.begin + share * h, own.columns[own.rank[0] : problem.n]
    _shape(rule.powers, share, shape)
    _guess(problem.n, share * h, old, new)
    place(columns, h, share, shape, old, walk.c, new)
    for d in range(len(models.directions)):
        dold, dnew = row(walk.dold, d), row(dnews, d)
        copy(dold, dnew)
        place(columns, h, share, shape, dold, walk.dc[d], dnew)
    # Dependent coordinates and velocities by the constraints, then accelerations and multipliers by the equations of
    # motion: outputs satisfy all levels.
    if not settle(problem, models, t, step.within, VELOCITY, new, dnews, c.work, c.complex_work, one(c.slopes)[0], own):
        return NEWTON_FAILED
    return DONE if accelerate(problem, models, t, step.within, new, dnews, c) else SINGULAR


@inner
def _record(state, dstates, out, dout, due):
    write(state, row(out, due))
    for d in range(len(dstates.x)):
        write(row(dstates, d), row(rows(dout, d), due))


@kernel
def finish(
    problem: IntegrationProblem,
    rule: Rule,
    models: SampleModels,
    step: ScheduleStep,
    walk: CollocationRun,
    out: MotionStates,
    dout: Histories,
) -> int:
    """End a step with the accelerations that were found: the states at its output times, and the next state."""
    ended = False
    for due in range(step.first, step.last + 1):  # once more for the end
        share = (problem.times[due] - step.begin) / (step.end - step.begin) if due < step.last else 1.0
        if share > 0.0 and not ended:
            ended = share > 1.0 - 1e-9
            status = _reach(problem, rule, models, step, walk, 1.0 if ended else share)
            if status != DONE:
                return status
        state, dstates = (walk.new, walk.dnew) if share > 0.0 else (walk.old, walk.dold)
        if due < step.last:
            _record(state, dstates, out, dout, due)
            count_turns(models.turns, problem.times[due], state, due)
    copy(walk.new, walk.old)
    count_turns(models.turns, step.end, walk.old, STEP_END)
    for d in range(len(models.directions)):
        copy(row(walk.dnew, d), row(walk.dold, d))
    return DONE
