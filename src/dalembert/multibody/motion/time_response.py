"""The response of a mechanism in time as a forward model."""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from dalembert.argument_readers import names_of
from dalembert.errors import InputError, ModelError, SolveError, require_known
from dalembert.findings import Finding
from dalembert.forward import Refinement, StateChart, error_factor
from dalembert.forward.builders import check_function, cores
from dalembert.forward.differences import COMPLEX_STEP, DERIVATIVES
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.model.fingerprint import fingerprint
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.motion.bushing_rotations import turning_bushings
from dalembert.multibody.motion.long_runs import check_steps
from dalembert.multibody.motion.motion_model import BuiltModel
from dalembert.multibody.motion.restart import MotionSegment, chart
from dalembert.multibody.motion.simulation import begin_time, checked, integrator, simulate
from dalembert.multibody.motion.skipped_samples import late_samples, skipped_samples
from dalembert.multibody.motion.slip_rates import rubbing
from dalembert.multibody.start.assemble import assembled
from dalembert.multibody.start.start_findings import joined, start_findings
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

_MOST_STEPS = 1e9  # hours, even of the smallest mechanisms
_QUICK_STEPS = 1e5  # of a motion at other times, which only shows how fast it is


@dataclass(frozen=True)
class TimeResponse(BuiltModel):
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

    def __init__(
        self,
        builder: Callable[..., BaseSystem],
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
        begin = begin_time("TimeResponse", begin)
        given = builder, parameters, channels, times, solver, workers or cores(), derivative, None, begin
        vars(self).update(zip(self.__dataclass_fields__, given, strict=True))

    @property
    def fingerprint(self) -> str:
        """Hash of the mechanism where it is built first, the channels, the times and the solver."""
        return self._fingerprint

    @cached_property
    def _fingerprint(self) -> str:
        differences = [self.derivative] * (self.derivative != COMPLEX_STEP)
        asked = self.parameters.identity, self.channel_names, self.solver, *differences
        return fingerprint(self.shared, self.times, *asked)

    def starting(self, values: Mapping[str, float]) -> "TimeResponse":
        """The same model, first built at these values of its parameters and not at their first guesses.

        What all samples share comes from there: the structure and typical sizes. So a mechanism that cannot be
        assembled at the first guesses can be identified from a start where it can.
        """
        own = copy(self)
        vars(own)["built_at"] = self.parameters.real_vector({name: values[name] for name in self.parameters.names})
        return own

    def first(self, samples: int) -> "TimeResponse":
        """The same model, cut to its first ``samples`` samples; its simulations end earlier."""
        return self._sampled(self.times[:samples])

    def at(self, times: ArrayLike) -> "TimeResponse":
        """The same model at other samples; a motion of very many fixed steps gets a thousand instead.

        Parameters
        ----------
        times : array, shape (samples,)
            s; the motion ends at the last one.
        """
        step, end = self.solver.fixed_step, float(np.max(times))
        solver = self.solver if step is None or end < _QUICK_STEPS * step else integrator(None, end)
        return self._sampled(times, solver=solver)

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
        state : array, shape (2n + turning,), optional
            Coordinates and rates of the mechanism, and whole turns of the channels that are angles which these give up
            to whole turns, as a segment reads them; those of the start at ``vector`` if not given.
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
        turning = tuple(self.channel_names[column] for column in self.observer.turning)
        if state is not None:
            return chart(self.lowered_at(vector, self.begin, closed=False), np.asarray(state), whole, like, turning)
        lowered = self._lower(self.parameters.real_vector(vector))
        n = lowered.structure.n
        return chart(lowered, np.concatenate([lowered.x[:n], lowered.v[:n]]), whole, like, turning)

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

    def findings(self, vector: np.ndarray) -> tuple[Finding, ...]:
        """Findings on the mechanism at a parameter vector (parameters,), and on its motion.

        The motion is simulated once if it has Coulomb friction, bushings in space with torques, or flexible bodies that
        may leave the range of their theory.
        """
        system, late = self.system(vector), late_samples(self.times)
        try:
            watched = any(body.has_motion_findings for body in system.bodies)
            if not (watched or rubbing(system) or turning_bushings(system)):
                step, end = self.solver.fixed_step, float(self.times[-1])
                skipped = skipped_samples(system, step, self.begin, end)
                return (*system.findings, *self._start_findings(system), *late, *skipped)
            return (*simulate(system, float(self.times[-1]), self.solver, begin=self.begin).findings, *late)
        except (ModelError, SolveError, InputError):  # no motion, or one that does not fit into memory
            return (*system.findings, *late)

    def _start_findings(self, system: BaseSystem) -> tuple[Finding, ...]:
        """Findings on components that act on joints, which need no motion."""
        if not joined(system):
            return ()
        lowered = assembled(system, begin=self.begin)
        return start_findings(system, lowered, lowered.x)

    def _sampled(self, times: ArrayLike, *, begin: float | None = None, solver: Integrator | None = None) -> Self:
        """The same model with other samples, start or solver, whose derivatives were compared if this model's were."""
        own = type(self)(
            self.builder, self.parameters, self.channel_names, times, solver or self.solver, self.workers,
            self.derivative, self.begin if begin is None else begin,
        )  # fmt: skip
        vars(own)["_compared"], vars(own)["built_at"] = self._compared, self.built_at
        return own
