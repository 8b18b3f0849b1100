"""A forward model made of a function of the user's, a wrapper around another solver included."""

import hashlib
import inspect
from collections.abc import Callable, Iterable, Mapping
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from dalembert.argument_readers import check_integer, samples_of
from dalembert.errors import DalembertError, InputError, SolveError, require_known, shown, told, users_place
from dalembert.forward.builders import named
from dalembert.forward.complex_steps import STEP, Compared, check_steps
from dalembert.forward.differences import COMPLEX_STEP, DERIVATIVES, RELATIVE_STEP
from dalembert.forward.model import Channel, Coordinate, ForwardModel
from dalembert.forward.responses import Responses
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters


@dataclass(frozen=True)
class PythonModel:
    """A forward model from ``function(**parameters) -> (samples, channels)``.

    Parameters
    ----------
    function : callable
        Called with the parameters by name; returns an array of shape (samples, channels), or (samples,)
        for one channel.
    parameters : mapping of str to (lower, upper), or Parameters
    channels : sequence of str or Channel
    samples : array, shape (samples,)
        What the samples lie along, by default times in seconds.
    coordinate, unit : str
        Name and unit of ``samples``.
    derivative : {"complex-step", "central-differences"}
        The complex step is exact, and needs a function that runs in complex numbers.

    Examples
    --------
    >>> import numpy as np
    >>> times = np.linspace(0, 1, 3)
    >>> decay = PythonModel(lambda rate: np.exp(-rate * times), {"rate": (0.1, 2.0)}, ["x"], times)
    >>> decay.evaluate(np.array([[1.0]])).values.shape
    (1, 3, 1)
    >>> decay.jacobian(np.array([1.0]))[:, 0, 0].round(4).tolist()
    [-0.0, -0.3033, -0.3679]
    """

    function: Callable[..., np.ndarray]
    parameters: Parameters
    channels: tuple[Channel, ...]
    coordinate: Coordinate
    derivative: str = COMPLEX_STEP
    kept: int | None = field(default=None, repr=False)

    def __init__(
        self,
        function: Callable[..., np.ndarray],
        parameters: Parameters | Mapping[str, Parameter | tuple[float, float]],
        channels: Iterable[str | Channel],
        samples: np.ndarray,
        *,
        coordinate: str = "time",
        unit: str = "s",
        derivative: str = COMPLEX_STEP,
        kept: int | None = None,
    ) -> None:
        require_known("derivative", derivative, DERIVATIVES)
        if not callable(function):
            raise InputError(f"PythonModel: function is {shown(function)}; expected a function")
        parameters = Parameters.of(parameters)
        channels = [channels] if isinstance(channels, str) else channels
        if not isinstance(channels, Iterable):
            raise InputError(f"PythonModel: channels is {shown(channels)}; expected names, such as ['x', 'y']")
        if kept is not None:
            check_integer("PythonModel", "kept", kept, 0)
        samples = samples_of(samples, "PythonModel", "samples")
        outputs = tuple(Channel(entry) if isinstance(entry, str) else entry for entry in channels)
        along = Coordinate(coordinate, unit, samples[:kept])
        checked = function, parameters, outputs, along, derivative, kept
        vars(self).update(zip(self.__dataclass_fields__, checked, strict=True))

    @property
    def fingerprint(self) -> str:
        """Hash of the function's source, the parameters' names, the channels and the samples."""
        try:
            source = inspect.getsource(self.function)
        except (OSError, TypeError):
            source = repr(self.function)
        text = "\n".join([source, *map(str, self.parameters.identity), *(channel.name for channel in self.channels)])
        return hashlib.sha256(text.encode() + self.coordinate.values.tobytes()).hexdigest()

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch, one call of the function after another."""
        vectors = self.parameters.batch(vectors)
        values = np.full((len(vectors), *self._shape), np.nan)
        failures: list[str | None] = []
        for row, vector in enumerate(vectors):
            try:
                values[row] = self._call(vector)
                failures.append(None)
            except Exception as error:  # whatever the user's function raises is this sample's failure
                failures.append(told(error))
        return Responses(values, tuple(failures))

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Derivative of the response, shape (samples, channels, parameters)."""
        return self._jacobian(self.parameters.real_vector(vector))

    def _jacobian(self, vector: np.ndarray) -> np.ndarray:
        derivative = self._complex_step if self.derivative == COMPLEX_STEP else self._central_difference
        jacobian = np.empty((*self._shape, len(vector)))
        for column in range(len(vector)):
            jacobian[:, :, column] = derivative(vector, column)
        if not self._compared.vectors:
            self.check_derivatives(vector)
        return jacobian

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex step with differences at a vector (parameters,), by some calls a parameter.

        Raises
        ------
        InputError
            Where the function drops the imaginary part of a parameter.
        """
        if self.derivative == COMPLEX_STEP:
            arguments = self.parameters, vector, self._numbers, self._place
            self._compared.once(vector, lambda thorough: check_steps(*arguments, thorough=thorough))

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Response (samples, channels) and its jacobian (samples, channels, parameters)."""
        vector = self.parameters.real_vector(vector)
        return self._call(vector), self._jacobian(vector)

    def first(self, samples: int) -> ForwardModel:
        """The same model, cut to its first ``samples`` samples."""
        check_integer("PythonModel", "kept", samples, 0)
        shorter, along = copy(self), replace(self.coordinate, values=self.coordinate.values[:samples])
        vars(shorter).update(coordinate=along, kept=samples, _compared=self._compared)
        return shorter

    @property
    def _shape(self) -> tuple[int, int]:
        return len(self.coordinate.values), len(self.channels)

    def _call(self, vector: np.ndarray) -> np.ndarray:
        try:
            returned = self.function(**dict(zip(self.parameters.names, vector, strict=True)), **self._fixed)
        except DalembertError:
            raise
        except (Exception, SystemExit) as error:
            raise SolveError(told(error) if users_place(error) else f"{self._named} raised {told(error)}") from error
        try:
            response = np.asarray(returned)
        except ValueError as error:
            raise InputError(f"{self._named} returned no array: {error}") from error
        if response.dtype.kind not in "buifc":
            raise InputError(f"{self._named} returned a {type(returned).__name__}; expected an array of numbers")
        if response.ndim == 1:
            response = response[:, None]
        if response.ndim == 2:
            response = response[: self.kept]
        if response.shape != self._shape:
            raise InputError(
                f"{self._named} returned an array of shape {response.shape}; "
                f"expected (samples, channels) = {self._shape}"
            )
        if not np.all(np.isfinite(response)):
            raise SolveError(f"{self._named} returned a value that is not finite")
        if np.iscomplexobj(response) and not np.iscomplexobj(vector):
            if np.any(np.imag(response)):
                raise InputError(
                    f"{self._named} returned complex numbers for real parameters. Their imaginary "
                    "parts would be taken for derivatives: compute in real numbers, with atan2 of dalembert for angles"
                )
            return np.real(response)
        return response

    @property
    def _named(self) -> str:
        """The function with its place, in a sentence."""
        return named(self.function)

    @cached_property
    def _fixed(self) -> dict[str, float]:
        """Arguments of the function that do not vary."""
        return {item.name: item.lower for item in self.parameters.fixed}

    @cached_property
    def _compared(self) -> Compared:
        return Compared()

    def _numbers(self, vector: np.ndarray) -> np.ndarray:
        """The response as a vector; NaN where the function fails."""
        try:
            return self._call(vector).ravel()
        except InputError:
            raise
        except Exception:  # the derivative itself will report it
            return np.full(int(np.prod(self._shape)), np.nan)

    def _place(self, entry: int) -> str:
        sample, channel = divmod(entry, len(self.channels))
        return f"channel {self.channels[channel].name!r} (sample {sample + 1}) of {self._named}"

    def _complex_step(self, vector: np.ndarray, column: int) -> np.ndarray:
        moved = vector.astype(complex)
        moved[column] += 1j * STEP
        try:
            response = self._call(moved)
        except SolveError as error:
            if not isinstance(error.__cause__, TypeError):
                raise
            raise InputError(
                f"{self._named} cannot run in complex numbers "
                f"({error.__cause__}); give derivative='central-differences', or make it complex-safe"
            ) from error
        if not np.iscomplexobj(response):
            raise InputError(
                f"{self._named} drops the imaginary part of its parameters, so its complex-step derivative would be "
                "zero; give derivative='central-differences', or make it complex-safe"
            )
        return np.imag(response) / STEP

    def _central_difference(self, vector: np.ndarray, column: int) -> np.ndarray:
        moved, step = np.zeros_like(vector), self.parameters.scale[column] * RELATIVE_STEP
        moved[column] = step
        return (self._call(vector + moved) - self._call(vector - moved)) / (2 * step)
