"""The response of a vibrating system over frequency as a forward model."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from dalembert.argument_readers import names_of, samples_of
from dalembert.errors import InputError, SolveError, require_known
from dalembert.findings import Finding
from dalembert.forward import Channel, Coordinate
from dalembert.forward.builders import check_function, cores
from dalembert.forward.differences import COMPLEX_STEP, DERIVATIVES
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.threads import single_thread
from dalembert.units import unit_of
from dalembert.vibration.balance.equations import Equations, chosen_solver, equations, require_one_period
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.balance.sensitivity import sensitivities
from dalembert.vibration.balance.truncation import ForcedLevel, choice_findings, hardest
from dalembert.vibration.interface.contacts_stuck import KnownStructures
from dalembert.vibration.interface.lowering import Lowered, lower
from dalembert.vibration.paths.amplitudes import Amplitude, highest_order
from dalembert.vibration.paths.continuation import at_frequencies
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import response_of, restarted
from dalembert.vibration.responses.frequency_response import frequency_response
from dalembert.vibration.responses.structure_response import StructureResponse
from dalembert.vibration.system.requirements import positive_numbers, require_forces
from dalembert.vibration.system.system import VibrationSystem


@dataclass(frozen=True)
class FrequencyResponse(StructureResponse):
    """Amplitudes of a vibrating system at given frequencies, as a function of parameters.

    Parameters
    ----------
    builder : callable
        ``builder(**parameters) -> VibrationSystem``; called with floats, and with complex numbers for derivatives.
    parameters : mapping of str to (lower, upper), or Parameters
    channels : sequence of str
        A degree of freedom and a kind of amplitude: ``"m2 peak"``, ``"m2 rms"`` or ``"m2 harmonic 1"`` and so on.
    frequencies : array, shape (samples,)
        Hz; the response is followed from each to the next, so the first should lie where there is only one.
    method : HarmonicBalance, optional
        With ``harmonics="auto"`` their number is chosen once, by the curve at the start values of the parameters, as
        :func:`frequency_response` chooses it. The same number then holds for all values of the parameters.
    workers : int, optional
        Threads of an ensemble; as many as there are cores if not given.
    derivative : {"complex-step", "central-differences"}
        The complex step is exact, and needs a builder that runs in complex numbers. When it is first used, and when an
        identification starts, it is compared with differences of the system's numbers, and of what functions of the
        user's return.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import FrequencyResponse, HarmonicForce, VibrationSystem
    >>> def oscillator(stiffness):
    ...     system = VibrationSystem(lumped({"m": 1.0}, [("m", None, stiffness, 0.04)]))
    ...     system.add(HarmonicForce("m", 1.0))
    ...     return system
    >>> model = FrequencyResponse(oscillator, {"stiffness": (0.5, 2.0)}, ["m harmonic 1"], np.array([0.1, 0.2]))
    >>> model.evaluate(np.array([[1.0]])).values.round(3).tolist()
    [[[1.651], [1.72]]]
    >>> model.jacobian(np.array([1.0])).round(3).tolist()
    [[[-2.723]], [[2.948]]]
    """

    builder: Callable[..., VibrationSystem]
    parameters: Parameters
    channel_names: tuple[str, ...]
    frequencies: np.ndarray
    method: HarmonicBalance
    workers: int = field(default=1, compare=False)
    derivative: str = COMPLEX_STEP

    def __init__(
        self,
        builder: Callable[..., VibrationSystem],
        parameters: Parameters | Mapping[str, Parameter | tuple[float, float]],
        channels: Sequence[str],
        frequencies: np.ndarray,
        method: HarmonicBalance | None = None,
        workers: int | None = None,
        derivative: str = COMPLEX_STEP,
    ) -> None:
        require_known("derivative", derivative, DERIVATIVES, "FrequencyResponse")
        frequencies = samples_of(frequencies, "FrequencyResponse", "frequencies")
        frequencies = positive_numbers(frequencies, "FrequencyResponse", "frequencies", "Hz")
        channels = names_of(channels, "FrequencyResponse", "channels")
        if not channels:
            raise InputError("FrequencyResponse: no channels were given; name at least one, such as 'm2 peak'")
        parameters = Parameters.of(parameters)
        method = (method or HarmonicBalance()).keeping(
            highest_order(*(channel.partition(" ")[2] for channel in channels))
        )
        check_function("FrequencyResponse", builder, [item.name for item in parameters.declared])
        vars(self).update(
            builder=builder, parameters=parameters, channel_names=channels, frequencies=frequencies,
            method=method, workers=workers or cores(), derivative=derivative,
        )  # fmt: skip

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Channels with their units."""
        return tuple(Channel(name, unit_of(name.partition(" ")[0])) for name in self.channel_names)

    @property
    def shape(self) -> tuple[int, int]:
        return len(self.frequencies), len(self.channel_names)

    @property
    def coordinate(self) -> Coordinate:
        """The frequencies of the samples."""
        return Coordinate("frequency", "Hz", self.frequencies)

    @cached_property
    def _fingerprint(self) -> str:
        differences = [self.derivative] * (self.derivative != COMPLEX_STEP)
        settings = self.parameters.identity, self.channel_names, *differences
        return lower(self.system(self.parameters.start)).fingerprint(self.method, *settings)

    def first(self, samples: int) -> "FrequencyResponse":
        """The same model, cut to its first ``samples`` frequencies."""
        return self._but(frequencies=self.frequencies[:samples])

    @cached_property
    def balance(self) -> HarmonicBalance:
        """The method with the number of harmonics and the solver, which are chosen when they are first needed."""
        system = self.system(self.parameters.start)
        method = replace(self.method, solver=chosen_solver(lower(system), self.method))
        if not method.automatic:
            return method
        curve = frequency_response(system, self.frequencies, method)
        return replace(method, harmonics=curve.orders[-1])

    def findings(self, vector: np.ndarray) -> tuple[Finding, ...]:
        """Return the finding on the truncation error at a parameter vector (parameters,), if harmonics were chosen."""
        if not self.method.automatic:
            return ()
        system = self.system(vector)
        problem = self._equations(system)
        curve = self.curve(vector)
        points = hardest(curve.unknowns, curve.converged)
        motions = [restarted(problem, curve, point, "FrequencyResponse") for point in points]
        level = ForcedLevel.of(problem, motions)
        errors = [level.truncation(motion) for motion in motions if motion.converged]
        return choice_findings(self.balance, max(errors, key=lambda estimate: estimate.rank, default=None))

    def _equations(self, system: VibrationSystem, derivatives: bool = False) -> Equations:
        require_one_period(self.balance, "FrequencyResponse")
        require_forces(system.forces, self.frequencies, "FrequencyResponse")
        highest = 2 * np.pi * float(np.max(self.frequencies))
        return equations(system, self.balance, derivatives=derivatives, highest=highest, known=self._known)

    def curve(self, vector: np.ndarray) -> FrequencyCurve:
        """The whole result at a parameter vector (parameters,)."""
        return frequency_response(self.system(vector), self.frequencies, self.balance, check=False)

    @single_thread()
    def _linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        problem = self._equations(self.system(vector), derivatives=True)
        places = self._places(problem.lowered)
        values = np.empty((len(self.frequencies), len(places)))
        jacobian = np.empty((*values.shape, len(vector)))
        perturbed = [self._perturbed(vector, column, problem.lowered) for column in range(len(vector))]
        for number, solution in enumerate(self._solutions(problem)):
            self._check(vector, partial(problem.seen_by_functions, solution))
            response = response_of(problem, solution)
            slopes = sensitivities(problem, solution, perturbed)
            for channel, (row, size) in enumerate(places):
                values[number, channel] = size.of(response[row])
                jacobian[number, channel] = slopes[:, row] @ size.slope(response[row])
        return values, jacobian / self.parameters.scale

    @cached_property
    def _known(self) -> KnownStructures:
        """The structure of the system before, which most parameters of contacts do not change."""
        return KnownStructures()

    def _solutions(self, problem: Equations) -> Iterator[Solution]:
        """The solution at each frequency; one after the other, since each holds matrices."""
        for point in at_frequencies(problem, 2 * np.pi * self.frequencies, None):
            if not point.solution.converged:
                raise SolveError(
                    f"at {point.solution.omega / (2 * np.pi):.6g} Hz the harmonics were not found: after "
                    f"{point.solution.iterations} iterations the relative residual is {point.solution.error:.1e}; give "
                    "more frequencies on the way there, or fewer harmonics"
                )
            yield point.solution

    def _places(self, lowered: Lowered) -> list[tuple[int, Amplitude]]:
        parts = [name.partition(" ") for name in self.channel_names]
        return [(lowered.structure.dofs.index(dof), Amplitude(kind, self.balance.orders)) for dof, _, kind in parts]

    def _values(self, vector: np.ndarray) -> np.ndarray:
        problem = self._equations(self.system(vector))
        places = self._places(problem.lowered)
        responses = (response_of(problem, solution) for solution in self._solutions(problem))
        return np.array([[size.of(response[row]) for row, size in places] for response in responses])
