"""Adjoint of the channels: from cotangents of a response to those of the states, and gradients by numbers."""

import numpy as np

from dalembert.errors import InputError
from dalembert.multibody.adjoint.numbers import NumberGradient, readers
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.observe import Observer, OutputBlock, beside, columns_of


def refuse_energies(observer: Observer) -> None:
    """Raise for channels of the whole system, which have no adjoint."""
    for channel, row in zip(observer.channels, observer.rows, strict=True):
        if row.kind is None:
            raise InputError(
                f"the adjoint has no derivative of the channel {channel.name!r}, an energy of the whole system. "
                "Read channels of points and components, or take derivative='direct'"
            )


def pull_readings(
    gradient: NumberGradient, model: BlockModel, states: MotionState, times: np.ndarray, cotangent: np.ndarray,
    signal_bars: np.ndarray,
) -> MotionState:  # fmt: skip
    """Return the cotangents of sampled states (samples, N + 1), and add to the gradient by numbers of channels.
    ``model``: in complex numbers without imaginary parts; ``times`` (samples,): s; ``cotangent`` (samples, channels);
    ``signal_bars`` (samples, signals, 3): adjoints of the signals at each sample, added to.
    """
    bars = MotionState(*(np.zeros_like(states.x) for _ in range(4)))
    rows = gradient.observer.rows
    for kind in dict.fromkeys(row.kind for row in rows):
        assert kind is not None
        chosen = [number for number, row in enumerate(rows) if row.kind is kind]
        weights = np.zeros((len(cotangent), len(chosen), len(kind.outputs)))
        for place, number in enumerate(chosen):
            weights[:, place, rows[number].output] = cotangent[:, number]
        _pull_kind(gradient, kind, chosen, model, states, times, weights, bars, signal_bars)
    for part in bars:
        part[:, -1] = 0.0  # of absent unknowns
    return bars


def _pull_kind(
    gradient: NumberGradient, kind: Kind, chosen: list[int], model: BlockModel, states: MotionState, times: np.ndarray,
    weights: np.ndarray, bars: MotionState, signal_bars: np.ndarray,
) -> None:  # fmt: skip
    """The channels of one kind: their local unknowns one after the other, for all samples and channels at once."""
    rows = [gradient.observer.rows[number] for number in chosen]
    index, integers = columns_of(rows)
    count, width = index.shape
    numbers = np.real(np.array([row.numbers(gradient.lowered) for row in rows])).astype(complex)
    own = np.arange(count * width, dtype=np.int64).reshape(count, width)
    block, stamps = OutputBlock(kind, own, integers, numbers), times if kind.observes_inputs else times[:0]
    local = [np.zeros((len(times), count * width + 1), complex) for _ in range(3)]
    for part, whole in zip(local, states[:3], strict=True):
        part[:, :-1] = whole[:, index.ravel()]

    def slopes() -> np.ndarray:
        """Change of the weighed outputs along the imaginary step, (samples, channels)."""
        return np.sum(weights * np.imag(block.read(model, local, stamps)), axis=2) / STEP

    for part, bar in zip(local, bars[:3], strict=True):
        for j in range(width):
            part[:, j:-1:width] += 1j * STEP
            np.add.at(bar.T, index[:, j], slopes().T)
            part[:, j:-1:width] = np.real(part[:, j:-1:width])
    active = np.array([_active(gradient, number) for number in chosen])
    for column in np.flatnonzero(active.any(axis=0)):
        numbers[:, column] += 1j * STEP
        for number, slope in zip(chosen, slopes().sum(axis=0), strict=True):
            _number_part(gradient, number)[column] += slope
        numbers[:, column] = np.real(numbers[:, column])
    if kind.observes_inputs:
        # Adjoints of the signals that channels read, sample by sample.
        signals = np.unique(readers(integers, gradient.active_signals)[:, 1])
        out = np.zeros(weights.shape[1:], complex)
        call = model.call().set(last=local[0].shape[1] - 1, r=out)
        for sample, (t, within) in enumerate(zip(times, beside(times, -1), strict=True)):
            x, v, a = (part[sample] for part in local)
            model.evaluate(call.set(x=x, v=v, a=a), float(t), float(within))
            for s in signals:
                for rate in range(3):
                    call.signals[s, rate] += 1j * STEP
                    block.kernel(call.address, block.address)
                    call.signals[s, rate] = call.signals[s, rate].real
                    signal_bars[sample, s, rate] += np.sum(weights[sample] * np.imag(out)) / STEP


def _active(gradient: NumberGradient, number: int) -> np.ndarray:
    row = gradient.observer.rows[number]
    if isinstance(row.source, tuple):
        return gradient.active_point(number)
    assert row.kind is not None
    return gradient.active_kind(row.kind)[row.source]


def _number_part(gradient: NumberGradient, number: int) -> np.ndarray:
    row = gradient.observer.rows[number]
    if isinstance(row.source, tuple):
        return gradient.point(number)
    assert row.kind is not None
    return gradient.kind(row.kind)[row.source]
