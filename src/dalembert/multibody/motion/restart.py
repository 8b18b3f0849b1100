"""Motions that begin at a state: some coordinates and rates, completed by the joints."""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, cast

import numpy as np
from scipy.linalg import null_space, qr

from dalembert.errors import SolveError
from dalembert.forward import Channel, StateChart
from dalembert.multibody.components.base_body import ANGLE, DISPLACEMENT, POSITION
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.model.evaluate import constraint_jacobian, constraint_rates, residual
from dalembert.multibody.model.fingerprint import fingerprint
from dalembert.multibody.model.lowered import Lowered, scales
from dalembert.multibody.motion.local_coordinates import LocalCoordinates, coordinate_names
from dalembert.multibody.motion.motion_model import BuiltModel, MotionModel
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

_ANGLES_FIRST = 4.0
"""Weight of angles among the coordinates that are chosen: a pendulum's is independent at each of its positions."""

_WELL = 0.2  # of the smallest singular value of the best choice, down to which a former choice is kept
_MOST_ITERATIONS = 40
_CLOSED = 1e-12  # step of Newton's method, in parts of the extent, after which the joints are closed
_REACH = 1e6  # bounds of a state in typical sizes: methods give their own


def chart(
    lowered: Lowered,
    state: np.ndarray,
    whole: bool = False,
    like: StateChart | None = None,
    turning: tuple[str, ...] = (),
) -> StateChart:
    """Return independent coordinates and rates of a mechanism near a state; all of them if ``whole``. The state
    (2n + turning,) ends with the whole turns of the channels ``turning``; they are zero where it has 2n numbers. The
    constraints leave the motions N = null(J) free, in scaled local coordinates. A pivoted QR decomposition chooses the
    rows of N of the independent coordinates; those of a chart ``like`` it stay unless their rows are much worse.
    """
    structure, scale = lowered.structure, scales(lowered)
    n, size = structure.n, structure.size
    state = np.concatenate([state, np.zeros(2 * n + len(turning) - len(state))])
    if whole:
        names, units = coordinate_names(lowered), [_unit(kind) for kind in structure.kinds]
        every, sizes = np.arange(len(state)), np.concatenate([np.tile(scale[:n], 2), np.ones(len(turning))])
        labels = (
            (*names, *(f"{name} rate" for name in names), *(f"{name} turns" for name in turning)),
            (*units, *(f"{unit}/s" for unit in units), *("" for _ in turning)),
        )
        far = np.zeros(len(state)), np.full(len(state), np.inf)
        return StateChart(*labels, every, state, state, sizes, *far, _all, whole, turning)
    local = LocalCoordinates.of(lowered)
    state = np.concatenate([local.restored(state[:n]), state[n:]])
    count = len(local.names)
    own, places = np.ones(count), np.arange(count)
    own[local.flat[1]] = scale[local.flat[0]]
    if size > n:
        x = np.concatenate([state[:n], np.zeros(size + 1 - n)])
        rows = np.delete(constraint_jacobian(lowered, x).toarray(), local.inner, axis=0) @ local.basis(state[:n])
        free = null_space(rows * own) if len(rows) else np.eye(count)
        preferred = np.where(np.array(local.kinds) == ANGLE, _ANGLES_FIRST, 1.0)
        decomposed = qr((free * preferred[:, None]).T, mode="economic", pivoting=True)
        order = cast(tuple[np.ndarray, np.ndarray, np.ndarray], decomposed)[2]
        places = np.sort(order[: free.shape[1]])
        if like is not None:
            known = like.places[: len(like.places) // 2]
            if len(known) == len(places) and _least(free[known]) > _WELL * _least(free[places]):
                places = known
    units = [_unit(local.kinds[place]) for place in places]
    chosen = np.concatenate([places, count + places])
    offsets, reach = np.zeros(2 * count), np.full(2 * count, np.inf)
    rotated = local.rotations.ravel()
    offsets[rotated] = local.positions(local.restored(np.real(lowered.x[:n])), state[:n])[rotated]
    reach[rotated] = np.pi
    read = partial(_numbers, local, state[:n], chosen)
    return StateChart(
        (*(local.names[place] for place in places), *(local.rate_names[place] for place in places)),
        (*units, *(f"{unit}/s" for unit in units)),
        chosen, state, read(state), np.tile(own[places], 2), offsets[chosen], reach[chosen], read, turning=turning,
    )  # fmt: skip


def _all(states: np.ndarray) -> np.ndarray:
    return states


def _numbers(local: LocalCoordinates, near: np.ndarray, places: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Local coordinates relative to coordinates ``near`` (n,), and rates, of whole states (..., 2n + turning)."""
    x, v = states[..., : len(near)], states[..., len(near) : 2 * len(near)]
    return np.concatenate([local.positions(near, x), local.rates(x, v)], axis=-1)[..., places]


def _least(rows: np.ndarray) -> float:
    """Smallest singular value: how well the coordinates of these rows determine the others."""
    return float(np.linalg.svd(rows, compute_uv=False).min(initial=np.inf))


def _unit(kind: str) -> str:
    return {POSITION: "m", ANGLE: "rad", DISPLACEMENT: "m"}.get(kind, "")


@dataclass(frozen=True, eq=False)
class Completion:
    """How the dependent coordinates of a state follow from the chosen ones. ``dependent``: local coordinates that
    follow; ``local`` (local,): values where the joints are closed; ``inverse``, ``of_rates``: inverses there of the
    derivatives of the joints' constraints by the dependent coordinates, and of their rates by the dependent rates.
    """

    chart: StateChart
    coordinates: LocalCoordinates
    dependent: np.ndarray
    local: np.ndarray
    inverse: np.ndarray
    of_rates: np.ndarray

    @classmethod
    def at(cls, lowered: Lowered, chart: StateChart, numbers: np.ndarray) -> "Completion":
        """Solve the joints' constraints for the dependent coordinates near the chart's state, by Newton's method."""
        n, size = lowered.structure.n, lowered.structure.size
        own, half = LocalCoordinates.of(lowered), len(chart.places) // 2
        near = chart.near[:n]
        local = own.positions(near, near)
        local[chart.places[:half]] = numbers[:half]
        dependent = np.setdiff1d(np.arange(len(local)), chart.places[:half])
        if size - n == len(own.inner):
            return cls(chart, own, dependent, local, np.zeros((0, 0)), np.zeros((0, 0)))
        still, extent = np.zeros(size + 1), scales(lowered).max()
        for _ in range(_MOST_ITERATIONS):
            x = np.concatenate([own.moved(near, local), np.zeros(size + 1 - n)])
            rows = np.delete(constraint_jacobian(lowered, x).toarray(), own.inner, axis=0)
            inverse = _inverse(rows @ own.slopes(near, local)[:, dependent])
            step = -inverse @ np.delete(residual(lowered, lowered.real, x, still, still)[n:], own.inner)
            longest = np.abs(step).max(initial=0.0)
            if not np.isfinite(longest):
                break
            local[dependent] += step * min(1.0, 0.5 * extent / (longest + 1e-300))
            if longest <= _CLOSED * extent:
                return cls(chart, own, dependent, local, inverse, _inverse(rows @ own.basis(x[:n])[:, dependent]))
        raise SolveError("a segment cannot begin: its joints do not close at the state; give more segments")

    def applied(self, lowered: Lowered, numbers: np.ndarray) -> Lowered:
        """Return arrays that begin at these numbers, whose real part the completion is for; with their derivatives."""
        n, size, half = lowered.structure.n, lowered.structure.size, len(self.chart.places) // 2
        complex_state = lowered.is_complex or bool(lowered.callbacks) or np.iscomplexobj(numbers)
        own, near = self.coordinates, self.chart.near[:n]
        local = self.local.astype(complex if complex_state else float)
        rates = own.rates(near, self.chart.near[n : 2 * n]).astype(local.dtype)
        local[self.chart.places[:half]] = numbers[:half]
        rates[self.chart.places[:half]] = numbers[half:]
        tail, still = np.zeros(size + 1 - n), np.zeros(size + 1, dtype=local.dtype)
        model = lowered.complex_model if complex_state else lowered.real
        x = np.concatenate([own.moved(near, local), tail])
        if complex_state and len(self.inverse):  # linear: once for the derivative
            wrong = residual(lowered, model, x, still, still)[n:]
            local[self.dependent] -= self.inverse @ np.delete(wrong, own.inner)
            x = np.concatenate([own.moved(near, local), tail])
        basis = own.basis(x[:n])
        v = np.concatenate([basis @ rates, tail])
        for _ in range(2 * (len(self.inverse) > 0)):  # once for the value, once for its derivative
            wrong = constraint_rates(lowered, model, x, v, still)[0]
            rates[self.dependent] -= self.of_rates @ np.delete(wrong, own.inner)
            v = np.concatenate([basis @ rates, tail])
        return replace(lowered, x=x, v=v)


def _inverse(matrix: np.ndarray) -> np.ndarray:
    return np.linalg.pinv(matrix, rcond=1e-10)


@dataclass(frozen=True)
class MotionSegment(MotionModel):
    """A segment of a mechanism's motion as a forward model. ``begin``: time of the signals at the beginning of the
    segment, s; ``times`` (samples,): s, from that beginning. Parameters behind those of ``model`` are the numbers of
    the state by the ``chart``; without one the segment begins as the model's builder says. Channels behind those of the
    model are the numbers by the chart ``ends``.
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
        wide = np.minimum(_REACH * self.chart.scales, self.chart.reach)
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

    def _read(self, lowered: Lowered, model: BlockModel, states: Any, turns: np.ndarray | None = None) -> np.ndarray:
        """Channels of the model and numbers of the state, (samples, channels)."""
        n = lowered.structure.n
        if turns is not None and self.chart is not None and turns.size:
            turns = turns + self._begun(lowered, self.chart.near)
        values = super()._read(lowered, model, states, turns)
        if self.ends is None:
            return values
        numbers = self.ends.read(np.concatenate([part[:, :n] for part in states[:2]], axis=1))
        if self.ends.whole:
            count = len(self.ends.turning)
            counted = np.zeros((len(values), count)) if turns is None or not count else turns
            numbers = np.concatenate([numbers, counted], axis=1)
        return np.concatenate([values, numbers], axis=1)

    def _begun(self, lowered: Lowered, near: np.ndarray) -> np.ndarray:
        """Whole turns (turning,) of the angles at the start, with which they are near those of the chart."""
        n, observer = lowered.structure.n, self.model.observer
        x, v = (np.tile(np.real(part), (2, 1)) for part in (lowered.x, lowered.v))
        x[0, :n], v[0, :n] = near[:n], near[n : 2 * n]
        angles = observer.read(lowered, lowered.real, (x, v, np.zeros_like(x)), np.zeros(2))[:, observer.turning]
        return near[2 * n :] + np.round((angles[0] - angles[1]) / (2.0 * np.pi))
