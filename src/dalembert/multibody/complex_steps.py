"""Whether a mechanism carries the complex step of its parameters, and functions of the user's that of the state.

Derivatives by parameters are exact where each number of the model, and each force, carries the imaginary part of what
it depends on. Numbers are compared with central differences of the same numbers, which needs no simulation. Forces of
functions of the user's and of components of other packages are compared at states of a motion.
"""

from collections.abc import Callable, Sequence

import numpy as np

from dalembert.errors import InputError
from dalembert.forward.complex_steps import DROPPING, REMEDY, check_steps, lost_step
from dalembert.multibody.components.planar.user_force import USER_FORCE
from dalembert.multibody.evaluate import residual
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.motion import Motion
from dalembert.multibody.lowering import Lowered, lower
from dalembert.multibody.system import System
from dalembert.parameters import Parameters

_STATES = 5  # of a motion at which forces are compared


def check_numbers(builder: Callable[..., System], parameters: Parameters, vector: np.ndarray) -> None:
    """Raise where a number of the model, or a function of time, loses the complex step of a parameter.

    Raises
    ------
    InputError
        It names the parameter, the component and its number.
    """

    def lowered(vector: np.ndarray) -> Lowered:
        given = [value if value.imag else value.real for value in vector.tolist()]  # one of them is complex at most
        return lower(builder(**dict(zip(parameters.names, given, strict=True))))

    check_steps(parameters, vector, lambda at: _numbers(lowered(at)), lambda entry: _place(lowered(vector), entry))


def _numbers(lowered: Lowered) -> np.ndarray:
    return np.concatenate([lowered.x, lowered.v, lowered.signal_data, *map(np.ravel, lowered.data.values())])


def _place(lowered: Lowered, entry: int) -> str:
    """The component and the name of a number."""
    size = len(lowered.x)
    if entry < 2 * size:
        what = "a coordinate at the start" if entry < size else "a velocity at the start"
        return f"{what} of {lowered.structure.owners[entry % size]!r}"
    entry -= 2 * size
    if entry < len(lowered.signal_data):
        return "a function of time"
    entry -= len(lowered.signal_data)
    for kind, data in lowered.data.items():
        if entry < data.size:
            row, column = divmod(entry, data.shape[1])
            return f"{kind.numbers[column]!r} of {lowered.parts[kind][row]!r}"
        entry -= data.size
    raise IndexError(entry)


def check_forces(lowered: Lowered, times: np.ndarray, states: Motion, scale: np.ndarray) -> None:
    """Raise where a force of a user's function, or of a kind of another package, loses the complex step of the state.

    Parameters
    ----------
    lowered : Lowered
    times : array (samples,)
    states : Motion of arrays (samples, N + 1)
    scale : array (N + 1,)
        Typical sizes of the coordinates.

    Raises
    ------
    InputError
        It names the component.
    """
    for kind in filter(_foreign, lowered.data):
        for direction in _directions(lowered, states, scale):
            for sample in np.unique(np.linspace(0, len(times) - 1, _STATES).astype(int)):
                _check_force(lowered, kind, direction, float(times[sample]), [part[sample] for part in states[:3]])


def _foreign(kind: Kind) -> bool:
    return kind is USER_FORCE or (kind.source.__module__ or "").partition(".")[0] != __name__.partition(".")[0]


def _directions(lowered: Lowered, states: Motion, scale: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Changes of coordinates and of velocities, each of the size that the motion has."""
    signs = np.where(np.random.default_rng(0).random(len(scale)) < 0.5, -1.0, 1.0)
    signs[lowered.structure.n :] = 0.0  # multipliers
    speed = np.maximum(np.max(np.abs(states.v), axis=0), 1e-3 * np.max(np.abs(states.v), initial=1e-3))
    still = np.zeros_like(scale)
    return [(signs * scale, still), (still, signs * speed)]


def _check_force(lowered: Lowered, kind: Kind, direction: Sequence[np.ndarray], t: float, state: list) -> None:
    x, v, a = state
    dx, dv = direction

    def force(shift: complex) -> np.ndarray:
        if isinstance(shift, complex):
            return residual(lowered, lowered.upright, x + shift * dx, v + shift * dv, a.astype(complex), t, kind)
        return residual(lowered, lowered.real, x + shift * dx, v + shift * dv, a, t, kind)

    lost = lost_step(force, 1.0)
    if lost:
        owners, rows = lowered.parts[kind], lowered.structure.index[kind]
        names = sorted({name for name, own in zip(owners, rows, strict=True) if lost.entry in own})
        raise InputError(
            f"a force of {', '.join(map(repr, names))} depends on the state, but its derivative is {lost.by_step:.6g} "
            f"by the complex step and {lost.by_differences:.6g} by differences, at t = {t:.6g} s. Its function drops "
            f"the imaginary part, as {DROPPING} do. {REMEDY}"
        )
