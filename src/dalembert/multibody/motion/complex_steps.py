"""Whether a mechanism carries the complex step of its parameters, and functions of the user's that of the state.

Derivatives by parameters are exact where each number of the model, and each force, carries the imaginary part of what
it depends on. Numbers are compared with central differences of the same numbers, which needs no simulation. What
functions of the user's and components of other packages return is compared at states of a motion, along the state and
along the parameters that the functions close over.
"""

from collections.abc import Callable, Iterator, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dalembert.errors import InputError
from dalembert.forward.complex_steps import DROPPING, REMEDY, Lost, attempted, check_steps, check_together, lost_step
from dalembert.multibody.components.signals import Custom
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.callbacks import in_complex_numbers
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.evaluate import residual
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.observe import Observer
from dalembert.multibody.model.system import BaseSystem
from dalembert.parameters import Parameters

_STATES = 5  # of a motion at which functions are compared


@dataclass(frozen=True)
class Along:
    """A motion with its channels.

    ``times`` (samples,); ``states`` (samples, N + 1); ``begin``: time of the signals at which the motion starts, s.
    """

    observer: Observer
    times: np.ndarray
    states: MotionState
    begin: float = 0.0

    @cached_property
    def samples(self) -> np.ndarray:
        """Numbers of a few samples, at which functions are compared."""
        return np.unique(np.linspace(0, len(self.times) - 1, _STATES).astype(int))

    @cached_property
    def readers(self) -> Observer | None:
        """Channels of components of other packages."""
        columns = [column for column, row in enumerate(self.observer.rows) if row.kind and _foreign(row.kind)]
        channels = tuple(self.observer.channels[column] for column in columns)
        return Observer(channels, tuple(self.observer.rows[column] for column in columns)) if columns else None


def check_numbers(
    builder: Callable[..., BaseSystem], parameters: Parameters, vector: np.ndarray, thorough: bool = True
) -> None:
    """Raise where a number of the model, or a function of time, loses the complex step of a parameter."""

    def lowered(vector: np.ndarray) -> Lowered:
        return lower(_built(builder, parameters, vector))

    def place(entry: int) -> str:
        return _place(lowered(vector), entry)

    with in_complex_numbers(strict=True):
        check_steps(parameters, vector, lambda at: _numbers(lowered(at)), place, thorough=thorough)


def check_numbers_together(builder: Callable[..., BaseSystem], parameters: Parameters, vector: np.ndarray) -> None:
    """Compare as :func:`check_numbers`, along one direction of all parameters at once; they are few builds."""
    with in_complex_numbers(strict=True):
        check_together(
            parameters, vector, lambda at: _numbers(lower(_built(builder, parameters, at))),
            lambda: check_numbers(builder, parameters, vector),
        )  # fmt: skip


def _built(builder: Callable[..., BaseSystem], parameters: Parameters, vector: np.ndarray) -> BaseSystem:
    """The system with functions of the user's as Python runs them, since compiling one takes a second."""
    given = [value if value.imag else value.real for value in vector.tolist()]
    system = copy(builder(**parameters.arguments(given)))
    system.loads = [
        replace(load, function=_plain(load.function)) if hasattr(load, "function") else load for load in system.loads
    ]
    return system


def _plain(function: Callable) -> Callable:
    return getattr(function, "py_func", function)


def _numbers(lowered: Lowered) -> np.ndarray:
    return np.concatenate([lowered.x, lowered.v, lowered.signal_data, *map(np.ravel, lowered.data.values())])


def _place(lowered: Lowered, entry: int) -> str:
    """The component and the name of a number."""
    owners = (*lowered.structure.owners, "")  # nobody owns the last of the unknowns, which is zero
    names = [f"{what} at the start of {owner!r}" for what in ("a coordinate", "a velocity") for owner in owners]
    names += ["a function of time"] * len(lowered.signal_data)
    for kind in lowered.data:
        names += [f"{number!r} of {part!r}" for part in lowered.parts[kind] for number in kind.numbers]
    return names[entry]


def check_closures(
    builder: Callable[..., BaseSystem], parameters: Parameters, vector: np.ndarray, along: Along
) -> None:
    """Raise where a function of the user's, or a kind of another package, loses the complex step of a parameter."""

    def answers(vector: np.ndarray) -> list[tuple[str, np.ndarray]]:
        """What functions return along the motion, each with its name."""
        system = _built(builder, parameters, vector)
        return [*_of_signals(system, along), *_of_components(lower(system, along.begin), along)]

    def place(entry: int) -> str:
        return names[entry]

    names = [name for name, values in answers(vector) for _ in values]
    if names:
        with in_complex_numbers(strict=True):
            check_steps(parameters, vector, lambda at: np.concatenate([own for _, own in answers(at)]), place)


def _of_signals(system: BaseSystem, along: Along) -> Iterator[tuple[str, np.ndarray]]:
    """Values and rates of functions of time."""
    for component in (*system.bodies, *system.joints, *system.loads):
        for name, signal in vars(component).items():
            if isinstance(signal, Custom):
                for function in filter(None, (signal.function, signal.rate, signal.second)):
                    values = [_plain(function)(float(t)) for t in along.begin + along.times[along.samples]]
                    yield f"the function of time {name!r} of {component.name!r}", np.array(values)


def _of_components(lowered: Lowered, along: Along) -> Iterator[tuple[str, np.ndarray]]:
    """Forces and channels of functions of the user's and of kinds of other packages, the state held."""
    model = lowered.complex_model
    states = [part[along.samples].astype(complex) for part in along.states[:3]]
    for kind in filter(_foreign, lowered.data):
        for t, x, v, a in zip(along.times[along.samples], *states, strict=True):
            owners = ", ".join(map(repr, dict.fromkeys(lowered.parts[kind])))
            yield f"a force of {owners} at t = {t:.6g} s", residual(lowered, model, x, v, a, float(t), kind)
    if along.readers:
        values = along.readers.read(lowered, model, states, along.times[along.samples])
        for channel, column in zip(along.readers.channels, values.T, strict=True):
            yield f"the channel {channel.name!r}", column


def check_forces(lowered: Lowered, along: Along, scale: np.ndarray, remedy: str = REMEDY) -> None:
    """Raise InputError, which names the component, where a function of the user's, or a kind of another package, loses
    the complex step of the state. ``scale`` (N + 1,): typical sizes of the coordinates; ``remedy``: what to do about a
    force, at the end of the message.
    """
    kinds = [kind for kind in lowered.data if _foreign(kind)]
    if kinds or along.readers:
        with in_complex_numbers(strict=True):
            for direction in _directions(lowered, along.states, scale):
                for sample in along.samples:
                    state = [part[sample] for part in along.states[:3]]
                    for kind in kinds:
                        _check_force(lowered, kind, direction, float(along.times[sample]), state, remedy)
                    if along.readers:
                        _check_channels(lowered, along.readers, direction, state, float(along.times[sample]))


def _foreign(kind: Kind) -> bool:
    return "function" in kind.integers or (kind.source.__module__ or "").partition(".")[0] != __name__.partition(".")[0]


def _directions(lowered: Lowered, states: MotionState, scale: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Changes of coordinates and of velocities, each of the size that the motion has."""
    signs = np.where(np.random.default_rng(0).random(len(scale)) < 0.5, -1.0, 1.0)
    signs[lowered.structure.n :] = 0.0  # multipliers
    speed = np.maximum(np.max(np.abs(states.v), axis=0), 1e-3 * np.max(np.abs(states.v), initial=1e-3))
    still = np.zeros_like(scale)
    return [(signs * scale, still), (still, signs * speed)]


def _lost(
    lowered: Lowered, direction: Sequence[np.ndarray], state: list, numbers: Callable[..., np.ndarray]
) -> Lost | None:
    """Which of the numbers of a model and a state (x, v, a) loses the complex step along a direction."""
    (x, v, a), (dx, dv) = state, direction

    def moved(shift: complex) -> np.ndarray:
        model, dtype = (lowered.unperturbed, complex) if isinstance(shift, complex) else (lowered.real, float)
        return numbers(model, *(part.astype(dtype) for part in (x + shift * dx, v + shift * dv, a)))

    return attempted(lambda: lost_step(moved, 1.0))


def _check_force(
    lowered: Lowered, kind: Kind, direction: Sequence[np.ndarray], t: float, state: list, remedy: str
) -> None:
    lost = _lost(lowered, direction, state, lambda model, x, v, a: residual(lowered, model, x, v, a, t, kind))
    if lost:
        owners, rows = lowered.parts[kind], lowered.structure.index[kind]
        names = sorted({name for name, own in zip(owners, rows, strict=True) if lost.entry in own})
        raise InputError(
            f"a force of {', '.join(map(repr, names))} depends on the state, but its derivative is {lost.by_step:.6g} "
            f"by the complex step and {lost.by_differences:.6g} by differences, at t = {t:.6g} s. Its function drops "
            f"the imaginary part, as {DROPPING} do. {remedy}"
        )


def _check_channels(
    lowered: Lowered, observer: Observer, direction: Sequence[np.ndarray], state: list, t: float
) -> None:
    def read(model: BlockModel, *moved: np.ndarray) -> np.ndarray:
        return observer.read(lowered, model, [part[None] for part in moved], np.array([t]))[0]

    lost = _lost(lowered, direction, state, read)
    if lost:
        raise InputError(
            f"the channel {observer.channels[lost.entry].name!r} depends on the state, but its derivative is "
            f"{lost.by_step:.6g} by the complex step and {lost.by_differences:.6g} by differences. Its function drops "
            f"the imaginary part, as {DROPPING} do. {REMEDY}"
        )
