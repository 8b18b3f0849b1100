"""Frequency and damping of a nonlinear mode over its amplitude as a forward model."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from dalembert.argument_readers import names_of, samples_of
from dalembert.errors import InputError, SolveError, require_known
from dalembert.forward import Channel, Coordinate
from dalembert.forward.builders import check_function, cores
from dalembert.forward.differences import COMPLEX_STEP, DERIVATIVES
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.threads import single_thread
from dalembert.units import unit_of
from dalembert.vibration.balance.equations import chosen_solver, require_one_period
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.modes.free_motion import FreeMotion
from dalembert.vibration.modes.mode_equations import ModeEquations
from dalembert.vibration.modes.nonlinear_modes import PosedBackbone, backbone, follow
from dalembert.vibration.responses.structure_response import StructureResponse
from dalembert.vibration.system.requirements import positive_numbers, require_still
from dalembert.vibration.system.system import VibrationSystem

CHANNELS = {"frequency": "Hz", "damping": ""}
"""Channels with their units."""


@dataclass(frozen=True)
class BackboneResponse(StructureResponse):
    """Frequency and damping ratio of a nonlinear mode at given amplitudes, as a function of parameters.

    Parameters
    ----------
    builder : callable
        ``builder(**parameters) -> VibrationSystem``; called with floats, and with complex numbers for derivatives.
    parameters : mapping of str to (lower, upper), or Parameters
    amplitudes : array, shape (samples,)
        Of the first harmonic of ``dof``, m; the mode is followed from each to the next.
    dof : str
        Degree of freedom by which the amplitude is measured.
    mode : int
        Number among the linear modes at rest, where contacts under load stick, from 1.
    channels : sequence of str
        ``"frequency"`` (Hz) and ``"damping"`` (ratio), or one of them.
    method : HarmonicBalance, optional
        With ``harmonics="auto"`` their number is chosen once, by the mode at the start values of the parameters.
    workers : int, optional
        Threads of an ensemble; as many as there are cores if not given.
    derivative : {"complex-step", "central-differences"}
        As those of :class:`FrequencyResponse`.

    Notes
    -----
    With the equations R(Y, ω, ξ; p) = 0 of the extended periodic motion, and those of amplitude and phase, the
    derivatives are those of an implicit function. :func:`ring_down` gives the data.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import BackboneResponse, CubicSpring, HarmonicBalance, VibrationSystem
    >>> def oscillator(cubic):
    ...     system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.02)]))
    ...     system.add(CubicSpring("spring", "m", stiffness=cubic))
    ...     return system
    >>> sizes, method = np.array([0.1, 1.0]), HarmonicBalance(5)
    >>> model = BackboneResponse(oscillator, {"cubic": (0.1, 1.0)}, sizes, "m", channels=["frequency"], method=method)
    >>> model.evaluate(np.array([[0.2]])).values.round(4).tolist()
    [[[0.1593], [0.1707]]]
    >>> model.jacobian(np.array([0.2])).round(4).tolist()
    [[[0.0006]], [[0.0562]]]
    """

    builder: Callable[..., VibrationSystem]
    parameters: Parameters
    amplitudes: np.ndarray
    dof: str
    mode: int
    channel_names: tuple[str, ...]
    method: HarmonicBalance
    workers: int = field(default=1, compare=False)
    derivative: str = COMPLEX_STEP

    def __init__(
        self,
        builder: Callable[..., VibrationSystem],
        parameters: Parameters | Mapping[str, Parameter | tuple[float, float]],
        amplitudes: np.ndarray,
        dof: str,
        *,
        mode: int = 1,
        channels: Sequence[str] = tuple(CHANNELS),
        method: HarmonicBalance | None = None,
        workers: int | None = None,
        derivative: str = COMPLEX_STEP,
    ) -> None:
        require_known("derivative", derivative, DERIVATIVES, "BackboneResponse")
        amplitudes = samples_of(amplitudes, "BackboneResponse", "amplitudes")
        amplitudes = positive_numbers(amplitudes, "BackboneResponse", "amplitudes", "m")
        channels = names_of(channels, "BackboneResponse", "channels")
        if not channels:
            raise InputError("BackboneResponse: no channels were given; name 'frequency', 'damping' or both")
        for channel in channels:
            require_known("channel", channel, CHANNELS, "BackboneResponse")
        parameters = Parameters.of(parameters)
        method = method or HarmonicBalance()
        require_one_period(method, "BackboneResponse")
        check_function("BackboneResponse", builder, [item.name for item in parameters.declared])
        vars(self).update(
            builder=builder, parameters=parameters, amplitudes=amplitudes, dof=dof, mode=mode,
            channel_names=channels, method=method, workers=workers or cores(), derivative=derivative,
        )  # fmt: skip

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Channels with their units."""
        return tuple(Channel(name, CHANNELS[name]) for name in self.channel_names)

    @property
    def shape(self) -> tuple[int, int]:
        return len(self.amplitudes), len(self.channel_names)

    @property
    def coordinate(self) -> Coordinate:
        """The amplitudes of the samples."""
        return Coordinate("amplitude", unit_of(self.dof), self.amplitudes)

    @cached_property
    def _fingerprint(self) -> str:
        differences = [self.derivative] * (self.derivative != COMPLEX_STEP)
        settings = self.parameters.identity, self.channel_names, self.dof, self.mode, *differences
        return lower(self.system(self.parameters.start)).fingerprint(self.method, "backbone", *settings)

    def first(self, samples: int) -> "BackboneResponse":
        """The same model, cut to its first ``samples`` amplitudes."""
        return self._but(amplitudes=self.amplitudes[:samples])

    @cached_property
    def balance(self) -> HarmonicBalance:
        """The method with the number of harmonics and the solver, which are chosen when they are first needed."""
        system = self.system(self.parameters.start)
        method = replace(self.method, solver=chosen_solver(lower(system), self.method, stability=True))
        if not method.automatic:
            return method
        curve = backbone(system, self.amplitudes, self.mode, method, dof=self.dof)
        return replace(method, harmonics=curve.orders[-1])

    def _followed(self, vector: np.ndarray) -> tuple[ModeEquations, list[FreeMotion]]:
        """The equations of the mode and its motions at all amplitudes."""
        system = self.system(vector)
        require_still(system, "BackboneResponse")
        equations, motions = follow(
            PosedBackbone(system, self.amplitudes, False, self.mode, self.dof, None), self.balance
        )
        for motion in motions:
            if not motion.converged:
                raise SolveError(
                    f"the mode was not found at an amplitude of {motion.size:.6g} {unit_of(self.dof)}: after "
                    f"{motion.iterations} iterations the relative residual is {motion.error:.1e}; give more amplitudes "
                    "on the way there, or fewer harmonics"
                )
        return equations, motions

    def _values(self, vector: np.ndarray) -> np.ndarray:
        _, motions = self._followed(vector)
        return np.array([self._of(motion.omega, motion.growth) for motion in motions])

    def _of(self, omega: float, growth: float) -> list[float]:
        """Values of the channels from ω and ξ = 2 ζ ω."""
        values = {"frequency": omega / (2 * np.pi), "damping": growth / (2 * omega)}
        return [values[name] for name in self.channel_names]

    @single_thread()
    def _linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        equations, motions = self._followed(vector)
        lowered = equations.problem.lowered
        moved = [self._perturbed(vector, column, lowered) for column in range(len(vector))]
        self._check(vector, lambda: equations.seen_by_functions(motions[-1]))
        values = np.array([self._of(motion.omega, motion.growth) for motion in motions])
        jacobian = np.empty((*values.shape, len(vector)))
        for number, motion in enumerate(motions):
            omega, growth = equations.slopes(motion, moved).T
            # d(ω/2π) and dζ = dξ/(2ω) - ζ dω/ω.
            changes = {
                "frequency": omega / (2 * np.pi),
                "damping": growth / (2 * motion.omega) - motion.growth * omega / (2 * motion.omega**2),
            }
            jacobian[number] = [changes[name] for name in self.channel_names]
        return values, jacobian / self.parameters.scale
