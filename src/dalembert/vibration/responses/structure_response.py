"""What forward models of vibrating systems have in common: a builder, ensembles, and derivatives by complex steps."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from copy import copy
from functools import cached_property
from typing import Any, Self

import numpy as np

from dalembert.errors import ModelError, told
from dalembert.forward import Channel, Coordinate, Refinement, Responses, ensemble, error_factor
from dalembert.forward.builders import built, inexact, restructured
from dalembert.forward.complex_steps import Compared
from dalembert.forward.differences import COMPLEX_STEP, central_differences
from dalembert.parameters import Parameters
from dalembert.threads import single_thread
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.sensitivity import STEP
from dalembert.vibration.interface.complex_steps import check_laws, check_numbers
from dalembert.vibration.interface.lowering import Lowered, lower
from dalembert.vibration.system.system import VibrationSystem


class StructureResponse(ABC):
    """A forward model whose builder returns a :class:`VibrationSystem`: subclasses compute one response."""

    builder: Callable[..., VibrationSystem]
    parameters: Parameters
    workers: int
    derivative: str

    @property
    @abstractmethod
    def channels(self) -> tuple[Channel, ...]:
        """Channels with their units."""

    @property
    @abstractmethod
    def coordinate(self) -> Coordinate:
        """What the samples lie along."""

    @property
    def fingerprint(self) -> str:
        """Hash of the system at the parameters' first guesses, the channels and the method."""
        return self._fingerprint

    @cached_property
    @abstractmethod
    def _fingerprint(self) -> str: ...

    @property
    @abstractmethod
    def shape(self) -> tuple[int, int]:
        """Numbers of samples and channels."""

    @property
    @abstractmethod
    def balance(self) -> HarmonicBalance:
        """The method with the number of harmonics and the solver, which are chosen when they are first needed."""

    @abstractmethod
    def first(self, samples: int) -> Self:
        """The same model, cut to its first samples."""

    @abstractmethod
    def _values(self, vector: np.ndarray) -> np.ndarray:
        """The response at a parameter vector, (samples, channels)."""

    @abstractmethod
    def _linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The response and its exact derivative, (samples, channels) and (samples, channels, parameters)."""

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch over all cores; ``vectors`` (batch, parameters), values (batch, samples, channels).

        A sample one of whose points is not found is marked with the reason, and its values are NaN.
        """
        vectors = self.parameters.batch(vectors)
        values = np.full((len(vectors), *self.shape), np.nan)
        failures: list[str | None] = [None] * len(vectors)

        def work(row: int) -> None:
            try:
                values[row] = self._values(vectors[row])
            except Exception as error:  # the user's builder raised: this sample's failure, not the batch's
                failures[row] = told(error)

        with single_thread():
            list(ensemble(work, range(len(vectors)), workers=self.workers))
        return Responses(values, tuple(failures))

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Exact derivative of the response, (samples, channels, parameters)."""
        return self.linearise(vector)[1]

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (samples, channels) and its exact derivative (samples, channels, parameters).

        A complex step through the builder and the laws of force gives the derivative of the equations of harmonic
        balance by a parameter. Their Jacobian then gives that of the response (implicit function theorem).

        Raises
        ------
        InputError
            Where the builder, or a law of the user's, cannot run in complex numbers, or loses the imaginary part.
        SolveError
            Where a point is not found.
        """
        vector = self.parameters.real_vector(vector)
        if self.derivative != COMPLEX_STEP:
            return central_differences(self, vector)
        return self._linearise(vector)

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex step with differences of the properties of all components at a vector (parameters,).

        Nothing is solved, and laws of the user's are not compared here: the next :meth:`jacobian` or :meth:`linearise`
        does, at the first point that it solves.

        Raises
        ------
        InputError
            With the parameter, the component and its property, where the builder drops the imaginary part.
        """
        if self.derivative == COMPLEX_STEP:
            self._compared.once(vector, lambda thorough: check_numbers(self.builder, self.parameters, vector, thorough))

    def part(self, share: float) -> tuple[Self, float]:
        """The same model at about a share of its samples, the first ones, and that share."""
        samples = int(np.ceil(share * self.shape[0])) or 1
        return self.first(samples), samples / self.shape[0]

    def refined(self) -> Refinement | None:
        """Return the same model with twice the harmonics and one more; None beyond the limits of the method."""
        method = self.balance.refined()
        if method is None:
            return None
        finer = self._but(method=method, balance=method)
        return Refinement(finer, error_factor(None), f"with {method.harmonics} harmonics")

    def __getstate__(self) -> dict[str, Any]:
        """Return the state with the number of harmonics, so that every process computes with the same one."""
        state = {**vars(self), "balance": self.balance}
        state.pop("_known", None)  # made anew, as it is large
        return state

    def _but(self, **changes: Any) -> Self:
        """The same model with other samples or another method, whose derivatives need no second comparison."""
        model = copy(self)
        vars(model).update({"balance": self.balance} | changes, _compared=self._compared)
        vars(model).pop("_fingerprint", None)
        return model

    def system(self, vector: np.ndarray) -> VibrationSystem:
        """The system at a parameter vector (parameters,)."""
        return built(self.builder, self.parameters.mapping(vector), VibrationSystem)

    @cached_property
    def _compared(self) -> Compared:
        return Compared()

    def _check(self, vector: np.ndarray, motions: Callable[[], Mapping[str, np.ndarray]]) -> None:
        """Compare the complex step with differences, where that was not done. ``motions``: samples of the displacements
        that each function of the user's sees, by its name.
        """
        if not self._compared.vectors:
            self.check_derivatives(vector)
        if not self._compared.functions:
            check_laws(self.builder, self.parameters, vector, motions())
            self._compared.functions = True

    def _perturbed(self, vector: np.ndarray, column: int, real: Lowered) -> Lowered:
        """The system along one parameter, moved by a complex step of its scale."""
        name = self.parameters.names[column]
        arguments: dict[str, complex] = dict(self.parameters.mapping(vector))
        arguments[name] = complex(vector[column], STEP * self.parameters.scale[column])
        try:
            perturbed = lower(built(self.builder, arguments, VibrationSystem))
        except (TypeError, ModelError, np.exceptions.ComplexWarning) as error:
            error = error.__cause__ if isinstance(error, ModelError) else error
            if not isinstance(error, TypeError | np.exceptions.ComplexWarning):
                raise
            raise inexact(name, error) from error
        if perturbed.row_names != real.row_names or perturbed.structure.dofs.names != real.structure.dofs.names:
            raise restructured()
        return perturbed
