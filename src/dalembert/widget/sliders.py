"""What a widget simulates, and how it is made."""

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.argument_readers import names_of
from dalembert.arguments import is_number
from dalembert.errors import InputError, shown
from dalembert.multibody import Trajectory, simulate
from dalembert.parameters import Parameters
from dalembert.report.player.film import frames
from dalembert.studio.simulation.simulated_parts import last_time
from dalembert.study import load
from dalembert.study.tables.study import Study

if TYPE_CHECKING:
    from dalembert.data import Measurements


@dataclass(frozen=True, eq=False)
class Source:
    """What a widget simulates: a motion from values of parameters. ``motion`` returns that of a vector (parameters,) at
    times, s; ``end``: s; ``channels``: drawn over time; ``data``: drawn with the channels of the same names.
    """

    parameters: Parameters
    motion: Callable[[np.ndarray, np.ndarray], Trajectory]
    end: float
    channels: tuple[str, ...] = ()
    data: "Measurements | None" = None

    @property
    def times(self) -> np.ndarray:
        """Times of the frames, s."""
        return frames(self.end)

    def at(self, values: Mapping[str, float]) -> Trajectory:
        """The motion at values by name; those that are not given are the starts, and all are kept within bounds."""
        items = self.parameters
        vector = np.array([values.get(name, start) for name, start in zip(items.names, items.start, strict=True)])
        return self.motion(np.clip(vector, items.lower, items.upper), self.times)


def sliders(
    model: Study | str | os.PathLike[str] | Callable[..., Any],
    parameters: Parameters | None = None,
    *,
    end: float | None = None,
    channels: Sequence[str] = (),
    solver: Any = None,
) -> Any:
    """Return a widget that plays a mechanism, with a slider for each parameter.

    A slider that moves simulates again. The newest value wins: while a simulation runs, older ones are dropped.

    Parameters
    ----------
    model : Study, path of a study file, or callable
        A callable returns a mechanism from values of the parameters by name.
    parameters : Parameters, optional
        Of a callable; a study has its own.
    end : float, optional
        Last time, s; a study has its own.
    channels : sequence of str
        Drawn over time, such as ``["rod.end.x"]``; those of the study's data or task if not given.
    solver : Integrator, optional
        Of a callable.

    Returns
    -------
    anywidget.AnyWidget
        Its ``values`` are the current values by name, in SI units.

    Raises
    ------
    InputError
        For a model that is no mechanism, without parameters or end, and where anywidget is not installed.
    """
    if isinstance(model, str | os.PathLike):
        model = load(Path(model))
    source = _of_study(model, end, channels) if isinstance(model, Study) else _of_function(
        model, parameters, end, channels, solver
    )  # fmt: skip
    try:
        from dalembert.widget.frontend import MechanismSliders
    except ImportError:
        raise InputError(
            "sliders needs anywidget, which is not installed; run: pip install 'dalembert[notebook]'"
        ) from None
    return MechanismSliders(source)


def _of_study(study: Study, end: float | None, channels: Sequence[str]) -> Source:
    if not study.has_system:
        raise InputError(f"sliders: the model of {study.path.name} is no mechanism. Give a study of a mechanism")
    if study.file.solver is None:
        raise InputError(f"sliders: {study.path.name} has no table [solver]. Add one with at least its step")
    last = last_time(study) if end is None else _checked(end)
    if last is None:
        raise InputError(f"sliders: {study.path.name} has no last time. Give end in s")
    data = None if study.file.data is None else study.data()
    known = (data.channels if data else ()) or getattr(study.table, "channels", None) or ()
    names = names_of(channels, "sliders", "channels") or tuple(known)

    def motion(vector: np.ndarray, times: np.ndarray) -> Trajectory:
        return study.motion(last, vector, times)

    return Source(study.parameters, motion, last, names, data)


def _of_function(
    builder: Any, parameters: Parameters | None, end: float | None, channels: Sequence[str], solver: Any
) -> Source:
    if not callable(builder):
        raise InputError(
            f"sliders: model is {shown(builder)}; expected a study, the path of a study file, or a function that "
            "returns a mechanism"
        )
    if not isinstance(parameters, Parameters):
        raise InputError(f"sliders: parameters is {shown(parameters)}; expected Parameters, which a function needs")
    last = _checked(end)

    def motion(vector: np.ndarray, times: np.ndarray) -> Trajectory:
        system: Any = builder(**parameters.mapping(vector))
        return simulate(system, last, solver=solver, times=times)

    return Source(parameters, motion, last, names_of(channels, "sliders", "channels"))


def _checked(end: Any) -> float:
    if not is_number(end) or not end > 0:
        raise InputError(f"sliders: end is {shown(end)}; expected a positive number of seconds")
    return float(end)
