"""Motions that begin at a state: some coordinates and rates, completed by the joints."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from scipy.linalg import null_space, qr

from dalembert.errors import SolveError
from dalembert.forward import Channel, StateChart
from dalembert.multibody.components.body import POSITION
from dalembert.multibody.components.planar.body import ANGLE
from dalembert.multibody.evaluate import constraint_jacobian, constraint_rates, residual
from dalembert.multibody.fingerprint import fingerprint
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.model import Model
from dalembert.multibody.lowered import Lowered
from dalembert.multibody.motion_model import BuiltModel, MotionModel
from dalembert.multibody.scales import scales
from dalembert.parameters import Parameter, Parameters

_ANGLES_FIRST = 4.0
"""Weight of angles among the coordinates that are chosen: a pendulum's is independent at each of its positions."""

_WELL = 0.2  # of the smallest singular value of the best choice, down to which a former choice is kept
_MOST_ITERATIONS = 40
_CLOSED = 1e-12  # step of Newton's method, in parts of the extent, after which the joints are closed
_REACH = 1e6  # bounds of a state in typical sizes: methods give their own


def chart(lowered: Lowered, state: np.ndarray, whole: bool = False, like: StateChart | None = None) -> StateChart:
    """Return independent coordinates and rates of a mechanism near a state (2n,); all of them if ``whole``.

    The constraints leave the motions N = null(J) free, in scaled coordinates. Independent are the coordinates whose
    rows of N a pivoted QR decomposition chooses; or those of a chart ``like`` it, where their rows are not much worse.
    """
    structure = lowered.structure
    n, scale = structure.n, scales(lowered)[: structure.n]
    places = np.arange(n)
    if structure.size > n and not whole:
        x = np.concatenate([state[:n], np.zeros(structure.size + 1 - n)])
        free = null_space(constraint_jacobian(lowered, x).toarray() * scale)
        preferred = np.where(np.array(structure.kinds) == ANGLE, _ANGLES_FIRST, 1.0)
        decomposed = qr((free * preferred[:, None]).T, mode="economic", pivoting=True)
        order = cast(tuple[np.ndarray, np.ndarray, np.ndarray], decomposed)[2]
        places = np.sort(order[: free.shape[1]])
        if like is not None:
            known = like.places[: len(like.places) // 2]
            if len(known) == len(places) and _least(free[known]) > _WELL * _least(free[places]):
                places = known
    names = [_coordinate_names(lowered)[place] for place in places]
    units = [_unit(structure.kinds[place]) for place in places]
    return StateChart(
        (*names, *(f"{name} rate" for name in names)),
        (*units, *(f"{unit}/s" for unit in units)),
        np.concatenate([places, n + places]),
        state,
        np.tile(scale[places], 2),
        whole,
    )


def _least(rows: np.ndarray) -> float:
    """Smallest singular value: how well the coordinates of these rows determine the others."""
    return float(np.linalg.svd(rows, compute_uv=False).min(initial=np.inf))


def _coordinate_names(lowered: Lowered) -> list[str]:
    """Names of all coordinates: ``"bar.x"``, ``"bar.y"`` and ``"bar.angle"``, numbered in bodies of several nodes."""
    names: list[str] = []
    for body in lowered.bodies.values():
        counts: dict[str, int] = {}
        for kind in body.coordinate_kinds:
            number = counts[kind] = counts.get(kind, -1) + 1
            node, axis = (number, 0) if kind == ANGLE else divmod(number, body.dimension)
            what = kind if kind == ANGLE else "xyz"[axis] if kind == POSITION else f"{kind} {'xyz'[axis]}"
            names.append(f"{body.name}.{what}" + ("" if body.rigid and kind in (ANGLE, POSITION) else f" {node + 1}"))
    return names


def _unit(kind: str) -> str:
    return {POSITION: "m", ANGLE: "rad"}.get(kind, "")


@dataclass(frozen=True, eq=False)
class Completion:
    """How the dependent coordinates of a state follow from the chosen ones.

    Parameters
    ----------
    chart : StateChart
    dependent : array of int
        Coordinates that follow.
    x, inverse : array
        Unknowns (N + 1,) where the joints are closed, and the inverse of the constraints' derivative by the dependent
        coordinates there.
    """

    chart: StateChart
    dependent: np.ndarray
    x: np.ndarray
    inverse: np.ndarray

    @classmethod
    def at(cls, lowered: Lowered, chart: StateChart, numbers: np.ndarray) -> "Completion":
        """Solve Φ(q, y) = 0 for the dependent coordinates y near the chart's state, by Newton's method.

        Raises
        ------
        SolveError
            Where the joints do not close there.
        """
        n, size = lowered.structure.n, lowered.structure.size
        half = len(chart.places) // 2
        x = np.concatenate([chart.near[:n], np.zeros(size + 1 - n)])
        x[chart.places[:half]] = numbers[:half]
        dependent = np.setdiff1d(np.arange(n), chart.places[:half])
        still, extent = np.zeros_like(x), scales(lowered).max()
        for _ in range(_MOST_ITERATIONS if size > n else 0):
            inverse = np.linalg.pinv(constraint_jacobian(lowered, x)[:, dependent].toarray(), rcond=1e-10)
            step = -inverse @ residual(lowered, lowered.real, x, still, still)[n:]
            longest = np.abs(step).max(initial=0.0)
            if not np.isfinite(longest):
                break
            x[dependent] += step * min(1.0, 0.5 * extent / (longest + 1e-300))
            if longest <= _CLOSED * extent:
                return cls(chart, dependent, x, inverse)
        if size == n:
            return cls(chart, dependent, x, np.zeros((0, 0)))
        raise SolveError("a segment cannot begin: its joints do not close at the state; give more segments")

    def applied(self, lowered: Lowered, numbers: np.ndarray) -> Lowered:
        """Return arrays that begin at these numbers, whose real part the completion is for; with their derivatives."""
        n, half = lowered.structure.n, len(self.chart.places) // 2
        complex_state = lowered.is_complex or bool(lowered.callbacks) or np.iscomplexobj(numbers)
        x = self.x.astype(complex if complex_state else float)
        v, still = np.zeros_like(x), np.zeros_like(x)
        v[:n] = self.chart.near[n:]
        x[self.chart.places[:half]] = numbers[:half]
        v[self.chart.places[:half]] = numbers[half:]
        if len(self.inverse) == 0:
            return replace(lowered, x=x, v=v)
        model = lowered.complex_model if complex_state else lowered.real
        if complex_state:  # linear: once for the derivative
            x[self.dependent] -= self.inverse @ residual(lowered, model, x, still, still)[n:]
        for _ in range(2):  # once for the value, once for its derivative
            v[self.dependent] -= self.inverse @ constraint_rates(lowered, model, x, v, still)[0]
        return replace(lowered, x=x, v=v)


@dataclass(frozen=True)
class MotionSegment(MotionModel):
    """A segment of a mechanism's motion as a forward model.

    Parameters
    ----------
    model : TimeResponse
        Of the motion.
    begin : float
        Time of the signals at the beginning of the segment, s.
    times : array, shape (samples,)
        s, from the beginning of the segment.
    chart : StateChart or None
        Numbers of the state that it begins at, which are parameters behind those of the model; the initial state that
        the model's builder makes if None.
    ends : StateChart or None
        Numbers of the state that are channels behind those of the model.
    """

    model: BuiltModel
    begin: float
    times: np.ndarray
    chart: StateChart | None
    ends: StateChart | None

    @property
    def _built(self) -> BuiltModel:
        return self.model

    @cached_property
    def parameters(self) -> Parameters:
        """Those of the model, then the numbers of the state."""
        if self.chart is None:
            return self.model.parameters
        wide = _REACH * self.chart.scales
        states = [
            Parameter(f"state {name}", value - reach, value + reach, unit, scale)
            for name, value, reach, unit, scale in zip(
                self.chart.names, self.chart.values, wide, self.chart.units, self.chart.scales, strict=True
            )
        ]
        return Parameters((*self.model.parameters.declared, *states))

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Channels with their units."""
        if self.ends is None:
            return self.model.channels
        states = zip(self.ends.names, self.ends.units, strict=True)
        return (*self.model.channels, *(Channel(f"state {name}", unit) for name, unit in states))

    @property
    def fingerprint(self) -> str:
        """Hash of the model, and of where the segment begins and ends."""
        charts = [
            None if one is None else (one.names, one.places.tolist(), one.near.tolist())
            for one in (self.chart, self.ends)
        ]
        return fingerprint(self.model.shared, self.times, self.model.fingerprint, self.begin, charts)

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex step of the model with differences at a vector (parameters,)."""
        self.model.check_derivatives(vector[: len(self.model.parameters)])

    def first(self, samples: int) -> "MotionSegment":
        """The same segment, cut to its first ``samples`` samples."""
        return replace(self, times=self.times[:samples])

    def _lower(self, vector: np.ndarray) -> Lowered:
        if self.chart is None:
            return super()._lower(vector)
        own = vector[: len(self.model.parameters)]
        lowered = self.model.lowered_at(own, self.begin, closed=False)
        return Completion.at(lowered, self.chart, vector[len(own) :]).applied(lowered, vector[len(own) :])

    def _perturbed(self, vector: np.ndarray) -> tuple[Lowered, list[Lowered]]:
        """The arrays, and those moved by a complex step of each parameter, then of each number of the state."""
        if self.chart is None:
            return super()._perturbed(vector)
        number = len(self.model.parameters)
        own, numbers = vector[:number], vector[number:]
        placed, moved = self.model.placed(own, self.begin)
        completion = Completion.at(placed, self.chart, numbers)
        lowered, perturbed = completion.applied(placed, numbers), []
        for one in moved:
            still = not (one.is_complex or one.callbacks)
            perturbed.append(replace(one, x=lowered.x, v=lowered.v) if still else completion.applied(one, numbers))
        for column in range(len(numbers)):
            shifted = numbers.astype(complex)
            shifted[column] += 1j * STEP * self.parameters.scale[number + column]
            perturbed.append(completion.applied(placed, shifted))
        return lowered, perturbed

    def _read(self, lowered: Lowered, model: Model, states: Any) -> np.ndarray:
        """Channels of the model and numbers of the state, (samples, channels)."""
        values = super()._read(lowered, model, states)
        if self.ends is None:
            return values
        n, (x, v) = lowered.structure.n, states[:2]
        return np.concatenate([values, np.concatenate([x[:, :n], v[:, :n]], axis=1)[:, self.ends.places]], axis=1)
