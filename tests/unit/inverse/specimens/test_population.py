"""What `population` refuses, and its report."""

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert as da

TIMES = np.linspace(0.0, 2.0, 21)
BOX = {"rate": (0.1, 3.0), "height": (0.5, 2.0)}
MODEL = da.PythonModel(lambda rate, height: height * np.exp(-rate * TIMES), BOX, ["x"], TIMES)


def data(rate, seed):
    noise = 0.01 * np.random.default_rng(seed).standard_normal(len(TIMES))
    return da.Measurements.of(TIMES, {"x": np.exp(-rate * TIMES) + noise})


@pytest.fixture(scope="module")
def fits():
    return {f"part {k}": da.identify(MODEL, data(rate, k), starts=1) for k, rate in enumerate((0.8, 1.0, 1.1, 1.3))}


@pytest.fixture(scope="module")
def joint():
    experiments = [da.Experiment(f"part {k}", MODEL, data(1.0, k), local=("rate",) if k else ()) for k in range(3)]
    return da.identify(experiments, starts=1)


@pytest.mark.parametrize(
    ("change", "options", "sentence"),
    [
        (
            lambda fits: {},
            {},
            snapshot("population: there are no fits. Add at least 3, by the names of the specimens."),
        ),
        (
            lambda fits: [1.0],
            {},
            snapshot("population: fits is [1.0]; expected a mapping of names to fits, or one fit"),
        ),
        (
            lambda fits: dict(list(fits.items())[:2]),
            {},
            snapshot("population: there are 2 specimens, and a spread needs at least 3. Add more fits."),
        ),
        (
            lambda fits: fits,
            {"parameters": "rat"},
            snapshot("population, specimen 'part 0': unknown parameter 'rat'; did you mean 'rate'?"),
        ),
        (
            lambda fits: dict(list(fits.items())[:3]),
            {"correlated": True},
            snapshot(
                "population: the correlations of 2 parameters need at least 4 specimens, and there are 3. Use correlated=False, or name fewer parameters."
            ),
        ),
        (
            lambda fits: fits,
            {"level": 95},
            snapshot("population: level is 95; expected a number between 0 and 1, such as 0.95"),
        ),
    ],
    ids=["nothing", "no-fits", "two", "unknown", "correlated", "level"],
)
def test_what_is_refused(fits, change, options, sentence):
    with pytest.raises(da.InputError) as refused:
        da.population(change(fits), **options)
    assert str(refused.value) == sentence


def test_experiments_without_a_common_local_parameter_are_refused(joint):
    with pytest.raises(da.InputError) as refused:
        da.population(joint)
    assert str(refused.value) == snapshot(
        "population: the experiments of the fit have no local parameter in common. Declare those that vary as local, with local of each experiment."
    )


def test_values_without_deviations_are_refused():
    idle = da.PythonModel(
        lambda rate, height, idle: height * np.exp(-rate * TIMES) + 0 * idle, {**BOX, "idle": (0.0, 1.0)}, ["x"], TIMES
    )
    one = da.identify(idle, data(1.0, 9), starts=1)
    with pytest.raises(da.InputError) as refused:
        da.population(dict.fromkeys("abc", one))
    assert str(refused.value) == snapshot(
        "population, specimen 'a': idle has no standard deviation, because the data do not determine it. Leave it out of parameters, or fix it in the fits."
    )


def test_the_report_has_means_and_specimens(fits, tmp_path):
    found = da.population(fits, "rate")
    found.report(tmp_path / "report.html")
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    for words in ("Several specimens", "Mean and spread", "part 3", "new specimen, 95 %", "There are 4 specimens."):
        assert words in text
    assert list(found.figures()) == ["specimens-1"]
    assert "1 specimens" not in found.summary()
