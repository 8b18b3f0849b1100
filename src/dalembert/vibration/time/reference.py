"""Periodic motions by integration in time: a reference for harmonic balance that shares its laws of contact alone."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from scipy.sparse.linalg import LinearOperator, gmres

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, SolveError, require_known
from dalembert.threads import single_thread
from dalembert.vibration.balance.equations import equations, require_one_period
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.preparation import balance_kernels, prepare_together
from dalembert.vibration.fourier import Fourier, synthesis
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import observed, response_of, restarted
from dalembert.vibration.storage import versions
from dalembert.vibration.system.requirements import require_forces
from dalembert.vibration.system.system import VibrationSystem
from dalembert.vibration.time.elements import Elements, Instant, Reaction, react, reaction, settle
from dalembert.vibration.time.modal_system import ModalSystem, address
from dalembert.vibration.time.newmark import Newmark
from dalembert.vibration.time.periodic_motion import PeriodicMotion
from dalembert.vibration.time.steps import LOST, ModalState, ModalStructure, Record, Scheme, go_through, scratch

LONG_RUN, SHOOTING = "long run", "shooting"
WARMING = 5
"""Periods before shooting begins, after which motions without memory of the start are gone."""


@takes_checked("way", "observe")
@single_thread()
def steady_state(
    system: VibrationSystem,
    frequency: float,
    method: Newmark | None = None,
    *,
    way: str = LONG_RUN,
    start: tuple[FrequencyCurve, int] | None = None,
    observe: Sequence[str] | None = None,
) -> PeriodicMotion:
    """The periodic motion under forces of a frequency, by integration in time.

    Parameters
    ----------
    system : VibrationSystem
        With at most 1500 degrees of freedom. Rigid contacts are replaced by stiff elastic ones, see :class:`Newmark`.
    frequency : float
        Hz, positive.
    method : Newmark, optional
    way : {"long run", "shooting"}
        Period after period until one changes nothing, or Newton's method on what a period changes, which needs fewer
        where the damping is low.
    start : (FrequencyCurve, int), optional
        A curve of the same system and the number of one of its points: the motion starts from there. From rest, with
        sliders where they stand, if not given.
    observe : sequence of str, optional
        Degrees of freedom, nodes or sets of nodes whose motion is kept; as in :func:`frequency_response` if not given.

    Returns
    -------
    PeriodicMotion
        Marked if it is not periodic after the periods that the method allows.

    Raises
    ------
    InputError
        For a frequency that is not positive, a system without a force, an unknown way, unknown degrees of freedom, and
        a start that does not fit.
    ModelError
        For a structure too large, or with neither mass nor stiffness somewhere.
    SolveError
        Where the contacts of a step cannot be solved.

    Examples
    --------
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import ElasticSlider, FrictionContact, HarmonicForce, VibrationSystem
    >>> system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    >>> force = system.add(HarmonicForce("m", 1.0))
    >>> damper = system.add(FrictionContact("damper", "m", friction=0.5, preload=2.0, law=ElasticSlider(0.8)))
    >>> motion = steady_state(system, 1.12 / (2 * np.pi), Newmark(steps_per_period=1024), way="shooting")
    >>> round(motion.amplitude("m"), 3)
    3.625
    """
    method = method or Newmark()
    if not (np.isfinite(frequency) and frequency > 0):
        raise InputError(f"steady_state: the frequency is {frequency}; expected a positive number in Hz")
    require_forces(system.forces, np.array([frequency]), "steady_state")
    require_known("way", way, (LONG_RUN, SHOOTING), "steady_state")
    lowered = lower(system).real
    problem = ModalSystem(lowered, 2 * np.pi * frequency, method.steps_per_period, method.stand_in)
    rows = observed(lowered, observe)
    kernels = [react, go_through]
    if start is not None:  # the motion starts as the method of the curve has it
        events = HarmonicBalance(**start[0].provenance["method"]).events
        kernels += [settle, *balance_kernels(lowered, events, residuals=True, derivatives=False)]
    prepare_together(kernels)
    run = _Run(problem, method, [])
    state = run.rest() if start is None else run.on_curve(system, *start)
    ended = run.long(state, method.periods, method.tolerance) if way == LONG_RUN else run.shot(state)
    return _periodic_motion(run, rows, float(frequency), ended, {**versions(), "method": asdict(method), "way": way})


def _periodic_motion(
    run: "_Run", rows: np.ndarray, frequency: float, ended: "_Ended", provenance: dict[str, Any]
) -> PeriodicMotion:
    """Return the last period of a run, with the motion of some rows of the structure."""
    problem, lowered, steps = run.problem, run.problem.lowered, run.problem.steps
    # Records are at the ends of steps: rolled by one, the first is the beginning of the period.
    record = Record(*(np.roll(array, 1, axis=0) for array in ended.record))
    summed = np.zeros((steps, len(lowered.row_names)))
    np.add.at(summed.T, problem.places, record.forces.T)
    return PeriodicMotion(
        dofs=tuple(lowered.structure.dofs.names[row] for row in rows),
        coordinates=lowered.row_names,
        contacts=lowered.contacts,
        frequency=frequency,
        times=np.arange(steps) / (frequency * steps),
        displacements=record.modes @ problem.spectral.shapes[rows].T,
        relative=record.modes @ (lowered.matrix @ problem.spectral.shapes).T,
        forces=summed,
        states=record.states,
        periods=ended.periods,
        residual=ended.change,
        converged=ended.change <= run.method.tolerance,
        provenance=provenance,
    )


Period = Callable[[np.ndarray], tuple[np.ndarray, float]]
"""Gives the state a period after a state, and the size of the change."""
PARTS = (1.0, 0.5, 0.25, 0.125)
"""Parts of a Newton step that are tried before a plain period is."""
DIFFERENCE = 1e-7
"""Step of the differences, as part of the state."""
DIRECTIONS = 60
"""Most directions of a Newton step."""


def shoot(period: Period, state: np.ndarray, tolerance: float, most: int) -> tuple[np.ndarray, int]:
    """A state (unknowns,) that a period returns to, and the periods to it; one with the least change if there is none.

    ``state`` (unknowns,): in scales in which its parts are comparable; ``tolerance``: of the change; ``most``: periods.
    """
    (after, change), run = period(state), 1
    while change > tolerance and run < most:
        off, calls = after - state, []
        # Newton's method on Φ(y) - y: GMRES needs only products with ∂Φ/∂y - 1, each a period with a perturbed state.
        # Eigenvalues of a damped system cluster at -1, so that a few directions suffice.
        step, _ = gmres(
            _slope(period, state, after), -off, rtol=1e-4, restart=min(DIRECTIONS, len(state)), maxiter=1,
            callback=calls.append, callback_type="pr_norm",
        )  # fmt: skip
        run += len(calls) + 2
        # A Newton step may cross a change of states: its parts are tried, then a plain period, which a damped motion
        # always may take.
        for part in PARTS:
            place = state + part * step
            (end, moved), run = period(place), run + 1
            if np.linalg.norm(end - place) < (1 - 0.1 * part) * np.linalg.norm(off):
                state, after, change = place, end, moved
                break
        else:
            state, (after, change), run = after, period(after), run + 1
    return state, run


def _slope(period: Period, state: np.ndarray, after: np.ndarray) -> Any:
    """Derivative of what a period changes, as an operator on directions."""
    size = float(np.linalg.norm(after)) or 1.0

    def along(direction: np.ndarray) -> np.ndarray:
        # Differences, not the complex step: kernels in time are real.
        step = DIFFERENCE * size / (float(np.linalg.norm(direction)) or 1.0)
        return (period(state + step * direction)[0] - after) / step - direction

    return cast(Any, LinearOperator)((len(state), len(state)), matvec=along, dtype=float)


@dataclass(frozen=True)
class _Ended:
    """Where a run ended, with its last period."""

    state: ModalState
    record: Record
    periods: int
    change: float


@dataclass(frozen=True)
class _Run:
    """Runs of a system with a method; failures of the user's laws are kept."""

    problem: ModalSystem
    method: Newmark
    failures: list[Exception]

    @cached_property
    def _users(self) -> Any:
        return self.problem.users(self.failures)

    @cached_property
    def _arrays(self) -> tuple[ModalStructure, Elements]:
        return self.problem.arrays(self._scheme)

    @cached_property
    def _scheme(self) -> Scheme:
        return self.method.scheme(self.problem.omega)

    def rest(self) -> ModalState:
        """At rest, with sliders where they stand."""
        modes = self.problem.seen.shape[1]
        return self._balanced(np.zeros(modes), np.zeros(modes), *self._memory())

    def on_curve(self, system: VibrationSystem, curve: FrequencyCurve, point: int) -> ModalState:
        """On a point of a curve, with sliders as its motion moves them."""
        method = HarmonicBalance(**curve.provenance["method"])
        require_one_period(method, "steady_state")
        balance = equations(system, method)
        x = response_of(balance, restarted(balance, curve, point, "steady_state"))
        steps = self.method.steps_per_period
        waves = synthesis(curve.orders, 2 * np.pi * np.arange(1, steps + 1) / steps)
        rates = Fourier(curve.orders, steps).derivative.T @ waves[-1]
        (sliders, states), seen = self._memory(), np.asarray(self.problem.lowered.matrix @ x)[self.problem.places]
        places = np.ascontiguousarray(waves @ seen.T)
        speeds = np.ascontiguousarray(self.problem.omega * waves @ Fourier(curve.orders, steps).derivative @ seen.T)
        # Sliders and states are not in the curve: its motion is gone through until they return.
        settle(self.problem.elements, address(self._users), places, speeds, sliders, states, self._reaction())
        # Displacements and velocities at the end of the period, where a step begins, in modes.
        places = np.stack([x @ waves[-1], self.problem.omega * (x @ rates)], axis=1)
        place, velocity = np.linalg.solve(self.problem.spectral.shapes, places).T
        return self._balanced(place, velocity, sliders, states)

    def long(self, state: ModalState, most: int, tolerance: float) -> _Ended:
        """Period after period."""
        modes, elements = self._arrays
        steps, rows = self.method.steps_per_period, len(modes.seen)
        record = Record(
            np.empty((steps, len(modes.mass))), np.empty((steps, rows)), np.empty((steps, rows)),
            np.zeros((steps, len(self.problem.lowered.contacts)), dtype=np.uint8),
        )  # fmt: skip
        state = ModalState(*(array.copy() for array in state))
        status, count, change = go_through(
            modes, elements, address(self._users), self._scheme, state, self.problem.omega, most, tolerance, record,
            self._reaction(), scratch(modes, state),
        )  # fmt: skip
        if self.failures:
            raise self.failures[0]
        if status == LOST:
            period, step = divmod(int(count), steps)
            raise SolveError(
                f"steady_state: the contacts could not be solved in step {step + 1} of period {period + 1} at "
                f"{self.problem.omega / (2 * np.pi):.6g} Hz; take more than {steps} steps of a period"
            )
        return _Ended(state, record, int(count), float(change))

    def shot(self, state: ModalState) -> _Ended:
        """By shooting, after some periods."""
        # A few periods first: transients of strongly damped modes are gone, and Newton's method starts near the motion.
        warm = self.long(state, min(WARMING, self.method.periods), self.method.tolerance)
        if warm.change <= self.method.tolerance:
            return warm
        scale = self._scale(warm)

        def period(flat: np.ndarray) -> tuple[np.ndarray, float]:
            ended = self.long(self._state(flat, scale), 1, self.method.tolerance)
            return self._flat(ended.state, scale), ended.change

        left = self.method.periods - warm.periods
        closest, periods = shoot(period, self._flat(warm.state, scale), self.method.tolerance, left)
        last = self.long(self._state(closest, scale), 1, self.method.tolerance)
        return replace(last, periods=warm.periods + periods + 1)

    def _scale(self, warm: _Ended) -> np.ndarray:
        """Of displacements, velocities and two kinds of accelerations, and of sliders, as :meth:`_flat` has them."""
        size = float(np.linalg.norm(warm.state.modes[:2] / [[1.0], [self.problem.omega]])) or 1.0
        widest = float(np.abs(warm.record.displacements).max(initial=0.0)) or 1.0
        # ω, ω² times the displacements: shooting compares parts of the state in one norm.
        each = size * self.problem.omega ** np.array([0.0, 1.0, 2.0, 2.0])
        modes, states = np.repeat(each, len(self.problem.spectral.mass)), np.abs(warm.state.states)
        return np.concatenate([modes, np.full(warm.state.sliders.size, widest), np.where(states > 0, states, 1.0)])

    def _flat(self, state: ModalState, scale: np.ndarray) -> np.ndarray:
        return np.concatenate([part.ravel() for part in state]) / scale

    def _state(self, flat: np.ndarray, scale: np.ndarray) -> ModalState:
        modes, cells = 4 * len(self.problem.spectral.mass), 2 * len(self.problem.elements.tangents)
        modal, sliders, states = np.split(flat * scale, [modes, modes + cells])
        return ModalState(modal.reshape(4, -1), sliders.reshape(-1, 2), states)

    def _memory(self) -> tuple[np.ndarray, np.ndarray]:
        still = self._reaction()
        return np.zeros_like(still.moved), np.zeros_like(still.next)

    def _balanced(self, place: np.ndarray, velocity: np.ndarray, sliders: np.ndarray, states: np.ndarray) -> ModalState:
        """With the accelerations that the forces at the start of a period ask for."""
        seen, response = self.problem.seen, self._reaction()
        instant = Instant(seen @ place, seen @ velocity, 0.0, sliders, states)
        react(self.problem.elements, address(self._users), instant, response)
        if self.failures:
            raise self.failures[0]
        # M a = f - L^T λ - C v - K x at the start; modes without mass have no acceleration.
        push = self.problem.forces[-1] - seen.T @ response.force
        # Auxiliary accelerations begin as the real ones.
        acceleration = self.problem.spectral.accelerations(push, place, velocity)
        return ModalState(np.stack([place, velocity, acceleration, acceleration]), sliders, states)

    def _reaction(self) -> Reaction:
        return reaction(len(self.problem.seen), self.problem.elements, len(self.problem.lowered.contacts))
