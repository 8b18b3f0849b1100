"""What models of motions share: batches of motions, responses with exact derivatives, and arrays of parameters."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from dalembert.errors import ModelError, told
from dalembert.forward import Channel, Coordinate, ForwardModel, Responses, ensemble
from dalembert.forward.adjoint import Pull
from dalembert.forward.builders import built, inexact, restructured
from dalembert.forward.complex_steps import Compared
from dalembert.forward.differences import COMPLEX_STEP, central_differences
from dalembert.kernels.duals import Dual
from dalembert.kernels.lanes import WIDTH
from dalembert.kernels.preparation import prepare
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.integrators.shared.run import Run, make_problem
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.callbacks import in_complex_numbers
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.model.directions import are_many, dual_kernels
from dalembert.multibody.model.lane_models import FEWEST, takes_lanes
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.observe import Observer, observer
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.motion.complex_steps import (
    Along,
    check_closures,
    check_forces,
    check_numbers,
    check_numbers_together,
)
from dalembert.multibody.motion.long_runs import check_pace
from dalembert.multibody.motion.simulation import prepared
from dalembert.multibody.start.assemble import assembled, moves_start, start_key
from dalembert.parameters import Parameters


class MotionModel(ABC):
    """A forward model each of whose responses is read off one motion."""

    parameters: Parameters
    channels: tuple[Channel, ...]
    times: np.ndarray
    begin: float
    fingerprint: str

    @abstractmethod
    def first(self, samples: int) -> ForwardModel:
        """The same model, cut to its first ``samples`` samples."""

    @property
    @abstractmethod
    def _built(self) -> "BuiltModel":
        """The model whose builder, solver and channels serve."""

    def __getstate__(self) -> dict[str, Any]:
        """Without what was computed from the fields, which holds addresses of this process."""
        return {name: value for name, value in vars(self).items() if name in self.__dataclass_fields__}  # type: ignore[attr-defined]

    @property
    def coordinate(self) -> Coordinate:
        """The times of the samples."""
        return Coordinate("time", "s", self.times)

    @cached_property
    def problem(self) -> IntegrationProblem:
        return make_problem(self._built.shared, self.times)

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch over all cores; ``vectors`` (batch, parameters), values (batch, samples, channels).

        A sample that fails is marked with its reason, and its values are NaN.
        """
        vectors = self.parameters.batch(vectors)
        values = np.full((len(vectors), len(self.times), len(self.channels)), np.nan)
        failures: list[str | None] = [None] * len(vectors)
        solver, workers, problem = self._built.solver, self._built.workers, self.problem

        def work(rows: np.ndarray) -> None:
            samples: dict[int, Lowered] = {}
            for row in rows:
                try:
                    samples[row] = self._lower(vectors[row])
                except Exception as error:  # the user's builder raised: this sample's failure, not the batch's
                    failures[row] = told(error)
            if samples:
                end, counted = self.times[-1], self._built.observer.counted
                runs = solver.integrate([*samples.values()], (), problem, end, logged=False, counted=counted)
                for (row, lowered), run in zip(samples.items(), runs, strict=True):
                    if run.reason:
                        failures[row] = str(run.reason)
                    else:
                        values[row] = self._read(lowered, lowered.real, run.states, run.turns)

        with in_complex_numbers(strict=False):
            most = self._built.lanes_of(len(vectors) // workers)
            list(ensemble(work, _parts(len(vectors), workers, most), workers=workers))
        return Responses(values, tuple(failures))

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Exact derivative of the discrete response, (samples, channels, parameters)."""
        return self.linearise(vector)[1]

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (samples, channels) and its exact derivative (samples, channels, parameters), in one run."""
        vector = self.parameters.real_vector(vector)
        if self._built.derivative != COMPLEX_STEP:
            return central_differences(self, vector)
        solver = self._built.derivative_solver
        with in_complex_numbers(strict=True):
            lowered, perturbed = self._perturbed(vector)
            active = [column for column, own in enumerate(perturbed) if _moves(own)]
            directions = [perturbed[column] for column in active]
            end, counted = self.times[-1], self._built.observer.counted
            (run,) = solver.integrate([lowered], directions, self.problem, end, counted=counted)
        if run.reason:
            raise run.reason
        for name, own in zip(self.parameters.names, perturbed, strict=True):
            for error in (*lowered.failures.inexact, *own.failures.inexact):
                raise inexact(name, error) from error
        self._compare(vector, lowered, run)
        values = self._read(lowered, lowered.real, run.states, run.turns)
        jacobian = np.empty((*values.shape, len(vector)))
        for column, own in enumerate(perturbed):
            states = [part.astype(complex) for part in run.states[:3]]
            if column in active:
                slopes = (part[active.index(column)] for part in run.derivatives[:3])
                states = [state + 1j * STEP * slope for state, slope in zip(states, slopes, strict=True)]
            response = self._read(own, own.complex_model, states)
            jacobian[:, :, column] = np.imag(response) / (STEP * self.parameters.scale[column])
        return values, jacobian

    def _lower(self, vector: np.ndarray) -> Lowered:
        """Arrays of one sample, in the structure of the first."""
        return self._built.lowered_at(vector, self.begin, closed=True)

    def _perturbed(self, vector: np.ndarray) -> tuple[Lowered, list[Lowered]]:
        """The arrays, and those moved by a complex step of the scale of each parameter."""
        lowered, columns = self._lower(vector), range(len(vector))
        return lowered, [self._built.perturbed_at(vector, column, self.begin, closed=True) for column in columns]

    def _read(self, lowered: Lowered, model: BlockModel, states: Any, turns: np.ndarray | None = None) -> np.ndarray:
        """Channels of states x, v and a (samples, N + 1), (samples, channels), with turns (samples, angles)."""
        observer = self._built.observer
        counted = {} if turns is None else dict(zip(observer.counted, turns.T, strict=True))
        return observer.read(lowered, model, states, self.times, counted)

    def _compare(self, vector: np.ndarray, lowered: Lowered, run: Run) -> None:
        """Compare the complex step with differences along a motion, where that is due: here it is not."""
        return


@dataclass(frozen=True)
class BuiltModel(MotionModel):
    """A model of motions whose mechanism a function builds from parameters."""

    builder: Callable[..., BaseSystem]
    parameters: Parameters
    channel_names: tuple[str, ...]
    times: np.ndarray
    solver: Integrator
    workers: int = field(default=1, compare=False)
    derivative: str = COMPLEX_STEP
    built_at: np.ndarray | None = field(default=None, compare=False)
    begin: float = 0.0

    @property
    def _built(self) -> "BuiltModel":
        return self

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Channels with their units."""
        return self.observer.channels

    def system(self, vector: np.ndarray) -> BaseSystem:
        """The mechanism at a parameter vector (parameters,)."""
        return built(self.builder, self.parameters.mapping(vector), BaseSystem)

    @cached_property
    def first_system(self) -> BaseSystem:
        """The mechanism that all samples share their structure with."""
        return self.system(self.parameters.start if self.built_at is None else self.built_at)

    @cached_property
    def observer(self) -> Observer:
        """The channels, of the mechanism as it is placed: joints may not be closed yet."""
        return observer(self.first_system, lower(self.first_system, self.begin), self.channel_names)

    @cached_property
    def shared(self) -> Lowered:
        """Arrays where the mechanism is built first: all samples share their structure."""
        end = float(self.times[-1])
        lowered, solver = prepared(self.first_system, end, self.solver, self.begin, self.observer)
        check_pace(lowered, solver, end)
        return lowered

    @cached_property
    def derivative_solver(self) -> Integrator:
        """The solver, with what sensitivities need compiled, or loaded, once."""
        solver = self.solver.suiting(self.shared, float(self.times[-1]))
        together = solver.takes_duals and are_many(self.shared, len(self.parameters))
        kernels = dual_kernels(self.shared) if together else self.shared.kernels(complex)
        method = solver.kernels(self.shared.structure, Dual if together else complex)
        prepare([*method, *kernels, *self.observer.kernels(self.shared, True)])
        return self.solver

    def lanes_of(self, samples: int) -> int:
        """How many of a worker's samples run side by side, with what that needs compiled once; 0: one by one."""
        if samples < FEWEST or not self.solver.takes_lanes or not takes_lanes(self.shared):
            return 0
        return self._lanes

    @cached_property
    def _lanes(self) -> int:
        prepare(self.solver.lane_kernels(self.shared))
        return WIDTH

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex step with differences of the model's numbers at a vector (parameters,). Nothing is
        simulated. The forces of functions of the user's are compared by the next derivative, along its motion.
        """
        if self.derivative == COMPLEX_STEP:
            self._compared.once(vector, lambda thorough: check_numbers(self.builder, self.parameters, vector, thorough))

    def check_together(self, vector: np.ndarray) -> None:
        """Compare as :meth:`check_derivatives` where nothing was compared, along one direction of all parameters."""
        if not (self._compared.vectors or self._compared.together):
            check_numbers_together(self.builder, self.parameters, vector)
            self._compared.together = True

    @cached_property
    def _compared(self) -> Compared:
        return Compared()

    def _compare(self, vector: np.ndarray, lowered: Lowered, run: Run) -> None:
        if not self._compared.vectors:
            self.check_derivatives(vector)
        if not self._compared.functions:
            at = Along(self.observer, self.times, run.states, self.begin)
            check_forces(lowered, at, self.problem.scale)
            check_closures(self.builder, self.parameters, vector, at)
            self._compared.functions = True

    @property
    def adjoint_from(self) -> int | None:
        """Number of parameters from which the adjoint is cheaper than the Jacobian; None without an adjoint."""
        from dalembert.multibody.adjoint.model_pullback import adjoint_from  # which only users of an adjoint load

        return adjoint_from(self)

    def pullback(self, vector: np.ndarray) -> tuple[np.ndarray, Pull]:
        """Response (samples, channels), and the gradients of its weighted sums by the discrete adjoint.

        See :func:`dalembert.forward.pullback`, which chooses between this method and :meth:`linearise`.
        """
        from dalembert.multibody.adjoint.model_pullback import pulled  # which only users of an adjoint load

        return pulled(self, self.parameters.real_vector(vector))

    def placed(self, vector: np.ndarray, begin: float) -> tuple[Lowered, tuple[Lowered, ...]]:
        """Arrays of the mechanism as placed, and those moved along each parameter; kept for the last vector.

        Segments of one motion share them, unless signals depend on when they begin.
        """
        moment = begin if len(self.shared.structure.signals) > 1 else 0.0
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
        placed = self._shared(lower(system, begin))
        return self._fit(self._closed(system, placed, begin) if closed else placed)

    def _closed(self, system: BaseSystem, placed: Lowered, begin: float) -> Lowered:
        """The arrays with closed joints. Samples that differ in stiffnesses or masses start alike: that is kept."""
        key = start_key(system, placed)
        known, start = vars(self).get("_start", (b"", {}))
        if key and key == known:
            return placed.moved(**start)
        lowered = assembled(system, placed=placed, begin=begin)
        vars(self)["_start"] = key, {name: getattr(lowered, name) for name in ("frames", "x", "v")}
        return lowered

    def along(self, vector: np.ndarray, direction: np.ndarray, begin: float) -> Lowered:
        """The closed arrays of :meth:`lowered_at`, moved by a complex step along a direction of all parameters.

        Where the initial state does not move, its real part is that of the first placement.
        """
        slopes = dict(zip(self.parameters.names, direction.tolist(), strict=True))
        moved = {
            name: complex(value, STEP * slopes[name]) if slopes.get(name) else value
            for name, value in self.parameters.mapping(vector).items()
        }
        return self._moved(built(self.builder, moved, BaseSystem), begin)

    def _moved(self, system: BaseSystem, begin: float) -> Lowered:
        """The closed arrays of a perturbed system; as placed where no initial state moves with the perturbation."""
        placed = self._shared(lower(system, begin))
        moves = moves_start(system, placed)
        return self._fit(assembled(system, perturbed=True, placed=placed, begin=begin) if moves else placed)

    def perturbed_at(self, vector: np.ndarray, column: int, begin: float, *, closed: bool) -> Lowered:
        """The arrays of :meth:`lowered_at`, moved by a complex step of the scale of one parameter."""
        name, value = self.parameters.names[column], complex(vector[column], STEP * self.parameters.scale[column])
        try:
            system = built(self.builder, self.parameters.mapping(vector) | {name: value}, BaseSystem)
            return self._moved(system, begin) if closed else self._fit(lower(system, begin))
        except (TypeError, ModelError, np.exceptions.ComplexWarning) as error:
            cause = error.__cause__ if isinstance(error, ModelError) else error
            if not isinstance(cause, TypeError | np.exceptions.ComplexWarning):
                raise
            raise inexact(name, cause) from cause

    def _shared(self, lowered: Lowered) -> Lowered:
        """In the structure of the first sample, if it is the same: what follows from it is computed once."""
        structure = self.shared.structure
        return lowered.moved(structure=structure) if structure.same(lowered.structure) else lowered

    def _fit(self, lowered: Lowered) -> Lowered:
        if not self.shared.structure.same(lowered.structure):
            raise restructured()
        return lowered.moved(structure=self.shared.structure)


def _moves(perturbed: Lowered) -> bool:
    """Whether the motion may depend on what was moved: initial angles do not matter to a later segment."""
    arrays = (perturbed.x, perturbed.v, perturbed.signal_data, perturbed.knots, *perturbed.data.values())
    return bool(perturbed.callbacks) or any(np.iscomplexobj(one) and np.any(np.imag(one)) for one in arrays)


def _parts(count: int, workers: int, lanes: int) -> list[np.ndarray]:
    """Rows of a batch cut into parts: small enough that no worker waits long for another at the end.

    Samples that run side by side fill as many ``lanes`` as all workers have samples for.
    """
    size = max(1, min(lanes or 16, -(-count // (workers if lanes else 4 * workers))))
    return [np.arange(begin, min(begin + size, count)) for begin in range(0, count, size)]
