"""Noise models in a study file: their keys, a run, its report, and what they cannot be used with."""

import numpy as np
import pytest

import dalembert as da
from correlated_noise import autoregressive
from dalembert.errors import InputError
from dalembert.study import load, report_run, run_study
from pages import read_page

DECAY = """
import numpy as np
from dalembert.forward import PythonModel

def decay(parameters):
    times = np.linspace(0, 4, 81)
    return PythonModel(lambda height, rate: height * np.exp(-rate * times), parameters, ["x"], times)
"""
STUDY = """
[parameters]
height = { lower = 0.5, upper = 5.0 }
rate = { lower = 0.1, upper = 3.0 }
[model]
forward = "decay.py:decay"
[data]
file = "decay.csv"
columns = { x = "x" }
[identify]
starts = 1
"""
TIMES = np.linspace(0, 4, 81)


@pytest.fixture
def write(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "decay.py").write_text(DECAY)
    x = 2 * np.exp(-0.7 * TIMES) + 0.05 * autoregressive(1, 81, 0.6)
    np.savetxt(tmp_path / "decay.csv", np.column_stack([TIMES, x]), delimiter=",", header="t,x", comments="")

    def written(text):
        path = tmp_path / "study.toml"
        path.write_text(STUDY + text)
        return path

    return written


def test_a_study_estimates_the_noise_and_reports_it(write, tmp_path):
    folder, outcome = run_study(load(write('noise = "autoregressive"\n')), tmp_path / "run")
    fit = outcome.result
    assert isinstance(fit.noise.models["x"], da.AutoregressiveNoise)
    assert fit.noise.models["x"].order >= 1
    assert "noise.x.deviation" in outcome.summary
    page = read_page(report_run(folder))
    assert "Noise, estimated with the parameters" in page.text


TABLES = [
    (
        '[identify.noise]\nmodel = "autoregressive"\norder = 2\ndeviation = { model = "mixed", relative = [1e-4, 0.2] }\n',
        da.AutoregressiveNoise(order=2, deviation=da.MixedNoise(relative=(1e-4, 0.2))),
    ),
    (
        '[identify.noise]\nmodel = "ornstein-uhlenbeck"\ntime = ["1 ms", "2 s"]\nlocal = true\n',
        da.OrnsteinUhlenbeckNoise(time=(1e-3, 2.0), local=True),
    ),
    (
        '[identify.noise]\nmodel = "constant"\ndeviation = "20 mm"\n',
        da.ConstantNoise(deviation=0.02),
    ),
    (
        '[identify.noise.channels.x]\nmodel = "proportional"\nrelative = 0.05\n',
        {"x": da.ProportionalNoise(relative=0.05)},
    ),
]


@pytest.mark.parametrize(("text", "expected"), TABLES)
def test_tables_are_noise_models(write, text, expected):
    assert load(write(text)).file.identify.noise.noise() == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[identify.noise]\norder = 1\n", "the key 'model' is missing; expected it, or the table channels"),
        (
            '[identify.noise]\nmodel = "constant"\norder = 1\n',
            "noise model 'constant': unknown argument 'order'; known: deviation, local",
        ),
        (
            '[identify.noise]\nmodel = "proportional"\nrelative = -1.0\n',
            "ProportionalNoise: relative is -1.0; expected a positive number",
        ),
        (
            '[identify.noise]\nmodel = "constant"\nchannels.x = { model = "mixed" }\n',
            "model and channels exclude each other; give each channel its table, or one model for all",
        ),
        ('[identify.noise]\nchannels.y = { model = "mixed" }\n', "[identify.noise], channels"),
        (
            'noise = "constant"\nloss = "huber"\nloss_scale = 1.0\n',
            "[identify.noise] cannot be used with the loss 'huber'; leave one of them out",
        ),
        (
            'noise = "constant"\nweights = { x = 1.0 }\n',
            "[identify.noise] cannot be used with weights, which follow from it; leave one of them out",
        ),
        (
            'noise = "constant"\nshooting = true\n',
            "[identify.noise] cannot be used with [identify.shooting]; leave one of them out",
        ),
    ],
)
def test_what_cannot_be_is_refused(write, text, message):
    with pytest.raises(InputError) as refused:
        load(write(text))
    assert message in str(refused.value)
