"""The task [sample]: read, planned, run, reported, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from inline_snapshot import snapshot

from dalembert.errors import InputError
from dalembert.inverse import Posterior
from dalembert.study import load, plan, report_run, run_study
from dalembert.study.run.runner import unknowns

TIMES = np.linspace(0, 1, 11)
DECAY = """
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 1, 11)

def decay(parameters):
    return PythonModel(response, parameters, ["x"], times)

def response(rate, height):
    return (height * np.exp(-rate * times))[:, None]
"""
HEAD = """
[study]
name = "decay"
title = "Decay"
[parameters]
rate = { lower = 0.5, upper = "8 1/s" }
height = { lower = "100 mm", upper = 3.0, start = 1.0, prior = { kind = "log-normal", median = "1 m", log_deviation = 0.1 } }
[model]
forward = "decay.py:decay"
[data]
file = "data.csv"
time = "t"
columns = { x = "x" }
deviations = { x = 0.05 }
"""


def study(folder: Path, task: str, head: str = HEAD) -> Path:
    noisy = np.exp(-2 * TIMES) + 0.05 * np.random.default_rng(2).standard_normal(11)
    rows = "\n".join(f"{time},{value}" for time, value in zip(TIMES, noisy, strict=True))
    (folder / "data.csv").write_text(f"t,x\n{rows}\n")
    (folder / "decay.py").write_text(DECAY)
    path = folder / "study.toml"
    path.write_text(head + task)
    return path


def test_a_noise_parameter_has_a_prior(tmp_path: Path) -> None:
    task = """
[sample]
chains = 1
draws = 30
warmup = 30
sampler = "affine-invariant"
priors = { "noise.x.deviation" = { kind = "normal", mean = 0.2, deviation = 1e-4 } }
"""
    loaded = load(study(tmp_path, task, HEAD.replace("deviations = { x = 0.05 }", "")))
    folder, _ = run_study(loaded, tmp_path / "run")
    result = Posterior.load(folder.result)
    assert result.provenance["priors"]["noise.x.deviation"] == "Normal(mean=0.2, deviation=0.0001)"
    assert result.estimates["noise.x.deviation"] == pytest.approx(0.2, rel=1e-2)


def test_a_study_is_sampled_and_reported(tmp_path: Path) -> None:
    task = "[sample]\nchains = 2\ndraws = 40\nwarmup = 40\nprofile = true\nsampler = { kind = 'nuts', target_accept = 0.9 }\n"
    loaded = load(study(tmp_path, task))
    assert unknowns(loaded) == ("rate", "height")
    assert plan(loaded).startswith(
        "draws rate, height from their posterior, 2 chains of 40 + 40 draws, by 960 to 4800 simulations"
    )
    folder, outcome = run_study(loaded, tmp_path / "run")
    result = Posterior.load(folder.result)
    assert result.provenance["method"]["settings"]["target_accept"] == 0.9
    assert outcome.best["values"] == pytest.approx(result.estimates)
    assert (tmp_path / "run" / "profiles.nc").is_file()
    assert "profile" in folder.report.read_text(encoding="utf-8")
    events = [json.loads(line) for line in (tmp_path / "run" / "events.jsonl").read_text().splitlines()]
    assert sum(event["event"] == "drawn" for event in events) == 100
    folder.report.unlink()
    report_run(folder)
    assert folder.report.is_file()


def test_the_parameters_of_the_noise_are_sampled_too(tmp_path: Path) -> None:
    task = "[sample]\nchains = 2\ndraws = 40\nwarmup = 40\nprofile = true\nnoise = 'constant'\n"
    _, outcome = run_study(load(study(tmp_path, task)), tmp_path / "run")
    assert outcome.result.parameters.names == ("rate", "height", "noise.x.deviation")
    assert 0.02 < outcome.result.estimates["noise.x.deviation"] < 0.2  # 0.05 in the data


@pytest.mark.parametrize(("sampler", "separate"), [("nuts", True), ("affine-invariant", False)])
def test_both_modes_of_a_study_are_sampled(tmp_path: Path, sampler: str, separate: bool) -> None:
    task = f"[sample]\nchains = 2\ndraws = 100\nwarmup = 40\nsampler = '{sampler}'\n"
    head = HEAD.replace('lower = 0.5, upper = "8 1/s"', "lower = -8, upper = 8, start = 3")
    path = study(tmp_path, task, head)
    (tmp_path / "decay.py").write_text(DECAY.replace("-rate * times", "-0.5 * rate * rate * times"))
    _, outcome = run_study(load(path), tmp_path / "run")
    rates = outcome.result["rate"].mean(axis=1)
    assert np.any(outcome.result["rate"] > 0)
    assert np.any(outcome.result["rate"] < 0)
    codes = {finding.code for finding in outcome.result.findings}
    assert ("separate-modes" in codes) == separate
    assert (np.max(np.abs(rates)) > 1.8) == separate  # chains that jump change the sign


MISTAKES = {
    "no data": ("[sample]\n", HEAD.partition("[data]")[0]),
    "both": ("[sample]\nsampler = 'nuts'\nsurrogate = true\n", HEAD),
    "start": ("[sample]\nstart = { rates = 1.0 }\n", HEAD),
    "sampler": ("[sample]\nsampler = 'nut'\n", HEAD),
    "weights": ("[sample]\nweights = { y = 1.0 }\n", HEAD),
    "noise": ("[sample.noise.channels.y]\nmodel = 'constant'\n", HEAD),
    "noise and weights": ("[sample]\nnoise = 'mixed'\nweights = { x = 1.0 }\n", HEAD),
}


def test_mistakes_are_explained(tmp_path: Path) -> None:
    told = {}
    for name, (task, head) in MISTAKES.items():
        with pytest.raises(InputError) as error:
            load(study(tmp_path, task, head))
        told[name] = str(error.value)
    assert told == snapshot(
        {
            "no data": "study.toml: [sample] needs a [data] table",
            "both": "study.toml: [sample]: sampler 'nuts' and surrogate are given; a surrogate proposes draws of the sampler 'delayed-acceptance'. Leave one of the keys out",
            "start": "study.toml: [sample.start]: unknown parameter 'rates'; did you mean 'rate'?",
            "sampler": "study.toml: [sample], sampler: 'nut' was given; expected 'affine-invariant', 'delayed-acceptance' or 'nuts'; did you mean 'nuts'?",
            "weights": """\
study.toml: [sample], weights: no weight is given for channel 'x'
study.toml: [sample], weights: unknown channel 'y'; known: x\
""",
            "noise": "study.toml: [sample.noise], channels: unknown channel 'y'; known: x",
            "noise and weights": "study.toml: [sample.noise] cannot be used with weights, which follow from it; leave one of them out",
        }
    )
