"""Responses over frequency for several values of a parameter: over this machine's cores, or on a cluster."""

import hashlib
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from threading import Event
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.contents import Contents
from dalembert.errors import DalembertError, InputError, SolveError, StorageError, told
from dalembert.findings import Finding
from dalembert.forward import Checkpoint, Executor, ensemble
from dalembert.forward.builders import check_function
from dalembert.results import Result
from dalembert.threads import one_thread
from dalembert.units import unit_of
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.paths.curve import FrequencyCurve, Peak
from dalembert.vibration.responses.frequency_response import FollowedPoint, frequency_response
from dalembert.vibration.system.requirements import values_of
from dalembert.vibration.system.system import VibrationSystem

if TYPE_CHECKING:
    from xarray import Dataset

CurveOrError = tuple[FrequencyCurve | None, DalembertError | None, float]
"""A curve or why there is none, and the seconds that it took."""


ON_HARMONICS = {"few-harmonics": "error", "unchecked-harmonics": "harmonics", "harmonics-chosen": "harmonics"}
"""Codes of findings on chosen harmonics, and the value by which one is worse than another."""


class Envelope(NamedTuple):
    """The smallest and the largest response of all curves: frequencies in Hz, amplitudes, each (points,)."""

    frequencies: np.ndarray
    smallest: np.ndarray
    largest: np.ndarray


@dataclass(frozen=True, eq=False)
class CurveFamily(Result):
    """Responses over frequency for several values of a parameter, as :func:`frequency_responses` returns them.

    Parameters
    ----------
    parameter, unit : str
        What is varied.
    values : array, shape (values,)
    curves : tuple of FrequencyCurve or None
        None where there is none.
    failures : tuple of str or None
        Why there is none.
    """

    FORMAT: ClassVar[str] = "dalembert curve family 1"

    parameter: str
    unit: str
    values: np.ndarray
    curves: tuple[FrequencyCurve | None, ...]
    failures: tuple[str | None, ...]

    def __len__(self) -> int:
        return len(self.values)

    @property
    def dofs(self) -> tuple[str, ...]:
        """Names of the observed degrees of freedom."""
        return next((curve.dofs for curve in self.curves if curve is not None), ())

    def peaks(self, dof: str, kind: str = "peak") -> tuple[Peak, ...]:
        """The largest amplitude of a degree of freedom on each curve; NaN if no point of the curve converged.

        Parameters
        ----------
        dof : str
        kind : str
            ``"peak"``, ``"rms"``, or ``"harmonic 1"`` and so on.

        Raises
        ------
        InputError
            For an unknown kind, or a degree of freedom that was not observed.
        """
        found = (one.peak(dof, kind) if one is not None and one.converged.any() else None for one in self.curves)
        return tuple(peak or Peak(float("nan"), float("nan")) for peak in found)

    def best(self, dof: str, kind: str = "peak") -> float:
        """Return the value whose curve has the smallest peak.

        Raises
        ------
        InputError
            As :meth:`peaks`, and where no curve was found.
        """
        sizes = self._sizes(dof, kind)
        if np.isnan(sizes).all():
            raise InputError(f"no curve was found, so no value of {self.parameter} is the best; see failures")
        return float(self.values[np.nanargmin(sizes)])

    def reduction(self, dof: str, kind: str = "peak") -> np.ndarray:
        """Reduction of each peak relative to that of the first value, (values,): 1 - peak / first peak.

        NaN where there is no first peak, or no motion at it.
        """
        sizes = self._sizes(dof, kind)
        return 1 - sizes / sizes[0] if sizes[0] > 0 else np.full(len(sizes), np.nan)

    def envelope(self, dof: str, kind: str = "peak") -> Envelope:
        """The smallest and the largest response of all curves at each frequency that all of them have.

        A curve that passes a frequency several times, past folds, counts with all its responses there. Between points
        curves are straight.
        """
        found = [one for one in self.curves if one is not None and one.converged.sum() > 1]
        if not found:
            raise InputError("no curve was found, so there is no envelope; see failures")
        ends = np.array([[one.frequencies[one.converged].min(), one.frequencies[one.converged].max()] for one in found])
        low, high = ends[:, 0].max(), ends[:, 1].min()
        every = np.unique(np.concatenate([one.frequencies[one.converged] for one in found]))
        frequencies = every[(low <= every) & (every <= high)]
        smallest, largest = np.full((2, len(frequencies)), np.nan)
        for one in found:
            sizes = one.amplitude(dof, kind)[one.converged]
            for rows, between in _passes(one.frequencies[one.converged], sizes, frequencies):
                smallest[rows] = np.fmin(smallest[rows], between)
                largest[rows] = np.fmax(largest[rows], between)
        return Envelope(frequencies, smallest, largest)

    @property
    def success(self) -> bool:
        """Whether every point of every curve is converged."""
        return all(curve is not None and curve.success for curve in self.curves)

    @property
    def status(self) -> str:
        """How many curves were found, in a sentence."""
        found = [curve for curve in self.curves if curve is not None]
        points, lost = sum(map(len, found)), sum(int((~curve.converged).sum()) for curve in found)
        text = f"{len(found)} of {len(self)} curves over {self.parameter}, {points - lost} of {points} points found"
        reasons = [
            f"; {self.parameter} = {value:.6g}: {reason}"
            for value, reason in zip(self.values, self.failures, strict=True)
            if reason
        ]
        return text + "".join(reasons[:3])

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The worst of the curves' findings on harmonics that were chosen, each with the value of its curve."""
        found = [
            (value, finding)
            for value, curve in zip(self.values.tolist(), self.curves, strict=True)
            for finding in (() if curve is None else curve.findings)
        ]
        worst = []
        for code, size in ON_HARMONICS.items():
            those = [(value, finding) for value, finding in found if finding.code == code]
            if those:
                value, finding = max(those, key=lambda one: one[1].values[size])
                message = f"{self.parameter} = {_quantity(value, self.unit)}: {finding.message}"
                worst.append(replace(finding, values={**finding.values, "value": value}, message=message))
        return tuple(worst)

    def summary(self) -> str:
        """A few lines: what was found, and the peaks of the observed degrees of freedom over the parameter."""
        lines = [self.status]
        for dof in self.dofs[:4]:
            peaks, more = self.peaks(dof), 0.0 - self.reduction(dof)
            lines.append(f"{dof}: smallest peak at {self.parameter} = {_quantity(self.best(dof), self.unit)}")
            lines += [
                f"  {_quantity(value, self.unit)}: {_quantity(peak.amplitude, unit_of(dof))} at "
                f"{peak.frequency:.6g} Hz ({part:+.1%})"
                for value, peak, part in zip(self.values, peaks, more, strict=True)
            ]
        return "\n".join([*lines, *map(str, self.findings)])

    def contents(self) -> Contents:
        """Everything as arrays: the names and dimensions of each curve end in its number, ``_0``."""
        kept = {row: curve.contents() for row, curve in enumerate(self.curves) if curve is not None}
        variables: dict[str, Any] = {"values": ("value", self.values, {"units": self.unit})}
        for row, one in kept.items():
            for name, (over, *rest) in one.variables.items():
                variables[f"{name}_{row}"] = (tuple(f"{dimension}_{row}" for dimension in over), *rest)
        attributes = {
            "format": self.FORMAT,
            "parameter": self.parameter,
            "failures": json.dumps(self.failures),
            "curves": json.dumps({row: dict(one.attributes) for row, one in kept.items()}),
        }
        return Contents(variables, attributes=attributes)

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> "CurveFamily":
        """The family that :meth:`to_xarray` turned into a dataset."""
        kept = json.loads(dataset.attrs["curves"])
        given = dataset["values"]
        curves = tuple(_curve(dataset, str(row), kept.get(str(row))) for row in range(len(given)))
        failures = tuple(json.loads(dataset.attrs["failures"]))
        return cls(dataset.attrs["parameter"], given.attrs["units"], given.values, curves, failures)

    def _sizes(self, dof: str, kind: str) -> np.ndarray:
        return np.array([peak.amplitude for peak in self.peaks(dof, kind)])


def _curve(dataset: "Dataset", row: str, attributes: dict[str, Any] | None) -> FrequencyCurve | None:
    """The curve whose variables end in a number."""
    if attributes is None:
        return None
    own = dataset[[name for name in dataset if str(name).rpartition("_")[2] == row]]
    names = {name: str(name).rpartition("_")[0] for name in (*own, *own.dims)}
    return FrequencyCurve.from_xarray(own.rename(names).assign_attrs(attributes))


def _passes(along: np.ndarray, sizes: np.ndarray, frequencies: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Rows of the frequencies on each part of a curve that does not turn, and its responses there."""
    turns = np.flatnonzero(np.diff(np.sign(np.diff(along)))) + 1
    for begin, end in zip(np.append(0, turns), np.append(turns, len(along) - 1), strict=True):
        part = slice(begin, end + 1)
        order = np.argsort(along[part])
        own, there = along[part][order], sizes[part][order]
        rows = np.flatnonzero((own[0] <= frequencies) & (frequencies <= own[-1]))
        yield rows, np.interp(frequencies[rows], own, there)


def _quantity(value: float, unit: str) -> str:
    return f"{value:.6g} {unit}".rstrip()


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
    given = values_of(values, "frequency_responses", parameter)
    one = _One(builder, parameter, frequencies, method or HarmonicBalance(), options)
    stopped = Event()

    def here(value: float) -> CurveOrError:
        """Follow a curve in a thread of this process. After an interruption it stops at its next point."""

        def go_on(_: FollowedPoint) -> None:
            if stopped.is_set():
                raise InputError("stopped")

        return one(value, checkpoint=checkpoint, on_point=go_on)

    kept = [None if checkpoint is None else one.recall(checkpoint, value) for value in given.tolist()]
    missing = [value for value, curve in zip(given.tolist(), kept, strict=True) if curve is None]
    work: Callable[[float], CurveOrError] = here if executor is None else one
    curves: list[FrequencyCurve | None] = []
    errors: list[DalembertError | None] = []
    found = ensemble(work, missing, workers=workers, executor=executor, on_stop=stopped.set)
    with one_thread(), closing(found):
        for row, (value, known) in enumerate(zip(given.tolist(), kept, strict=True)):
            answer = next(found) if known is None else (known, None, 0.0)
            if known is None and executor is not None and checkpoint is not None:
                one.keep(checkpoint, value, answer)
            curve, error, _ = answer
            curves.append(curve)
            errors.append(error)
            if on_curve is not None:
                on_curve(row, curve, None if error is None else str(error))
    if errors[0] is not None and all(curve is None for curve in curves):
        raise errors[0]
    failures = tuple(None if error is None else str(error) for error in errors)
    return CurveFamily(parameter, unit, given, tuple(curves), failures)


@dataclass(frozen=True)
class _One:
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
        """The whole curve, where a checkpoint holds it."""
        try:
            known = checkpoint.recall(self._key(value))
        except Exception:  # a system that cannot be made is told when its turn comes
            return None
        if known is None:
            return None
        text, *arrays = known
        told = json.loads(text.tobytes())
        variables = dict(zip(told["variables"], zip(told["variables"].values(), arrays, strict=True), strict=True))
        return FrequencyCurve.from_xarray(Contents(variables, attributes=told["attributes"]).to_xarray())

    def keep(self, checkpoint: Checkpoint, value: float, found: CurveOrError) -> None:
        """Keep a whole curve, with the seconds that it took."""
        curve, _, seconds = found
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
        told = lower(self.system(value)).real.fingerprint(self.method, ends, sorted(settings.items()))
        return hashlib.sha256(b"curve" + told.encode() + along.tobytes() + begin).digest()
