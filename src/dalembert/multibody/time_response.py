"""The response of a mechanism in time as a forward model."""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from dalembert.arguments import names_of
from dalembert.errors import InputError, ModelError, SolveError, require_known, told
from dalembert.findings import Finding
from dalembert.forward import Channel, Coordinate, Refinement, Responses, StateChart, ensemble, error_factor
from dalembert.forward.builders import built, check_function, cores, inexact, restructured
from dalembert.forward.complex_steps import Compared
from dalembert.forward.differences import COMPLEX_STEP, DERIVATIVES, central_differences
from dalembert.kernels.preparation import prepare
from dalembert.multibody.assemble import assembled, refuse_kinks, refuse_redundancy, refuse_unstable_start
from dalembert.multibody.callbacks import in_complex_numbers
from dalembert.multibody.complex_steps import Along, check_closures, check_forces, check_numbers
from dalembert.multibody.fingerprint import fingerprint
from dalembert.multibody.integrators.integrator import Integrator
from dalembert.multibody.integrators.problem import Problem
from dalembert.multibody.integrators.run import Run, make_problem
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.long_runs import check_pace, check_steps
from dalembert.multibody.lowered import Lowered
from dalembert.multibody.lowering import lower
from dalembert.multibody.observe import Observer, observer
from dalembert.multibody.restart import MotionSegment, chart
from dalembert.multibody.simulation import begin_time, checked, integrator, simulate
from dalembert.multibody.skipped_samples import late_samples, skipped_samples
from dalembert.multibody.slip_rates import rubbing
from dalembert.multibody.system import System
from dalembert.parameters import Parameter, Parameters


@dataclass(frozen=True)
class TimeResponse:
    """Channels of a mechanism at given times, as a function of parameters.

    Parameters
    ----------
    builder : callable
        ``builder(**parameters) -> System``; called with floats, and with complex numbers for derivatives.
    parameters : mapping of str to (lower, upper), or Parameters
    channels : sequence of str
        Such as ``"AB.end.x"``; see :meth:`Trajectory.channel_names`.
    times : array, shape (samples,)
        s; measured from the start of the motion, which ends at the last one.
    solver : Integrator or "auto", optional
        Generalized-alpha with steps of a thousandth of the motion if not given.
    workers : int, optional
        Threads of an ensemble; as many as there are cores if not given.
    derivative : {"complex-step", "central-differences"}
        The complex step is exact, and needs a builder that runs in complex numbers. When it is first used, and when an
        identification starts, it is compared with differences of the model's numbers, and of what functions of the
        user's return.
    begin : float
        Time of the signals at which the motion starts, s: loads and prescribed motions are read at ``begin + t``.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.multibody import DistanceJoint, PointMass, System, TimeResponse
    >>> def pendulum(length):
    ...     system = System()
    ...     bob = system.add(PointMass("bob", mass=1.0, position=(length, 0.0)))
    ...     system.add(DistanceJoint("rod", system.ground.point(0.0, 0.0), bob.centre))
    ...     return system
    >>> model = TimeResponse(pendulum, {"length": (0.5, 2.0)}, ["bob.centre.x"], np.array([0.0, 0.5]))
    >>> model.evaluate(np.array([[1.0], [2.0]])).values.round(3).tolist()
    [[[1.0], [0.391]], [[2.0], [1.644]]]
    >>> model.jacobian(np.array([1.0])).shape
    (2, 1, 1)
    """

    builder: Callable[..., System]
    parameters: Parameters
    channel_names: tuple[str, ...]
    times: np.ndarray
    solver: Integrator
    workers: int = field(default=1, compare=False)
    derivative: str = COMPLEX_STEP
    built_at: np.ndarray | None = field(default=None, compare=False)
    begin: float = 0.0

    def __init__(
        self,
        builder: Callable[..., System],
        parameters: Parameters | Mapping[str, Parameter | tuple[float, float]],
        channels: Sequence[str],
        times: ArrayLike,
        solver: Integrator | str | None = None,
        workers: int | None = None,
        derivative: str = COMPLEX_STEP,
        begin: float = 0.0,
    ) -> None:
        require_known("derivative", derivative, DERIVATIVES, "TimeResponse")
        times = checked(times)
        if times[-1] <= 0:
            raise InputError("TimeResponse: the last of the times is 0 s; expected a motion of some duration")
        channels = names_of(channels, "TimeResponse", "channels")
        if not channels:
            raise InputError("TimeResponse: no channels were given; name at least one, such as 'AB.end.x'")
        parameters = Parameters.of(parameters)
        check_function("TimeResponse", builder, [item.name for item in parameters.declared])
        solver = integrator(solver, float(times[-1]))
        check_steps("TimeResponse", solver, float(times[-1]), _MOST_STEPS)
        for name, value in (
            ("builder", builder),
            ("parameters", parameters),
            ("channel_names", channels),
            ("times", times),
            ("solver", solver),
            ("workers", workers or cores()),
            ("derivative", derivative),
            ("built_at", None),
            ("begin", begin_time("TimeResponse", begin)),
        ):
            object.__setattr__(self, name, value)

    def __getstate__(self) -> dict[str, Any]:
        """Without what was computed from the fields, which holds addresses of this process."""
        return {name: value for name, value in vars(self).items() if name in self.__dataclass_fields__}

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Channels with their units."""
        return self._observer.channels

    @property
    def coordinate(self) -> Coordinate:
        """The times of the samples."""
        return Coordinate("time", "s", self.times)

    @property
    def fingerprint(self) -> str:
        """Hash of the mechanism where it is built first, the channels, the times and the solver."""
        return self._fingerprint

    @cached_property
    def _fingerprint(self) -> str:
        differences = [self.derivative] * (self.derivative != COMPLEX_STEP)
        asked = self.parameters.identity, self.channel_names, self.solver, *differences
        return fingerprint(self._shared.lowered, self.times, *asked)

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch over all cores; ``vectors`` (batch, parameters), values (batch, samples, channels).

        A sample that fails is marked with its reason, and its values are NaN.
        """
        vectors = self.parameters.batch(vectors)
        values = np.full((len(vectors), len(self.times), len(self.channel_names)), np.nan)
        failures: list[str | None] = [None] * len(vectors)
        shared = self._shared

        def work(rows: np.ndarray) -> None:
            samples: list[tuple[int, Lowered]] = []
            for row in rows:
                try:
                    samples.append((row, self._lower(vectors[row])))
                except Exception as error:  # the user's builder raised: this sample's failure, not the batch's
                    failures[row] = told(error)
            runs = self._runs([own for _, own in samples])
            for (row, lowered), result in zip(samples, runs, strict=True):
                failures[row] = result.reason
                if result.reason is None:
                    states = result.states
                    values[row] = shared.observer.read(lowered, lowered.real, states.x, states.v, states.a, self.times)

        parts = _parts(len(vectors), self.workers)
        with in_complex_numbers(strict=False):
            list(ensemble(work, parts, workers=self.workers))
        return Responses(values, tuple(failures))

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Exact derivative of the discrete response, (samples, channels, parameters)."""
        return self.linearise(vector)[1]

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (samples, channels) and its exact derivative (samples, channels, parameters), in one run.

        Raises
        ------
        InputError
            Where the builder, or a function of the user's in the model, cannot run in complex numbers, or loses the
            imaginary part.
        SolveError
            Where the solver could not go on.
        """
        vector = self.parameters.real_vector(vector)
        if self.derivative != COMPLEX_STEP:
            return central_differences(self, vector)
        shared = self._shared
        self._prepare(shared.lowered, shared.observer, derivatives=True)
        with in_complex_numbers(strict=True):
            lowered = self._lower(vector)
            perturbed = [self._perturb(vector, column) for column in range(len(vector))]
            (result,) = self.solver.integrate([lowered], perturbed, shared.problem, self.times[-1])
        if result.reason:
            raise SolveError(result.reason)
        for name, own in zip(self.parameters.names, perturbed, strict=True):
            for error in (*lowered.failures.inexact, *own.failures.inexact):
                raise inexact(name, error) from error
        self._check(vector, lowered, result)
        states, slopes = result.states, result.derivatives
        values = shared.observer.read(lowered, lowered.real, states.x, states.v, states.a, self.times)
        jacobian = np.empty((*values.shape, len(vector)))
        for column, own in enumerate(perturbed):
            complex_state = [
                real + 1j * STEP * slope[column] for real, slope in zip(states[:3], slopes[:3], strict=True)
            ]
            response = shared.observer.read(own, own.complex_model, *complex_state, times=self.times)
            jacobian[:, :, column] = np.imag(response) / (STEP * self.parameters.scale[column])
        return values, jacobian

    def starting(self, values: Mapping[str, float]) -> "TimeResponse":
        """The same model, first built at these values of its parameters and not at their first guesses.

        What all samples share comes from there: the structure and typical sizes. So a mechanism that cannot be
        assembled at the first guesses can be identified from a start where it can.
        """
        own = copy(self)
        for name in ("_observer", "_shared", "_fingerprint"):
            vars(own).pop(name, None)
        vars(own)["built_at"] = self.parameters.real_vector({name: values[name] for name in self.parameters.names})
        return own

    def first(self, samples: int) -> "TimeResponse":
        """The same model, cut to its first ``samples`` samples; its simulations end earlier."""
        return self._sampled(self.times[:samples])

    def later(self, begin: float, times: ArrayLike) -> "TimeResponse":
        """The same model, whose motion starts at a later time of its signals.

        The initial state is what the builder makes of the parameters, as at time 0; prescribed motions place the
        mechanism as at the new start.

        Parameters
        ----------
        begin : float
            s, measured from the start of this model's motion.
        times : array, shape (samples,)
            Samples in s, measured from the new start.

        Examples
        --------
        The swing of a driven mass from the middle of a motion, whose state the parameters hold:

        >>> import numpy as np
        >>> from dalembert.multibody import Force, Harmonic, PointMass, System, TimeResponse
        >>> def driven(x, rate):
        ...     system = System()
        ...     mass = system.add(PointMass("mass", mass=1.0, position=(x, 0.0), velocity=(rate, 0.0)))
        ...     system.add(Force("drive", mass.centre, x=Harmonic(1.0, 2.0)))
        ...     return system
        >>> box, channels = {"x": (-1, 1), "rate": (-1, 1)}, ["mass.centre.x", "mass.centre.vx"]
        >>> model = TimeResponse(driven, box, channels, [0.5, 1.0])
        >>> whole = model.evaluate([[0.0, 0.0]]).values[0]
        >>> rest = model.later(0.5, [0.5]).evaluate(whole[:1]).values[0]
        >>> np.allclose(rest[0], whole[1], atol=1e-6)
        True
        """
        return self._sampled(times, begin=self.begin + begin_time("TimeResponse.later", begin))

    def state_chart(
        self,
        vector: np.ndarray,
        state: np.ndarray | None = None,
        *,
        whole: bool = False,
        like: StateChart | None = None,
    ) -> StateChart:
        """Return the independent coordinates and rates of a state, from which the joints make the others.

        Parameters
        ----------
        vector : array, shape (parameters,)
        state : array, shape (2n,), optional
            Coordinates and rates of the mechanism; those of the start at ``vector`` if not given.
        whole : bool
            Whether all coordinates and rates are named, dependent ones too.
        like : StateChart, optional
            Its coordinates are kept where they determine the others well.

        Examples
        --------
        >>> from dalembert.multibody import PointMass, RevoluteJoint, RigidBar, System, TimeResponse
        >>> def pendulum(angle):
        ...     system = System()
        ...     bar = system.add(RigidBar("bar", length=1.0, mass=1.0, angle=angle))
        ...     system.add(RevoluteJoint("pin", system.ground, bar.start))
        ...     return system
        >>> model = TimeResponse(pendulum, {"angle": (-1.0, 1.0)}, ["bar.end.x"], [0.5, 1.0])
        >>> model.state_chart(np.array([0.3])).names
        ('bar.angle', 'bar.angle rate')
        """
        if state is not None:
            return chart(self.lowered_at(vector, self.begin, closed=False), np.asarray(state), whole, like)
        lowered = self._lower(self.parameters.real_vector(vector))
        n = lowered.structure.n
        return chart(lowered, np.concatenate([lowered.x[:n], lowered.v[:n]]), whole, like)

    def restarted(
        self, begin: float, times: ArrayLike, chart: StateChart | None, ends: StateChart | None
    ) -> MotionSegment:
        """Return the model of a segment of the motion, which begins at independent coordinates and rates.

        Parameters
        ----------
        begin : float
            s, measured from the start of this model's motion.
        times : array, shape (samples,)
            Samples in s, measured from the start of the segment.
        chart : StateChart or None
            Names the numbers that the segment begins at: parameters behind those of this model. The segment begins as
            this model's motion if None.
        ends : StateChart or None
            Names numbers of the state that are channels behind those of this model.

        Examples
        --------
        The second half of a swing, from the state in its middle:

        >>> from dalembert.multibody import RevoluteJoint, RigidBar, System, TimeResponse
        >>> def pendulum(angle):
        ...     system = System()
        ...     bar = system.add(RigidBar("bar", length=1.0, mass=1.0, angle=angle))
        ...     system.add(RevoluteJoint("pin", system.ground, bar.start))
        ...     return system
        >>> model = TimeResponse(pendulum, {"angle": (-1.0, 1.0)}, ["bar.end.x"], [0.5, 1.0])
        >>> start = model.state_chart(np.array([0.3]))
        >>> whole = model.restarted(0.0, [0.5, 1.0], None, start).evaluate([[0.3]]).values[0]
        >>> half = model.restarted(0.5, [0.5], start, None)
        >>> np.allclose(half.evaluate([[0.3, *whole[0, 1:]]]).values[0, 0], whole[1, 0], atol=1e-6)
        True
        """
        later = self.begin + begin_time("TimeResponse.restarted", begin)
        return MotionSegment(self, later, checked(times), chart, ends)

    def part(self, share: float) -> "tuple[TimeResponse, float]":
        """The same model until a share of its time, and that share; a simulation takes about this part of the time."""
        end = share * self.times[-1]
        times = np.concatenate([[0.0], self.times[(self.times > 0) & (self.times < end)], [end]])
        return self._sampled(times), share

    def refined(self) -> Refinement | None:
        """Return the same model at half the step, or at a tolerance 100 times tighter; None for an unknown order."""
        finer = self.solver.refined()
        if finer is None:
            return None
        solver, order = finer
        model = self._sampled(self.times, solver=solver)
        how = "at a tolerance 100 times tighter" if order is None else "at half the step"
        return Refinement(model, error_factor(order), how)

    def system(self, vector: np.ndarray) -> System:
        """The mechanism at a parameter vector (parameters,)."""
        return built(self.builder, self.parameters.mapping(vector), System)

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex step with differences of the model's numbers at a vector (parameters,).

        Nothing is simulated. The forces of functions of the user's are compared by the next derivative, along its
        motion.

        Raises
        ------
        InputError
            With the parameter, the component and its number, where the builder drops the imaginary part.
        """
        if self.derivative == COMPLEX_STEP:
            self._compared.once(vector, lambda thorough: check_numbers(self.builder, self.parameters, vector, thorough))

    def findings(self, vector: np.ndarray) -> tuple[Finding, ...]:
        """Findings on the mechanism at a parameter vector (parameters,), and on its motion where joints have friction.

        With Coulomb friction the motion is simulated once.
        """
        system, late = self.system(vector), late_samples(self.times)
        try:
            if not rubbing(system):
                step, end = self.solver.fixed_step, float(self.times[-1])
                return (*system.findings, *late, *skipped_samples(system, step, self.begin, end))
            return (*simulate(system, float(self.times[-1]), self.solver, begin=self.begin).findings, *late)
        except (ModelError, SolveError, InputError):  # no motion, or one that does not fit into memory
            return (*system.findings, *late)

    def _sampled(self, times: ArrayLike, *, begin: float | None = None, solver: Integrator | None = None) -> Self:
        """The same model with other samples, start or solver, whose derivatives were compared if this model's were."""
        own = type(self)(
            self.builder, self.parameters, self.channel_names, times, solver or self.solver, self.workers,
            self.derivative, self.begin if begin is None else begin,
        )  # fmt: skip
        vars(own)["_compared"], vars(own)["built_at"] = self._compared, self.built_at
        return own

    @cached_property
    def _compared(self) -> Compared:
        return Compared()

    def _check(self, vector: np.ndarray, lowered: Lowered, run: Run) -> None:
        """Compare the complex step with differences, where that was not done."""
        if not self._compared.vectors:
            self.check_derivatives(vector)
        if not self._compared.functions:
            at = Along(self._shared.observer, self.times, run.states, self.begin)
            check_forces(lowered, at, self._shared.problem.scale)
            check_closures(self.builder, self.parameters, vector, at)
            self._compared.functions = True

    @property
    def _first_system(self) -> System:
        """The mechanism that all samples share their structure with."""
        return self.system(self.parameters.start if self.built_at is None else self.built_at)

    @cached_property
    def _observer(self) -> Observer:
        """The channels of the mechanism as it is placed: joints may not be closed yet."""
        system = self._first_system
        return observer(system, lower(system, self.begin), self.channel_names)

    @cached_property
    def _shared(self) -> "_Shared":
        system = self._first_system
        placed = lower(system, self.begin)
        self._prepare(placed, self._observer, derivatives=False)
        lowered = assembled(system, placed=placed)
        refuse_unstable_start(system, lowered)
        if not self.solver.suiting(lowered, float(self.times[-1])).takes_redundancy:
            refuse_redundancy(lowered)
        refuse_kinks(lowered, float(self.times[-1]))
        check_pace(lowered, self.solver.suiting(lowered, float(self.times[-1])), float(self.times[-1]))
        return _Shared(lowered, make_problem(lowered, self.times), observer(system, lowered, self.channel_names))

    def _prepare(self, lowered: Lowered, observer: Observer, derivatives: bool) -> None:
        """Compile, or load, what the method needs."""
        solver = self.solver.suiting(lowered, float(self.times[-1]))
        kernels = lowered.kernels(derivatives), solver.kernels(lowered.structure, derivatives)
        prepare([*kernels[0], *kernels[1], *observer.kernels(lowered, derivatives)])

    def _runs(self, samples: Sequence[Lowered]) -> list[Run]:
        if not samples:
            return []
        return self.solver.integrate(samples, (), self._shared.problem, self.times[-1], logged=False)

    @property
    def shared(self) -> "_Shared":
        """What all samples share."""
        return self._shared

    def prepare_derivatives(self) -> None:
        """Compile, or load, what sensitivities need."""
        self._prepare(self._shared.lowered, self._shared.observer, derivatives=True)

    def placed(self, vector: np.ndarray, begin: float) -> tuple[Lowered, tuple[Lowered, ...]]:
        """Arrays of the mechanism as placed, and those moved along each parameter; kept for the last vector.

        Segments of one motion share them, unless signals depend on when they begin.
        """
        moment = begin if len(self._shared.lowered.structure.signals) > 1 else 0.0
        key = vector.tobytes(), moment
        kept = vars(self).get("_placed")
        if kept is None or kept[0] != key:
            lowered = self.lowered_at(vector, moment, closed=False)
            perturbed = tuple(self.perturbed_at(vector, column, moment, closed=False) for column in range(len(vector)))
            kept = vars(self)["_placed"] = key, (lowered, perturbed)
        return kept[1]

    def lowered_at(self, vector: np.ndarray, begin: float, *, closed: bool) -> Lowered:
        """Arrays of the mechanism at a parameter vector and a time of the signals; as placed if not ``closed``."""
        system = self.system(vector)
        return self._fit(assembled(system, begin=begin) if closed else lower(system, begin))

    def perturbed_at(self, vector: np.ndarray, column: int, begin: float, *, closed: bool) -> Lowered:
        """The arrays of :meth:`lowered_at`, moved by a complex step of the scale of one parameter."""
        perturbed = vector.astype(complex)
        perturbed[column] += 1j * STEP * self.parameters.scale[column]
        given: dict[str, complex] = dict(self.parameters.mapping(vector))
        given[self.parameters.names[column]] = complex(perturbed[column])
        try:
            system = built(self.builder, given, System)
            return self._fit(assembled(system, perturbed=True, begin=begin) if closed else lower(system, begin))
        except (TypeError, ModelError, np.exceptions.ComplexWarning) as error:
            error = error.__cause__ if isinstance(error, ModelError) else error
            if not isinstance(error, TypeError | np.exceptions.ComplexWarning):
                raise
            raise inexact(self.parameters.names[column], error) from error

    def _lower(self, vector: np.ndarray) -> Lowered:
        """Arrays of one sample, in the structure of the first."""
        return self.lowered_at(vector, self.begin, closed=True)

    def _perturb(self, vector: np.ndarray, column: int) -> Lowered:
        """Arrays of the model along one parameter, moved by a complex step of its scale."""
        return self.perturbed_at(vector, column, self.begin, closed=True)

    def _fit(self, lowered: Lowered) -> Lowered:
        structure = self._shared.lowered.structure
        if not structure.same(lowered.structure):
            raise restructured()
        return replace(lowered, structure=structure)


@dataclass(frozen=True)
class _Shared:
    """What all samples share, from the system where it is built first."""

    lowered: Lowered
    problem: Problem
    observer: Observer


def _parts(count: int, workers: int) -> list[np.ndarray]:
    """Rows of a batch cut into parts: small enough that no worker waits long for another at the end."""
    size = max(1, min(16, -(-count // (4 * workers))))
    return [np.arange(begin, min(begin + size, count)) for begin in range(0, count, size)]


_MOST_STEPS = 1e9  # hours, even of the smallest mechanisms
