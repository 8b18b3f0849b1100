"""Descents, profiles and linearisations that workers of a cluster on the loopback compute before they are asked."""

import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError
from dalembert.forward import PythonModel, ensembles, prefetch, prefetched
from dalembert.forward.cluster import Received, Sender, packed
from dalembert.study import RunFolder, load, run_study
from dalembert.threads import with_threads
from faults.kills import content, kinds
from loopback_cluster import QUIET

TIMES = np.linspace(0, 10, 41)


def swung(rate, damping):
    return np.exp(-damping * TIMES) * np.cos(rate * TIMES)


@pytest.fixture
def here(tmp_path):
    """A file that grows by a byte whenever this process computes."""
    return tmp_path / str(os.getpid())


@pytest.fixture
def model(here):
    """It fails far from where the data are from."""
    here.touch()
    folder = here.parent

    def swing(rate, damping):
        with (folder / str(os.getpid())).open("a") as computed:
            computed.write("x")
        if np.real(rate) > 7.5:
            raise RuntimeError("too fast")
        return swung(rate, damping)

    return PythonModel(swing, {"rate": (0.5, 8.0), "damping": (0.0, 0.5)}, ["x"], TIMES)


@pytest.fixture
def data():
    noise = np.random.default_rng(3).normal(0, 0.02, TIMES.shape)
    return da.Measurements.of(TIMES, {"x": swung(6.3, 0.05) + noise}, deviations=0.02)


def test_starts_go_there_with_the_same_bits_and_events(client, model, data, here):
    events, computed = ([], []), []

    def note(event):
        events[1].append(event)
        computed.append((type(event).__name__, here.stat().st_size))

    one = da.identify(model, data, start=[2.0, 0.3], starts=4, on_event=events[0].append)
    other = da.identify(model, data, start=[2.0, 0.3], starts=4, on_event=note, executor=client)
    assert len(one.starts) > 2
    assert repr(events[0]) == repr(events[1])
    assert other.to_xarray().drop_attrs().identical(one.to_xarray().drop_attrs())
    assert other.values.tobytes() == one.values.tobytes()
    screened = next(row for row, (name, _) in enumerate(computed) if name == "Screened")
    ended = [count for name, count in computed[screened:] if name in ("Screened", "StartEnd")]
    assert ended[0] == ended[len(one.starts) - 2] < ended[-1]  # the polish alone is computed here


def test_profiles_go_there_with_the_same_bits_and_events(client, model, data):
    fit, events = da.identify(model, data, start=[6.2, 0.1]), ([], [])
    one = da.profile(model, data, fit, on_event=events[0].append)
    other = da.profile(model, data, fit, on_event=events[1].append, executor=client)
    assert repr(events[0]) == repr(events[1])
    assert other.to_xarray().identical(one.to_xarray())


def test_several_experiments_are_prefetched_each_from_its_own_model(client, model, data):
    experiments = [da.Experiment("a", model, data), da.Experiment("b", model.first(21), data.first(21))]
    one, other = (
        da.identify(experiments, start=[2.0, 0.3], starts=3, executor=executor) for executor in (None, client)
    )
    assert len(one.starts) > 1
    assert other.values.tobytes() == one.values.tobytes()
    assert other.simulations == one.simulations


def test_shots_go_there_with_the_same_bits(client):
    def swing(rate, place, speed):
        along = rate * TIMES
        moved, moving = (
            place * np.cos(along) + speed / rate * np.sin(along),
            speed * np.cos(along) - rate * place * np.sin(along),
        )
        return np.stack([moved, moving], axis=1)

    model = PythonModel(swing, {"rate": (1.0, 9.0), "place": (-1.0, 1.0), "speed": (-9.0, 9.0)}, ["x", "v"], TIMES)
    data = da.Measurements.of(TIMES, {"x": 0.5 + 0.4 * np.cos(6.3 * TIMES)}, deviations=1e-3)  # explained by none
    states = {"place": da.ShootingState("x", -1.5, 1.5), "speed": da.ShootingState("v", -10.0, 10.0)}
    shooting = da.MultipleShooting(states, segments=4)
    one, other = (da.identify(model, data, shooting=shooting, executor=executor) for executor in (None, client))
    assert len(one.starts) == 3
    assert other.values.tobytes() == one.values.tobytes()
    assert [repr(start) for start in other.starts] == [repr(start) for start in one.starts]


def test_starts_of_a_minimiser_go_there_with_the_same_bits_and_events(client, model, data, here):
    events, asked = ([], []), dict(method="Nelder-Mead", starts=3, start=[6.0, 0.2])
    one, before = da.identify(model, data, **asked, on_event=events[0].append), here.stat().st_size
    other = da.identify(model, data, **asked, on_event=events[1].append, executor=client)
    assert len(one.starts) == 3
    assert repr(events[0]) == repr(events[1])
    assert other.values.tobytes() == one.values.tobytes()
    assert here.stat().st_size - before < before / 10


def test_gradients_of_a_search_for_bounds_go_there(client, model, here):
    box = {"rate": (6.0, 6.5), "damping": (0.05, 0.1)}
    one, before = da.propagate(model, box, "optimise"), here.stat().st_size
    other = da.propagate(model, box, "optimise", executor=client)
    assert (other.lower.tobytes(), other.upper.tobytes()) == (one.lower.tobytes(), one.upper.tobytes())
    assert other.runs == one.runs
    assert here.stat().st_size - before < before / 4


def linearised(model, vector):
    return model.linearise(vector)


def test_failures_come_as_they_are_here(client, model):
    vectors = [np.array([rate, 0.1]) for rate in (7.0, 7.6)]
    told = []
    for placed in (model, da.on_cluster(model, client)):
        for vector in prefetched(placed, linearised, vectors):
            try:
                told.append(linearised(placed, vector)[1].tobytes())
            except da.SolveError as error:
                told.append(str(error))
    assert told[:2] == told[2:]
    assert told[1].startswith("RuntimeError: too fast (test_prefetch.py, line ")


def test_a_model_that_cannot_be_differentiated_is_refused_as_here(client):
    model = da.on_cluster(PythonModel(lambda rate: rate.real * TIMES, {"rate": (0.1, 2.0)}, ["x"], TIMES), client)
    asked = prefetched(model, linearised, [np.array([1.0]), np.array([2.0])])
    with closing(asked), pytest.raises(InputError, match="drops the imaginary part of its parameters"):
        linearised(model, next(asked))


@pytest.mark.slow  # of batches, `make test` has the same in test_distributed
def test_a_worker_that_is_killed_costs_a_retry(client, started, data):
    def slow(rate, damping):
        time.sleep(0.01)
        return swung(rate, damping)

    model = PythonModel(slow, {"rate": (0.5, 8.0), "damping": (0.0, 0.5)}, ["x"], TIMES)
    fit = da.identify(model, data, start=[6.2, 0.1], starts=1)
    lost = started.worker()
    client.wait_for_workers(3, timeout=60)
    with ThreadPoolExecutor(1) as pool:
        asked = pool.submit(da.profile, model, data, fit, points=4, executor=client)
        time.sleep(0.5)
        assert not asked.done()
        lost.kill()
        there = asked.result(timeout=120)
    assert there.to_xarray().identical(da.profile(model, data, fit, points=4).to_xarray())


def test_what_is_no_longer_wanted_is_taken_from_the_cluster(client, model):
    slowly = da.on_cluster(model, client)

    def work(model, vector):
        model.linearise(vector)
        time.sleep(0.2)

    items = prefetched(slowly, work, [np.array([rate, 0.1]) for rate in np.linspace(1, 2, 40)])
    next(items)
    assert slowly.prefetched
    items.close()
    assert not slowly.prefetched
    end = time.monotonic() + 5
    while any(client.processing().values()):
        assert time.monotonic() < end, "40 items take 4 s"
        time.sleep(0.05)


def test_what_a_checkpoint_knows_is_not_sent(client, model, here, tmp_path):
    vectors = [np.array([rate, 0.1]) for rate in (1.0, 2.0, 7.6)]
    path = tmp_path / "checkpoint"
    with da.Checkpoint(path) as checkpoint:
        recorded = da.Recorded(model, checkpoint)
        first = recorded.linearise(vectors[0])
    before = here.stat().st_size
    with da.Checkpoint(path) as checkpoint:
        there = da.on_cluster(da.Recorded(model, checkpoint), client)
        held = []
        for vector in prefetched(there, linearised, vectors):
            held.append(len(there.model.prefetched))
            if vector[0] < 7.5:
                linearised(there, vector)
        assert held == [0, 1, 1]
        spared = checkpoint.spared
        assert there.linearise(vectors[0])[1].tobytes() == first[1].tobytes()
        assert checkpoint.spared == spared > 0
    assert here.stat().st_size == before


def test_sums_are_ordered_on_a_worker_as_they_are_here(model):
    numbers = np.random.default_rng(0).standard_normal(100_000)

    def work(model, numbers):
        model.linearise(np.array([1.0, numbers @ numbers * 1e-9]))

    for number in (1, 2):
        answers = {}
        answering = prefetch._Answering(model, answers)
        with with_threads(number):
            wanted = np.array([1.0, numbers @ numbers * 1e-9])
            sender = Sender()
        asked_there = Received(packed(partial(prefetch._answers, packed((work, answering, [answers])))))
        ((asked,),) = ensembles._done(asked_there, numbers, sender)
        assert asked == ("linearise", len(TIMES), wanted.tobytes())
    assert not answers


STUDY = """
[study]
title = "Several starts"
[parameters]
rate = { lower = 0.5, upper = 8.0, start = 2.0 }
damping = { lower = 0.0, upper = 0.5, start = 0.3 }
[model]
forward = "swing.py:swing"
[data]
file = "measured.csv"
columns = { x = "x" }
deviations = { x = 0.02 }
[identify]
starts = 6
"""
MODEL = """
import time
import numpy as np
from dalembert.forward import PythonModel

TIMES = np.linspace(0, 10, 41)

def swing(parameters):
    return PythonModel(response, parameters, ["x"], TIMES)

def response(rate, damping):
    time.sleep(0.003)
    return np.exp(-damping * TIMES) * np.cos(rate * TIMES)
"""


SWEEP = """
[parameters]
rate = { lower = 0.5, upper = 8.0, start = 2.0 }
damping = { lower = 0.0, upper = 0.5, start = 0.3 }
[model]
forward = "swing.py:swing"
[sweep]
at = 2.5
channels = ["x"]
over = { rate = { count = 9 }, damping = [0.1, 0.2] }
"""


@pytest.mark.slow
def test_sensitivities_of_a_sweep_go_there(client, tmp_path):
    (tmp_path / "swing.py").write_text(MODEL)
    (tmp_path / "study.toml").write_text(SWEEP)
    study = load(tmp_path / "study.toml")
    (here, _), (there, _) = (
        run_study(study, tmp_path / name, executor=executor) for name, executor in (("here", None), ("there", client))
    )
    assert content(there.result) == content(here.result)
    assert kinds(there) == kinds(here)


@pytest.mark.slow
@pytest.mark.parametrize(("event", "there"), [("start-ended", False), ("profiled", True)])
def test_a_run_that_is_killed_in_the_midst_goes_on_there_or_here(started, client, data, tmp_path, event, there):
    (tmp_path / "swing.py").write_text(MODEL)
    (tmp_path / "study.toml").write_text(STUDY + f"profile = {str(event == 'profiled').lower()}\n")
    rows = [f"{time!r},{value!r}" for time, value in zip(TIMES.tolist(), data.values[:, 0].tolist(), strict=True)]
    (tmp_path / "measured.csv").write_text("\n".join(["t,x", *rows]))
    folder, _ = run_study(load(tmp_path / "study.toml"), tmp_path / "undisturbed")
    killed, events = tmp_path / "killed", tmp_path / "killed" / "events.jsonl"
    command, on = Path(sys.executable).with_name("dalembert"), ["--cluster", started.address]
    with subprocess.Popen([command, "run", tmp_path / "study.toml", "--out", killed, *on], **QUIET) as run:
        while not (events.is_file() and events.read_text().count(f'"{event}"') >= 2):
            assert run.poll() is None
            time.sleep(0.01)
        run.kill()
    assert not (killed / "result.nc").is_file()
    subprocess.run([command, "resume", killed, *on[: 2 * there]], check=True, **QUIET)
    assert kinds(RunFolder(killed)) == kinds(folder)
    for name in ["result.nc", "profiles.nc"][: 1 + (event == "profiled")]:
        assert content(killed / name) == content(folder.path / name)
