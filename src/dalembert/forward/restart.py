"""Models of motions that can begin anew at a later state: what multiple shooting needs of a model."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from dalembert.errors import InputError
from dalembert.forward.model import ForwardModel
from dalembert.forward.wrapped import Wrapped


@dataclass(frozen=True, eq=False)
class StateChart:
    """Numbers of a state that determine the others near a known state.

    Parameters
    ----------
    names, units : tuple of str, length numbers
        Such as ``"upper.angle"`` and ``"upper.angle rate"``.
    places : array of int, shape (numbers,)
        Their places among all numbers that can be chosen.
    near : array, shape (state,)
        The whole state near which the others are completed, then the whole turns there of the channels ``turning``.
    values : array, shape (numbers,)
        The numbers at the known state.
    scales : array, shape (numbers,)
        Typical sizes.
    offsets : array, shape (numbers,)
        What to add to numbers before those of several charts are compared: rotation increments begin at zero at each
        known state.
    reach : array, shape (numbers,)
        Largest magnitudes.
    read : function
        The numbers (..., numbers) of whole states (..., state), real or complex.
    whole : bool
        Whether all numbers of the state are named, so that a motion can be read but not begun.
    turning : tuple of str
        Channels of angles that the state determines only up to whole turns.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    places: np.ndarray
    near: np.ndarray
    values: np.ndarray
    scales: np.ndarray
    offsets: np.ndarray
    reach: np.ndarray
    read: Callable[[np.ndarray], np.ndarray]
    whole: bool = False
    turning: tuple[str, ...] = ()

    def turned(self, turns: np.ndarray) -> "StateChart":
        """Return the chart with more whole turns (turning,) of its angles."""
        near = self.near.copy()
        near[len(near) - len(turns) :] += turns
        return replace(self, near=near)


@runtime_checkable
class Restartable(Protocol):
    """A forward model of a motion that can begin anew at later states, with exact derivatives by them."""

    def state_chart(
        self,
        vector: np.ndarray,
        state: np.ndarray | None = None,
        *,
        whole: bool = False,
        like: StateChart | None = None,
    ) -> StateChart:
        """Return numbers that determine a state.

        Parameters
        ----------
        vector : array, shape (parameters,)
        state : array, shape (state,), optional
            Whole state near which they do; the initial one at ``vector`` if not given.
        whole : bool
            Whether the chart is to name all numbers of the state, dependent ones too.
        like : StateChart, optional
            Its numbers are kept where they determine the state well.
        """
        ...

    def restarted(
        self, begin: float, times: ArrayLike, chart: StateChart | None, ends: StateChart | None
    ) -> ForwardModel:
        """Return the model of a segment of the motion.

        Parameters
        ----------
        begin : float
            Beginning of the segment, measured along the coordinate from that of this model's motion.
        times : array, shape (samples,)
            Samples, measured from the beginning of the segment.
        chart : StateChart, optional
            The segment begins at these numbers. They are parameters of the returned model behind those of this one. If
            not given, it begins at the initial state that follows from the parameters.
        ends : StateChart, optional
            Numbers of the state that are channels of the returned model behind those of this one.
        """
        ...


def restartable(model: ForwardModel) -> Restartable | None:
    """Return the model, or the one that it is wrapped around, if it can begin anew at later states; else None."""
    while isinstance(model, Wrapped):
        model = model.model
    return model if isinstance(model, Restartable) else None


def restarted(
    model: ForwardModel, begin: float, times: ArrayLike, chart: StateChart | None, ends: StateChart | None
) -> ForwardModel:
    """Return the model of a segment of a motion, wrapped as the model is; see :class:`Restartable`.

    Raises
    ------
    InputError
        For a model that cannot begin at a later state.
    """
    if isinstance(model, Wrapped):
        return replace(model, model=restarted(model.model, begin, times, chart, ends))
    if not isinstance(model, Restartable):
        raise InputError(
            f"a {type(model).__name__} cannot begin at a later state; expected a model such as TimeResponse"
        )
    return model.restarted(begin, times, chart, ends)


def begun_later(model: ForwardModel, begin: float, times: ArrayLike) -> ForwardModel | None:
    """Return the same model, whose motion starts at a later time of its signals; None for one that has no such time."""
    if isinstance(model, Wrapped):
        inner = begun_later(model.model, begin, times)
        return None if inner is None else replace(model, model=inner)
    later = getattr(model, "later", None)
    return None if later is None else later(begin, times)
