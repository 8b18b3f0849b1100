"""Responses over frequency for several values of a parameter: over this machine's cores, or on a cluster."""

import hashlib
import json
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from threading import Event
from time import perf_counter
from typing import Any

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.contents import Contents
from dalembert.errors import DalembertError, InputError, SolveError, StorageError, told
from dalembert.forward import Checkpoint, Executor, ensemble
from dalembert.forward.builders import check_function
from dalembert.threads import single_thread
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.responses.curve_family import CurveFamily
from dalembert.vibration.responses.followed_curve import FollowedPoint
from dalembert.vibration.responses.frequency_response import frequency_response
from dalembert.vibration.system.requirements import values_of
from dalembert.vibration.system.system import VibrationSystem

CurveOrError = tuple[FrequencyCurve | None, DalembertError | None, float]
"""A curve or why there is none, and the seconds that it took."""


@takes_checked("frequencies", "values", "executor")
def frequency_responses(
    builder: Callable[..., VibrationSystem],
    parameter: str,
    values: Sequence[float] | np.ndarray,
    frequencies: np.ndarray | tuple[float, float],
    method: HarmonicBalance | None = None,
    *,
    unit: str = "",
    workers: int | None = None,
    executor: Executor = None,
    checkpoint: Checkpoint | None = None,
    on_curve: Callable[[int, FrequencyCurve | None, str | None], None] | None = None,
    **options: Any,
) -> CurveFamily:
    """Return responses over frequency for several values of a parameter, computed on all cores or on a cluster.

    Parameters
    ----------
    builder : callable
        ``builder(**{parameter: value}) -> VibrationSystem``.
    parameter : str
    values : array, shape (values,)
        The first is what reductions are measured by: for a preload 0, with which contacts are free.
    frequencies, method
        As of :func:`frequency_response`.
    unit : str
        Of the parameter, for labels.
    workers : int, optional
        Threads; as many as there are cores if not given.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, such as ``"tcp://10.0.0.1:8786"``, or a client of one, whose workers follow a curve
        each; the bits are the same.
    checkpoint : Checkpoint, optional
        File in which solutions are stored as they are found; whole curves if a cluster computes them.
    on_curve : callable, optional
        Called with the number of each value, its curve and why there is none, in the order of the values.
    options
        Others of :func:`frequency_response`: ``continuation``, ``observe``, ``stability`` and so on.

    Returns
    -------
    CurveFamily
        A value for which there is no curve is marked with the reason, and the others return.

    Raises
    ------
    InputError
        Where no values are given, and where no cluster answers.
    DalembertError
        Where there is no curve for any of them: the reason of the first.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import ElasticSlider, FrictionContact, HarmonicForce, VibrationSystem
    >>> def damped(preload):
    ...     system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    ...     system.add(HarmonicForce("m", 1.0))
    ...     system.add(FrictionContact("damper", "m", friction=0.5, preload=preload, law=ElasticSlider(0.8)))
    ...     return system
    >>> family = frequency_responses(damped, "preload", [0.0, 1.0, 2.0, 10.0], np.linspace(0.12, 0.25, 40))
    >>> family.best("m"), family.reduction("m").round(2).tolist()
    (2.0, [0.0, 0.59, 0.85, 0.72])
    """
    check_function("frequency_responses", builder, [parameter])
    numbers = values_of(values, "frequency_responses", parameter).tolist()
    follow = _Follow(builder, parameter, frequencies, method or HarmonicBalance(), options)
    curves: list[FrequencyCurve | None] = []
    errors: list[DalembertError | None] = []
    with single_thread(), closing(_followed(follow, numbers, workers, executor, checkpoint)) as outcomes:
        for row, (curve, error, _) in enumerate(outcomes):
            curves.append(curve)
            errors.append(error)
            if on_curve is not None:
                on_curve(row, curve, None if error is None else str(error))
    if errors[0] is not None and all(curve is None for curve in curves):
        raise errors[0]
    failures = tuple(None if error is None else str(error) for error in errors)
    return CurveFamily(parameter, unit, np.array(numbers), tuple(curves), failures)


def _followed(
    follow: "_Follow", values: list[float], workers: int | None, executor: Executor, checkpoint: Checkpoint | None
) -> Generator[CurveOrError, None, None]:
    """Yield the curve at each value: from the checkpoint, or as it is followed on a core or a worker."""
    stopped = Event()

    def on_core(value: float) -> CurveOrError:
        """Follow a curve in a thread of this process. After an interruption it stops at its next point."""

        def check_stopped(_: FollowedPoint) -> None:
            if stopped.is_set():
                raise InputError("stopped")

        return follow(value, checkpoint=checkpoint, on_point=check_stopped)

    stored = [None if checkpoint is None else follow.recall(checkpoint, value) for value in values]
    missing = [value for value, curve in zip(values, stored, strict=True) if curve is None]
    work: Callable[[float], CurveOrError] = on_core if executor is None else follow
    with closing(ensemble(work, missing, workers=workers, executor=executor, on_stop=stopped.set)) as outcomes:
        for value, curve in zip(values, stored, strict=True):
            if curve is not None:
                yield curve, None, 0.0
                continue
            outcome = next(outcomes)
            if executor is not None and checkpoint is not None:
                follow.keep(checkpoint, value, outcome)
            yield outcome


@dataclass(frozen=True)
class _Follow:
    """The curve at one value, as it is followed here or on a worker."""

    builder: Callable[..., VibrationSystem]
    parameter: str
    frequencies: np.ndarray | tuple[float, float]
    method: HarmonicBalance
    options: Mapping[str, Any]

    def __call__(self, value: float, **more: Any) -> CurveOrError:
        began = perf_counter()
        try:
            curve = frequency_response(
                self.system(value), self.frequencies, self.method, check=False, **self.options, **more
            )
        except StorageError:  # no other value will do better
            raise
        except DalembertError as error:
            return None, error, 0.0
        except Exception as error:  # the user's builder or law raised: this value's failure, not the others'
            return None, SolveError(told(error)), 0.0
        return curve, None, perf_counter() - began

    def system(self, value: float) -> VibrationSystem:
        """The system at a value."""
        return self.builder(**{self.parameter: value})

    def recall(self, checkpoint: Checkpoint, value: float) -> FrequencyCurve | None:
        """Return the whole curve from a checkpoint; None if it is not stored."""
        try:
            known = checkpoint.recall(self._key(value))
        except Exception:  # a system that cannot be built is this value's failure when its turn comes
            return None
        if known is None:
            return None
        text, *arrays = known
        stored = json.loads(text.tobytes())
        over = stored["variables"]
        variables = dict(zip(over, zip(over.values(), arrays, strict=True), strict=True))
        return FrequencyCurve.from_xarray(Contents(variables, attributes=stored["attributes"]).to_xarray())

    def keep(self, checkpoint: Checkpoint, value: float, outcome: CurveOrError) -> None:
        """Keep a whole curve, with the seconds that it took."""
        curve, _, seconds = outcome
        if curve is not None:
            contents = curve.contents()
            over = {name: dimensions for name, (dimensions, *_) in contents.variables.items()}
            text = json.dumps({"variables": over, "attributes": dict(contents.attributes)}).encode()
            arrays = (values for _, values, *_ in contents.variables.values())
            checkpoint.keep(self._key(value), (np.frombuffer(text, np.uint8), *arrays), seconds)

    def _key(self, value: float) -> bytes:
        """Hash of all that the curve depends on."""
        settings = {name: option for name, option in self.options.items() if name != "start"}
        start = self.options.get("start")
        begin = b"" if start is None else start[0].unknowns[start[1]].tobytes()
        ends, along = isinstance(self.frequencies, tuple), np.asarray(self.frequencies, dtype=float)
        system = lower(self.system(value)).real.fingerprint(self.method, ends, sorted(settings.items()))
        return hashlib.sha256(b"curve" + system.encode() + along.tobytes() + begin).digest()
