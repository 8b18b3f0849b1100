"""Motion of a system in time."""

import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import is_number, takes_checked
from dalembert.errors import InputError, shown, unknown
from dalembert.kernels.preparation import prepare
from dalembert.multibody.integrators.generalized_alpha.generalized_alpha import GeneralizedAlpha
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.run import make_problem
from dalembert.multibody.kernels.callbacks import in_complex_numbers
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.observe import Observer
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.model.turns import counted_angles, turn_kernels
from dalembert.multibody.motion.long_runs import MOST_STEPS, check_pace, check_steps, works
from dalembert.multibody.motion.trajectory import Trajectory
from dalembert.multibody.start.assemble import assembled, refuse_kinks, refuse_redundancy, refuse_unstable_start

_ADAPTIVE_OUTPUTS = 1001
_FEW_JUMPS = 100  # of loads, at which states are kept for their work; a held table has one a sample
_ROOM = 20_000_000  # numbers up to which the states of all steps are kept, where loads and losses may do work


@takes_checked("system", "end", "solver", "times", "most_steps")
def simulate(
    system: BaseSystem,
    end: float,
    solver: Integrator | str | None = None,
    times: np.ndarray | None = None,
    *,
    most_steps: float = MOST_STEPS,
    begin: float = 0.0,
) -> Trajectory:
    """Integrate the motion of a system from its placement.

    Parameters
    ----------
    system : Mechanism
    end : float
        s.
    solver : Integrator or "auto", optional
        "auto" takes the one that suits the mechanism, see :class:`Automatic`. Generalized-alpha with steps of
        ``end`` / 1000 if not given.
    times : array, shape (samples,), optional
        Output times in s, increasing, within [0, end]. Every step if not given; 1001 equal ones if the solver chooses
        its steps. Between steps the motion is interpolated, by generalized-alpha cubically.

    most_steps : float
        Fixed steps from which the simulation is refused. Methods that choose their steps have the setting
        ``most_steps``.
    begin : float
        Time of the signals at which the motion starts, s: loads and prescribed motions are read at ``begin + t``. The
        times of the motion, ``end`` included, are measured from there.

    Returns
    -------
    Trajectory

    Raises
    ------
    InputError
        For times that do not increase or lie outside the motion, and for more than ``most_steps`` fixed steps.
    ModelError
        Where the mechanism cannot be assembled or has redundant constraints.
    SolveError
        Where the solver failed, with time and component.

    Examples
    --------
    >>> from dalembert.multibody import DistanceJoint, GeneralizedAlpha, PointMass, System, simulate
    >>> system = System()
    >>> bob = system.add(PointMass("bob", mass=1.0, position=(-1.0, 0.0)))
    >>> rod = system.add(DistanceJoint("rod", system.ground.point(0.0, 0.0), bob.centre))
    >>> trajectory = simulate(system, end=1.0, solver=GeneralizedAlpha(step=1e-3))
    >>> trajectory.channels(["bob.centre.x"])[-1].round(3)
    array([0.986])
    """
    with in_complex_numbers(strict=False):
        lowered, chosen, times, grid = posed(system, end, solver, times, most_steps, begin)
        check_pace(lowered, chosen, end)
        problem, counted = make_problem(lowered, grid), counted_angles(lowered)
        (result,) = chosen.integrate([lowered], (), problem, end, counted=counted)
        if other := integrator(solver, end).instead(result.reason):
            (second,) = other.integrate([lowered], (), problem, end, counted=counted)
            chosen, result = (chosen, result) if second.reason else (other, second)
    if result.reason:
        raise result.reason
    return Trajectory(system, lowered, chosen, result, np.searchsorted(grid, times))


def posed(
    system: BaseSystem,
    end: float,
    solver: Integrator | str | None,
    times: np.ndarray | None,
    most_steps: float = np.inf,
    begin: float = 0.0,
) -> tuple[Lowered, Integrator, np.ndarray, np.ndarray]:
    """Return what :func:`simulate` integrates, after all its checks.

    The assembled mechanism, its integrator, the output times (samples,), and the times at which states are kept.
    """
    if not (is_number(end) and not np.iscomplexobj(end) and end > 0):
        raise InputError(f"simulate: end is {shown(end)}; expected a positive number of seconds")
    given = integrator(solver, end)
    check_steps("simulate", given, end, most_steps, advice=", or raise most_steps")
    lowered, chosen = prepared(system, end, given, begin_time("simulate", begin))
    count = _ADAPTIVE_OUTPUTS if chosen.fixed_step is None else end / chosen.fixed_step
    worked = works(lowered) and count * len(lowered.x) < _ROOM
    if times is None:
        _check_memory(chosen, end, 3 * len(lowered.x) * count)
    steps = chosen.step_ends(end, lowered.jumps) if times is None or worked else np.zeros(1)
    if steps is None:
        steps = np.linspace(0.0, end, _ADAPTIVE_OUTPUTS)
    times = steps if times is None else checked(times, end)
    jumps = [time for time in lowered.jumps if 0.0 < time < end] if len(lowered.jumps) <= _FEW_JUMPS else []
    return lowered, chosen, times, np.union1d(times, [*steps, *jumps] if worked else 0.0)


def _check_memory(solver: Integrator, end: float, numbers: float) -> None:
    """Refuse numbers of all steps that the machine's memory cannot hold."""
    needed, there = 8e-9 * numbers, 1e-9 * memory()
    if needed > there:
        raise InputError(
            f"simulate: the states of all steps, {solver} until {end:g} s, need {needed:.3g} GB of memory; there are "
            f"{there:.3g} GB. Use larger steps, a shorter motion, or output times"
        )


def memory() -> float:
    """Return the size of the machine's memory in bytes; infinity where the system does not say it."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return np.inf


def begin_time(where: str, begin: Any) -> float:
    """The time of the signals at which a motion starts, refused where it is no number of seconds."""
    if not is_number(begin) or np.iscomplexobj(begin):
        raise InputError(f"{where}: begin is {shown(begin)}; expected a number of seconds")
    return float(begin)


def prepared(
    system: BaseSystem, end: float, solver: Integrator, begin: float = 0.0, readers: Observer | None = None
) -> tuple[Lowered, Integrator]:
    """Return the assembled mechanism and the integrator that suits it, compiled and checked; with its channels."""
    placed = lower(system, begin)
    kernels = [*placed.kernels(), *solver.suiting(placed, end).kernels(placed.structure)]
    prepare([*kernels, *(readers.kernels(placed, False) if readers else turn_kernels(counted_angles(placed)))])
    lowered = assembled(system, placed=placed)
    refuse_unstable_start(system, lowered)
    solver = solver.suiting(lowered, end)
    if not solver.takes_redundancy:
        refuse_redundancy(lowered)
    refuse_kinks(lowered, end)
    return lowered, solver


def integrator(given: Integrator | str | None, end: float) -> Integrator:
    """The integrator that is meant."""
    if given is None:
        return GeneralizedAlpha(step=end / 1000)
    if isinstance(given, str):
        if given != "auto":
            known = unknown("solver", given, ("auto",))
            raise InputError(f"{known} Or give an integrator, such as GeneralizedAlpha(step=1e-3)")
        from dalembert.multibody.integrators.automatic import Automatic  # with all integrators that it may choose

        return Automatic()
    if not isinstance(given, Integrator):
        hint = f"; write {given.__name__}(...)" if isinstance(given, type) and issubclass(given, Integrator) else ""
        raise InputError(
            f"solver is {shown(given)}; expected 'auto' or an integrator, such as GeneralizedAlpha(step=1e-3){hint}"
        )
    return given


def checked(times: ArrayLike, end: float = np.inf) -> np.ndarray:
    """Output times as an array, refused where they cannot be meant."""
    try:
        times = np.array(times, dtype=object).astype(float)
    except (TypeError, ValueError):
        raise InputError(f"times is {shown(times)}; expected a list of increasing numbers of seconds") from None
    if times.ndim != 1 or len(times) == 0 or not np.all(np.diff(times) > 0):
        raise InputError("times: expected a list of increasing numbers of seconds")
    if times[0] < 0:
        raise InputError(f"times: the first is {times[0]:g} s, but the motion begins at 0 s; give times from 0 s on")
    if times[-1] > end * (1 + 1e-12):
        raise InputError(
            f"times: they reach from {times[0]:g} to {times[-1]:g} s, but the motion ends at {end:g} s; expected times "
            "within"
        )
    return times
