"""Methods that use their runs batch by batch keep what they made of them, not the responses."""

import sqlite3
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest

import dalembert as da
from dalembert.forward import Checkpoint, PythonModel, Recorded
from dalembert.forward import checkpoint as checkpoint_module
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


def test_responses_that_are_soon_used_are_never_written(tmp_path, monkeypatch, model):
    """Where a run ends before anything is written, the file has a summary of each half of the sampling."""
    undisturbed = bounds(model, [], MonteCarlo(runs=SAMPLES))
    monkeypatch.setattr(checkpoint_module, "EVERY", np.inf)
    statements = []
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        checkpoint._file.set_trace_callback(statements.append)
        assert bounds(Recorded(model, checkpoint), [], MonteCarlo(runs=SAMPLES)) == undisturbed
        assert not any(text.startswith(("INSERT", "DELETE")) for text in statements)
    with closing(sqlite3.connect(tmp_path / "checkpoint")) as file:
        assert file.execute("SELECT count(*) FROM results").fetchone() == (2,)


PARTICLES = 12
SWARMS = {
    "particles": da.ParticleSwarm(particles=PARTICLES, iterations=8),
    "improved": da.ImprovedParticleSwarm(particles=PARTICLES, iterations=8),
    "differential evolution": da.Minimiser("differential_evolution"),
}
DATA = da.Measurements.of(TIMES, {name: np.exp(-0.7 * TIMES) + 0.3 * k for k, name in enumerate(CHANNELS)})


def joined(one):
    """Two experiments with one model, which share a parameter."""
    return [da.Experiment("first", one, DATA), da.Experiment("second", one, DATA, local=["shift"])]


def searched(model, events, method, **options):
    data = None if isinstance(model, list) else DATA
    fit = da.identify(model, data, method=method, seed=3, on_event=events.append, **options)
    events[:] = [repr(event) for event in events]
    return fit.values.tobytes(), fit.misfit, fit.history.tobytes() if hasattr(fit.history, "tobytes") else fit.history


@pytest.mark.parametrize("options", [{}, {"loss": "huber", "loss_scale": 0.5}], ids=["squares", "huber"])
@pytest.mark.parametrize("name", SWARMS)
def test_a_stopped_swarm_ends_with_the_same_bits_and_events(tmp_path, simulations, model, name, options):
    method, expected, events = SWARMS[name], [], []
    if name == "differential evolution":
        method = replace(method, options={"maxiter": 4, "popsize": 5, "polish": False})
    undisturbed = repr(searched(model, expected, method, **options))
    total, simulations.count = simulations.count, 0
    for stop in (1, 3 * PARTICLES + 5):
        simulations.last = simulations.count + stop
        with pytest.raises(KeyboardInterrupt), Checkpoint(tmp_path / "checkpoint") as checkpoint:
            searched(Recorded(model, checkpoint), events, method, **options)
        events.clear()
        # the responses of the swarm at work and the first of all; of each swarm before, its misfit
        assert (tmp_path / "checkpoint").stat().st_size < 1.1 * (64 + 2) * SIZE + 100_000
    simulations.last = np.inf
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        assert repr(searched(Recorded(model, checkpoint), events, method, **options)) == undisturbed
    assert events == expected
    assert simulations.count <= total + 2 * 64


def test_swarms_of_several_experiments_keep_their_misfit(tmp_path, model):
    expected, events = [], []
    undisturbed = repr(searched(joined(model), expected, SWARMS["particles"]))
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        assert repr(searched(joined(Recorded(model, checkpoint)), events, SWARMS["particles"])) == undisturbed
    assert events == expected
    size = (tmp_path / "checkpoint").stat().st_size
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        again = repr(searched(joined(Recorded(model, checkpoint)), events := [], SWARMS["particles"]))
    assert again == undisturbed
    assert events == expected
    assert size < 8 * PARTICLES * SIZE


def test_a_checkpoint_of_other_data_is_not_used(tmp_path, model):
    """The misfit belongs to the data, weights and loss that it was computed with."""
    other = da.Measurements.of(TIMES, {name: np.exp(-1.5 * TIMES) for name in CHANNELS})
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        recorded = Recorded(model, checkpoint)
        for data, options in [
            (DATA, {}),
            (other, {}),
            (DATA, {"loss": "huber", "loss_scale": 0.5}),
            (DATA, {"weights": [2.0] + 5 * [1.0]}),
        ]:
            fits = [da.identify(one, data, method=SWARMS["particles"], seed=3, **options) for one in (recorded, model)]
            assert fits[0].misfit == fits[1].misfit
