"""Mean and spread of local parameters over the experiments of a study file."""

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert as da
from dalembert.errors import DalembertError
from dalembert.study import load, report_run, run_study
from pages import read_page

TIMES = np.linspace(0, 2, 21)
MODELS = """
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 2, 21)

def decay(parameters):
    return PythonModel(lambda rate, height: height * np.exp(-rate * times), parameters, ["x"], times)
"""
HEAD = """
[parameters]
rate = { lower = 0.2, upper = 3.0, start = 1.0 }
height = { lower = 0.1, upper = 2.0 }
[model]
forward = "models.py:decay"
[identify]
starts = 1
"""
RATES = {"first": 0.9, "second": 1.0, "third": 1.3}


@pytest.fixture
def write(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "models.py").write_text(MODELS)
    for k, (name, rate) in enumerate(RATES.items()):
        x = np.exp(-rate * TIMES) + 0.01 * np.random.default_rng(k).standard_normal(21)
        np.savetxt(f"{name}.csv", np.column_stack([TIMES, x]), delimiter=",", header="t,x", comments="")

    def write(key, own, names=tuple(RATES)):
        tables = [
            f'[[experiments]]\nname = "{name}"\nfile = "{name}.csv"\ncolumns = {{ x = "x" }}\ndeviations = {{ x = 0.01 }}\n'
            f"local = {own if isinstance(own, str) else own[name]}\n"
            for name in names
        ]
        path = tmp_path / "decay.toml"
        path.write_text(HEAD + key + "\n" + "\n".join(tables))
        return load(path)

    return write


def test_a_population_is_estimated_saved_and_reported(write, tmp_path):
    folder, outcome = run_study(write("population = true", '["rate"]'), tmp_path / "run")
    found = da.Population.load(tmp_path / "run" / "population.nc")
    assert found.names == ("rate",)
    assert found.specimens == tuple(RATES)
    np.testing.assert_allclose(found.values[:, 0], list(RATES.values()), atol=0.06)
    assert found.summary() in outcome.summary
    assert "Mean and spread" in read_page(report_run(folder)).text


@pytest.mark.parametrize(
    ("key", "own", "names", "sentence"),
    [
        (
            "population = true",
            '["rate"]',
            ("first", "third"),
            snapshot(
                "decay.toml: [identify], population: there are 2 experiments to fit, and a spread needs at least 3 specimens; add [[experiments]], or leave the key out"
            ),
        ),
        (
            "population = true",
            {"first": '["rate"]', "second": '["height"]', "third": "[]"},
            tuple(RATES),
            snapshot(
                "decay.toml: [identify], population: the experiments have no local parameter in common; name those that vary in local of each"
            ),
        ),
        (
            'population = ["height"]',
            '["rate"]',
            tuple(RATES),
            snapshot(
                "decay.toml: [identify], population: 'height' is no local parameter of all experiments; name it in local of each"
            ),
        ),
    ],
    ids=["two", "none in common", "shared"],
)
def test_what_is_refused(write, key, own, names, sentence):
    with pytest.raises(DalembertError) as refused:
        write(key, own, names)
    assert str(refused.value) == sentence
