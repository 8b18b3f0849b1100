"""Methods that use their runs batch by batch keep what they made of them, not the responses."""

from dataclasses import replace

import numpy as np
import pytest

import dalembert as da
from dalembert.forward import Checkpoint, PythonModel, Recorded
from dalembert.uncertainty import MonteCarlo, Scan
from dalembert.uncertainty.samplings import BATCH

TIMES = np.linspace(0, 1, 200)
CHANNELS = list("abcdef")
INTERVALS = {"rate": (0.1, 2.0), "shift": (-1.0, 1.0)}
SAMPLES = 5 * BATCH
SIZE = 8 * len(TIMES) * len(CHANNELS)
"""Bytes of a response."""


class Simulations:
    """Decays that fail at some rates, counted; the user stops them after a number."""

    def __init__(self) -> None:
        self.count, self.last = 0, np.inf

    def __call__(self, rate: float, shift: float) -> np.ndarray:
        if self.count >= self.last:
            raise KeyboardInterrupt
        self.count += 1
        if 1.0 < np.real(rate) < 1.02:
            raise RuntimeError("resonance")
        return np.exp(-rate * TIMES)[:, None] + shift * np.arange(6)


@pytest.fixture
def simulations():
    return Simulations()


@pytest.fixture
def model(simulations):
    return PythonModel(simulations, INTERVALS, CHANNELS, TIMES)


def bounds(model, events, method):
    result = da.propagate(model, INTERVALS, method, on_event=events.append)
    return {name: np.asarray(value).tobytes() for name, value in vars(result).items() if isinstance(value, np.ndarray)}


def untimed(events):
    return [replace(event, seconds=0.0) if hasattr(event, "seconds") else event for event in events]


@pytest.mark.parametrize("method", [MonteCarlo(runs=SAMPLES), Scan(points_each=25)])
@pytest.mark.parametrize("stops", [(300,), (1, 2 * BATCH, 70)])
def test_a_stopped_sampling_ends_with_the_same_bits_and_events(tmp_path, simulations, model, method, stops):
    expected, events = [], []
    undisturbed = bounds(model, expected, method)
    total, simulations.count = simulations.count, 0
    for stop in stops:
        simulations.last = simulations.count + stop
        try:
            with Checkpoint(tmp_path / "checkpoint") as checkpoint:
                found = bounds(Recorded(model, checkpoint), events, method)
        except KeyboardInterrupt:
            events.clear()
            # the responses of the batch at work, and the smallest and largest values with their points
            assert (tmp_path / "checkpoint").stat().st_size < 1.1 * (BATCH * SIZE + 6 * SIZE) + 100_000
    simulations.last = np.inf
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        events.clear()
        found = bounds(Recorded(model, checkpoint), events, method)
    assert found == undisturbed
    assert untimed(events) == untimed(expected)
    # of a batch, at most 64 simulations at work are lost
    assert simulations.count <= total + 64 * len(stops)


def test_the_checkpoint_does_not_grow_with_the_samples(tmp_path, model):
    sizes = []
    for runs in (2 * BATCH, SAMPLES):
        path = tmp_path / str(runs)
        with Checkpoint(path) as checkpoint:
            da.propagate(Recorded(model, checkpoint), INTERVALS, MonteCarlo(runs=runs))
        sizes.append(path.stat().st_size)
    assert sizes[1] < 1.1 * sizes[0] < SAMPLES * SIZE / 3
