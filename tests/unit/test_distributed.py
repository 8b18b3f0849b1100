"""Batches on a Dask cluster: a real scheduler and real workers, as processes on the loopback."""

import pickle
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import ClusterError, InputError
from dalembert.forward import distributed, takes_executor
from dalembert.forward.builders import cores
from dalembert.forward.cluster import Sender, _received, packed
from dalembert.structure import lumped
from dalembert.study import RunFolder, load, run_study
from dalembert.uncertainty import MonteCarlo
from dalembert.versions import versions
from faults.kills import content, kinds
from faults.slow_runs import written
from flexible_pendulum import tip
from loopback_cluster import QUIET, cluster
from study_texts import SLIDER
from support import says

TIMES = np.linspace(0, 1, 11)
OTHER_SCIPY = "__import__('dalembert.versions').versions.versions().update(scipy='1.0')"


def slowly(rate):
    time.sleep(0.05)
    if rate > 1.9:
        raise RuntimeError("too fast")
    return np.exp(-rate * TIMES)


@pytest.fixture
def decay():
    return da.PythonModel(slowly, {"rate": (0.1, 2.0)}, ["x"], TIMES)


def test_a_mechanism_answers_the_same_bits(client):
    model = tip({"theta1": (0.6, 1.0), "theta2": (0.4, 0.65)}, end=0.5)
    low, high = model.parameters.lower, model.parameters.upper
    vectors = low + np.random.default_rng(0).random((24, len(low))) * (high - low)
    here, there = model.evaluate(vectors), da.on_cluster(model, client).evaluate(vectors)
    assert there.values.tobytes() == here.values.tobytes()
    assert there.failures == here.failures == (None,) * 24


def test_a_failed_sample_is_marked_and_the_others_return(client, decay):
    vectors = np.linspace(0.1, 2.0, 12)[:, None]
    here, there = decay.evaluate(vectors), da.on_cluster(decay, client).evaluate(vectors)
    assert there.failures == here.failures
    line = slowly.__code__.co_firstlineno + 3
    assert here.failures[-1] == f"RuntimeError: too fast (test_distributed.py, line {line})"
    np.testing.assert_array_equal(there.values, here.values)


def test_a_worker_with_another_dalembert_is_refused(tmp_path, decay):
    """A checkout of the same version with one other source file."""
    shutil.copytree(Path(da.__file__).parent, tmp_path / "src" / "dalembert", ignore=shutil.ignore_patterns("*.pyc"))
    with (tmp_path / "src" / "dalembert" / "units.py").open("a") as file:
        file.write("# another copy\n")
    written(tmp_path, "[propagate]\nmethod = { kind = 'monte-carlo', runs = 8 }\n")
    wanted = f"a worker of the cluster has dalembert {da.__version__} with other source files"
    with cluster(workers=0) as other:
        other.worker(tmp_path / "src")
        with pytest.raises(ClusterError, match=wanted):
            run_study(load(tmp_path / "slow.toml"), tmp_path / "run", executor=other.address)
        with pytest.raises(ClusterError, match=wanted):
            da.propagate(decay, {"rate": (0.5, 1.0)}, MonteCarlo(runs=4), executor=other.address)


def test_other_packages_of_workers_are_noted(client, tmp_path):
    written(tmp_path, "[propagate]\nmethod = { kind = 'monte-carlo', runs = 8 }\n")
    client.run(eval, OTHER_SCIPY)
    folder, outcome = run_study(load(tmp_path / "slow.toml"), tmp_path / "run", executor=client)
    client.run(versions.cache_clear)
    (finding,) = [finding for finding in outcome.findings if finding.code == "mixed-versions"]
    assert finding.values == {"package": "scipy", "versions": f"{versions()['scipy']}, 1.0"}
    assert len(folder.computed_with()) == 2


def test_packages_of_workers_that_come_later_are_noted(client, tmp_path):
    """The versions are others from the first batch on, as those of a worker that replaces a lost one may be."""
    written(tmp_path, "[propagate]\nmethod = { kind = 'monte-carlo', runs = 400 }\n")
    replaced = []

    def listen(event):
        if event["event"] == "ran" and not replaced:
            replaced.append(client.run(eval, OTHER_SCIPY))

    folder, outcome = run_study(load(tmp_path / "slow.toml"), tmp_path / "run", listener=listen, executor=client)
    client.run(versions.cache_clear)
    (finding,) = [finding for finding in outcome.findings if finding.code == "mixed-versions"]
    assert finding.values == {"package": "scipy", "versions": f"{versions()['scipy']}, 1.0"}
    assert len(folder.computed_with()) == 2


def test_other_packages_of_workers_are_a_warning_of_methods(client, decay):
    client.run(eval, OTHER_SCIPY)
    with pytest.warns(
        RuntimeWarning, match=r"^a worker of the cluster has scipy 1\.0, not .* as here: the last digits"
    ):
        da.propagate(decay, {"rate": (0.5, 1.0)}, MonteCarlo(runs=8), executor=client)
    client.run(versions.cache_clear)
    da.propagate(decay, {"rate": (0.5, 1.0)}, MonteCarlo(runs=8), executor=client)  # an earlier warning is not repeated


def test_a_worker_that_is_killed_costs_a_retry(client, started, decay):
    lost = started.worker()
    client.wait_for_workers(3, timeout=60)
    vectors = np.linspace(0.1, 1.8, 60)[:, None]
    model = da.on_cluster(decay, client)
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(1) as pool:
        asked = pool.submit(model.evaluate, vectors)
        time.sleep(0.3)
        assert not asked.done()
        lost.kill()
        there = asked.result(timeout=120)
    np.testing.assert_array_equal(there.values, decay.evaluate(vectors).values)


def test_methods_take_an_executor(client, started):
    decay = da.PythonModel(lambda rate: np.exp(-rate * TIMES), {"rate": (0.1, 2.0)}, ["x"], TIMES)
    here = da.propagate(decay, {"rate": (0.5, 1.0)}, "chebyshev")
    there = da.propagate(decay, {"rate": (0.5, 1.0)}, "chebyshev", executor=client)
    assert there.lower.tobytes() == here.lower.tobytes()
    data = da.Measurements.of(TIMES, {"x": np.exp(-0.7 * TIMES)})
    fits = [da.identify(decay, data, executor=executor) for executor in (None, client, started.address)]
    assert len({fit.values.tobytes() for fit in fits}) == 1
    swarm = da.ParticleSwarm(particles=6, iterations=5)
    sets = [da.identify(decay, data, method=swarm, seed=2, executor=executor) for executor in (None, client)]
    assert sets[0].values.tobytes() == sets[1].values.tobytes()


def test_a_model_in_use_goes_from_worker_to_worker(decay):
    received = _received(packed(decay), Sender())
    object.__setattr__(
        received.content, "lock", threading.Lock()
    )  # as caches of a model that computes: it cannot be pickled
    again = pickle.loads(pickle.dumps(received))
    vectors = np.array([[0.3]])
    np.testing.assert_array_equal(again.content.evaluate(vectors).values, decay.evaluate(vectors).values)


STUDY = """
[parameters]
rate = { lower = 0.1, upper = 2.0 }
[model]
forward = "decay.py:decay"
[propagate]
method = { kind = "monte-carlo", runs = 40 }
"""
MODEL = """
import numpy as np
from dalembert.forward import PythonModel
from beside import TIMES

def decay(parameters):
    return PythonModel(lambda rate: np.exp(-rate * TIMES), parameters, ["x"], TIMES)
"""


def test_a_study_with_files_of_its_own_runs_on_a_cluster(client, tmp_path, monkeypatch):
    (tmp_path / "decay.py").write_text(MODEL)
    (tmp_path / "beside.py").write_text("import numpy as np\nTIMES = np.linspace(0, 1, 5)\n")
    (tmp_path / "study.toml").write_text(STUDY)
    monkeypatch.delitem(sys.modules, "beside", raising=False)
    study = load(tmp_path / "study.toml")
    (_, here), (_, there) = (
        run_study(study, tmp_path / name, executor=own) for name, own in (("a", None), ("b", client))
    )
    assert here.result.lower.tobytes() == there.result.lower.tobytes()


def test_a_connection_ends_with_what_made_it(client, started):
    @takes_executor
    def method(executor=None):
        return executor

    own = method(executor=started.address)
    assert own.status == "closed"
    assert method(executor=client) is client
    assert client.status == "running"
    assert method() is None


def test_of_a_recorded_model_the_unknown_answers_come_from_the_cluster(client, decay, tmp_path):
    vectors = np.array([[0.5], [1.0]])
    with da.Checkpoint(tmp_path / "checkpoint") as checkpoint:
        recorded = da.on_cluster(da.Recorded(decay, checkpoint), client)
        assert recorded == da.Recorded(da.Distributed(decay, client), checkpoint) == da.on_cluster(recorded, client)
        there = recorded.evaluate(vectors).values
        assert da.Recorded(decay, checkpoint).evaluate(vectors).values.tobytes() == there.tobytes()
    assert there.tobytes() == decay.evaluate(vectors).values.tobytes()


def test_a_model_in_a_model_is_sent_without_what_it_computed(client):
    inner = tip({"theta1": (0.6, 1.0), "theta2": (0.4, 0.65)}, end=0.1)
    model = da.Sensors(inner, {inner.channels[0].name: da.Sensor(gain=(0.5, 2.0))})
    model.evaluate(np.array([[0.7, 0.5, 1.0]]))
    assert "shared" in vars(inner)
    sent = distributed.bare(model)
    assert "shared" not in vars(sent.model)
    assert (sent.model.workers, inner.workers) == (1, cores())


def test_an_address_without_a_scheduler(monkeypatch, decay):
    monkeypatch.setattr("dalembert.forward.cluster.WAIT", 0.2)
    with pytest.raises(InputError, match=r"no scheduler of Dask answers at 'tcp://127\.0\.0\.1:9' within 0\.2 s"):
        da.propagate(decay, {"rate": (0.5, 1.0)}, executor="tcp://127.0.0.1:9")


def test_a_model_takes_a_client_and_no_address(decay):
    sentence = (
        "on_cluster: 'tcp://10.0.0.1:8786' is an address; expected a client, as of: with "
        "distributed.Client('tcp://10.0.0.1:8786') as client; methods such as identify take an address, too, and "
        "disconnect when they end"
    )
    with pytest.raises(InputError, match=says(sentence)):
        da.on_cluster(decay, "tcp://10.0.0.1:8786")


def test_without_dask_it_says_what_to_install(monkeypatch, decay):
    monkeypatch.setitem(sys.modules, "distributed", None)
    sentence = "a cluster needs Dask, which is not installed; run: pip install 'dalembert[cluster]'"
    with pytest.raises(InputError, match=says(sentence)):
        da.propagate(decay, {"rate": (0.5, 1.0)}, executor="tcp://127.0.0.1:8786")


def test_a_model_that_cannot_be_sent(client, tmp_path):
    with (tmp_path / "log").open("w") as log:
        model = da.PythonModel(lambda rate: log.write("") + rate * TIMES, {"rate": (0.1, 2.0)}, ["x"], TIMES)
        with pytest.raises(InputError, match=r"the model cannot be sent to the cluster: .*must not hold open files"):
            da.on_cluster(model, client).evaluate(np.array([[1.0], [1.5]]))


def damped(preload: float) -> da.VibrationSystem:
    if preload == 7.0:
        raise RuntimeError("no seven")
    system = da.VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(da.HarmonicForce("m", 1.0))
    system.add(da.FrictionContact("damper", "m", friction=0.5, preload=preload, law=da.ElasticSlider(0.8)))
    return system


@pytest.mark.slow
def test_a_family_of_curves_goes_there_and_its_curves_are_kept(client, tmp_path):
    asked = (damped, "preload", [0.0, 2.0, 7.0, -1.0, 4.0], (0.12, 0.25), da.HarmonicBalance(3, samples=128))
    here, told = da.frequency_responses(*asked, stability=True), []
    with da.Checkpoint(tmp_path / "checkpoint") as checkpoint:
        options = dict(executor=client, checkpoint=checkpoint, stability=True)
        there = da.frequency_responses(*asked, **options, on_curve=lambda row, *_: told.append(row))
    assert told == [0, 1, 2, 3, 4]
    assert there.failures == here.failures
    assert there.failures[2].startswith("RuntimeError: no seven (test_distributed.py, line ")
    assert there.failures[3] is not None
    with da.Checkpoint(tmp_path / "checkpoint") as checkpoint:
        again = da.frequency_responses(*asked, checkpoint=checkpoint, stability=True)
        assert checkpoint.spared > 0
    for one, other, third in zip(here.curves, there.curves, again.curves, strict=True):
        if one is not None:
            assert content_of(one) == content_of(other) == content_of(third)


def content_of(curve) -> dict[str, bytes]:
    dataset = curve.to_xarray()
    return {str(name): array.values.tobytes() for name, array in dataset.items()} | {"attributes": str(dataset.attrs)}


FAMILY = (
    SLIDER
    + """
[frequency_response]
frequencies = { start = 0.12, end = 0.3, count = 60 }
sweep = { parameter = "preload", values = { count = 8 } }
"""
)


@pytest.mark.slow
def test_a_family_that_is_killed_on_a_cluster_goes_on_there_or_here(started, client, tmp_path):
    (tmp_path / "study.toml").write_text(FAMILY)
    folder, _ = run_study(load(tmp_path / "study.toml"), tmp_path / "undisturbed")
    for name, more in (("there", ["--cluster", started.address]), ("here", [])):
        killed, events = tmp_path / name, tmp_path / name / "events.jsonl"
        command = [Path(sys.executable).with_name("dalembert"), "run", tmp_path / "study.toml", "--out", killed]
        with subprocess.Popen([*command, "--cluster", started.address], **QUIET) as run:
            while not (events.is_file() and events.read_text().count('"swept"') >= 2):
                assert run.poll() is None
                time.sleep(0.01)
            run.kill()
        assert events.read_text().count('"swept"') < 8
        subprocess.run([command[0], "resume", killed, *more], check=True, **QUIET)
        assert content(killed / "result.nc") == content(folder.result)
        assert kinds(RunFolder(killed)) == kinds(folder)
