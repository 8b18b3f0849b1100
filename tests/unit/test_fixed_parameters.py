"""Parameters with equal bounds: every method uses their value and varies only the others."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.data import Bands, Measurements
from dalembert.errors import InputError
from dalembert.forward import PythonModel, Sensor, Sensors
from dalembert.inverse import (
    Designs,
    Experiment,
    Fit,
    Profiles,
    design,
    identifiability,
    identify,
    identify_bands,
    identify_set,
    predict,
    profile,
)
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.report import report
from dalembert.study import Study, load, run_study
from dalembert.uncertainty import Propagation, compare, propagate

TIMES = np.linspace(0.0, 2.0, 21)
STUDIES = Path(__file__).parents[2] / "studies"


def decay(height: complex, rate: complex, floor: complex) -> np.ndarray:
    return height * np.exp(-rate * TIMES) + floor


def model(rate: object = (1.3, 1.3), **bounds: object) -> PythonModel:
    given = {"height": (0.5, 2.0), "rate": rate, "floor": Parameter("floor", -1.0, 1.0, unit="m")}
    return PythonModel(decay, {**given, **bounds}, ["x"], TIMES)  # type: ignore[arg-type]


def without() -> PythonModel:
    """The same model, its rate written into the function."""
    bounds = {"height": (0.5, 2.0), "floor": Parameter("floor", -1.0, 1.0, unit="m")}
    return PythonModel(lambda height, floor: decay(height, 1.3, floor), bounds, ["x"], TIMES)


def measured(deviations: float | None = None) -> Measurements:
    noise = 1e-3 * np.random.default_rng(3).standard_normal(len(TIMES))
    return Measurements.of(TIMES, {"x": decay(1.0, 1.3, 0.1).real + noise}, deviations=deviations)


def begins(sentence: str) -> str:
    return f"^{re.escape(sentence)}"


@pytest.fixture(scope="module")
def fit() -> Fit:
    return identify(model(), measured())


def test_they_are_split_off() -> None:
    box = Parameters.of({"mass": (2.0, 2.0), "stiffness": (1.0, 5.0)})
    assert (box.names, len(box), box.lower.tolist(), box.start.tolist()) == (("stiffness",), 1, [1.0], [3.0])
    assert box.mapping([4.0]) == {"stiffness": 4.0, "mass": 2.0}
    assert box.vector({"stiffness": 4.0, "mass": 2.0}).tolist() == [4.0]
    assert Parameters(box.declared) == box
    with pytest.raises(InputError, match=begins("parameter 'mass' is fixed at 2 by equal bounds; leave it out, or")):
        box.vector({"stiffness": 4.0, "mass": 3.0})


def test_a_fixed_parameter_has_no_deviation() -> None:
    with pytest.raises(InputError, match=begins("parameter 'mass': both bounds are 2.0, so it is fixed and has no")):
        Parameter("mass", 2.0, 2.0, deviation=0.1)


def test_a_fit_is_that_of_the_model_without_it(fit: Fit) -> None:
    """Degrees of freedom, starts and simulations count only what varies."""
    other = identify(without(), measured())
    for name in ("values", "deviations", "correlation", "response"):
        assert np.array_equal(getattr(fit, name), getattr(other, name)), name
    assert (fit.simulations, len(fit.starts), fit.status) == (other.simulations, len(other.starts), other.status)
    assert fit.estimates == other.estimates | {"rate": 1.3}


def test_a_fit_shows_and_keeps_it(fit: Fit, tmp_path: Path) -> None:
    assert re.search(r"^rate, fixed +1\.3$", fit.summary(), re.MULTILINE)
    fit.save(tmp_path / "fit.nc")
    assert Fit.load(tmp_path / "fit.nc").parameters.fixed == (Parameter("rate", 1.3, 1.3),)
    fit.report(tmp_path / "fit.html")
    page = (tmp_path / "fit.html").read_text(encoding="utf-8")
    assert "rate, fixed" in page


def test_a_profile_and_a_prediction_leave_it_out(fit: Fit, tmp_path: Path) -> None:
    told = profile(model(), measured(), fit, points=6)
    assert tuple(told.intervals) == ("height", "floor")
    assert re.search(r"^rate, fixed +1\.3$", told.summary(), re.MULTILINE)
    told.save(tmp_path / "profiles.nc")
    assert Profiles.load(tmp_path / "profiles.nc").parameters == fit.parameters
    assert np.array_equal(predict(model(), fit).deviations, predict(without(), fit).deviations)
    with pytest.raises(
        InputError, match=begins("profile: the model has the parameters height, floor, rate = 1.4, the")
    ):
        profile(model(rate=(1.4, 1.4)), measured(), fit)
    with pytest.raises(InputError, match=begins("profile: names: parameter 'rate' is fixed at 1.3 by equal bounds")):
        profile(model(), measured(), fit, names=["rate"])


def test_bounds_leave_it_out(tmp_path: Path) -> None:
    box = {"height": (0.5, 1.0), "floor": 0.1}
    found, other = propagate(model(), box), propagate(without(), box)
    assert np.array_equal(found.lower, other.lower)
    assert (found.runs, found.box.names) == (other.runs, ("height", "floor"))
    assert re.search(r"^rate, fixed +1\.3$", found.summary(), re.MULTILINE)
    found.save(tmp_path / "bounds.nc")
    assert Propagation.load(tmp_path / "bounds.nc").fixed == (Parameter("rate", 1.3, 1.3),)
    report(found, tmp_path / "bounds.html")
    assert "rate, fixed" in (tmp_path / "bounds.html").read_text(encoding="utf-8")
    assert propagate(model(), box | {"rate": 1.3}).box.names == ("height", "floor")
    with pytest.raises(InputError, match=begins("intervals: parameter 'rate' is fixed at 1.3 by equal bounds")):
        propagate(model(), box | {"rate": (1.0, 2.0)})
    assert compare(model(), box, ["vertex"], reference="scan").rows[0].runs == 2  # one parameter has a width


def test_sets_bands_and_designs_leave_it_out() -> None:
    paved = identify_set(model(), measured(), error=0.01)
    assert paved.outer is not None
    assert paved.outer.names == ("height", "floor")
    assert paved.runs == identify_set(without(), measured(), error=0.01).runs
    bands = Bands.of(TIMES, {"x": (decay(0.9, 1.3, 0.0), decay(1.1, 1.3, 0.1))})
    box = identify_bands(model(), bands)
    assert (box.unknowns, box.simulations) == (
        ("height middle", "floor middle", "height radius", "floor radius"),
        identify_bands(without(), bands).simulations,
    )
    ranked = design(model(), deviations=0.1)
    assert np.array_equal(ranked.deviations, design(without(), deviations=0.1).deviations)
    for result in (paved, box, ranked):
        assert re.search(r"^rate, fixed +1\.3$", result.summary(), re.MULTILINE)
    assert Designs.from_xarray(ranked.to_xarray()).parameters == ranked.parameters
    with pytest.raises(InputError, match=begins("intervals: parameter 'rate' is fixed at 1.3 by equal bounds")):
        identify_bands(model(), bands, intervals=["rate"])


def test_experiments_share_it() -> None:
    fit = identify([Experiment("A", model(), measured()), Experiment("B", model(), measured(), ("floor", "rate"))])
    assert fit.parameters.names == ("height", "floor", "B.floor")
    assert [item.name for item in fit.parameters.fixed] == ["rate", "B.rate"]
    with pytest.raises(InputError, match=begins("parameter 'rate' is shared by the experiments 'A' and 'B', but is")):
        identify([Experiment("A", model(), measured()), Experiment("B", model(rate=(1.4, 1.4)), measured())])


def test_a_sensor_may_have_a_known_delay() -> None:
    fine = np.linspace(0.0, 3.0, 301)
    swing = PythonModel(
        lambda rate, size: size * np.cos(rate * fine), {"rate": (1.0, 9.0), "size": (2, 2)}, ["x"], fine
    )
    late = Sensors(swing, {"x": Sensor(delay=(0.05, 0.05), gain=(0.5, 2.0))}, times=np.array([0.5, 1.0]))
    assert late.parameters.names == ("rate", "x gain")
    read = late.evaluate([[4.0, 1.5]]).values.ravel()
    assert read == pytest.approx(3 * np.cos(4 * (late.coordinate.values - 0.05)), abs=1e-8)
    assert late.jacobian([4.0, 1.5])[:, 0, 1] == pytest.approx(read / 1.5)
    other = PythonModel(swing.function, {"rate": (1.0, 9.0), "size": (2.5, 2.5)}, ["x"], fine)
    assert swing.fingerprint != other.fingerprint


def pendulum(length: complex, mass: complex) -> mb.System:
    system = mb.System()
    bob = system.add(mb.PointMass("bob", mass=mass, position=(length, 0.0)))
    system.add(mb.DistanceJoint("rod", system.ground.point(0.0, 0.0), bob.centre))
    return system


def test_a_mechanism_has_it() -> None:
    motion = mb.TimeResponse(pendulum, {"length": (0.5, 2.0), "mass": (3.0, 3.0)}, ["bob.centre.x"], TIMES)
    assert motion.system([1.0]).bodies[0].mass == 3.0  # type: ignore[attr-defined]
    alone = mb.TimeResponse(lambda length: pendulum(length, 3.0), {"length": (0.5, 2.0)}, ["bob.centre.x"], TIMES)
    assert np.array_equal(motion.jacobian([1.0]), alone.jacobian([1.0]))
    heavier = mb.TimeResponse(pendulum, {"length": (0.5, 2.0), "mass": (4.0, 4.0)}, ["bob.centre.x"], TIMES)
    assert motion.fingerprint != heavier.fingerprint


SWEEP = """
[parameters]
length = { lower = "0.5 m", upper = "2 m" }
mass = { lower = "3 kg", upper = "3 kg", start = "3 kg" }
[model]
[[model.body]]
kind = "RigidBar"
name = "bar"
length = "length"
mass = "mass"
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "bar.start"
[solver]
step = "10 ms"
"""
SWEPT = """[sweep]
channels = ["system.potential_energy"]
at = 0.5
sensitivities = true
[sweep.over]
length = [1.0, 2.0]
"""


def written(folder: Path, text: str) -> Study:
    path = folder / "study.toml"
    path.write_text(text)
    return load(path)


def test_a_study_has_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    study = written(tmp_path, SWEEP + SWEPT)
    assert study.parameters.names == ("length",)
    assert study.settings["parameters"]["mass"]["lower"] == 3.0
    found = run_study(study)[1].result.curves[0]
    line = next(line for line in SWEEP.splitlines() if line.startswith("mass = {"))
    plain = written(tmp_path, (SWEEP + SWEPT).replace(line, "").replace('"mass"', "3.0"))
    expected = run_study(plain, force=True)[1].result.curves[0]
    assert np.array_equal(found.sensitivities, expected.sensitivities)
    assert np.abs(found.responses).min() > 1.0  # J


@pytest.mark.parametrize(
    ("task", "sentence"),
    [
        (SWEPT.replace("length =", "mass ="), "[sweep.over]: parameter 'mass' is fixed by equal bounds; leave it out"),
        (
            "[propagate]\nchannels = ['bar.end.x']\ntimes = [0.5]\n[propagate.intervals]\nmass = [1, 2]",
            "[propagate.intervals]: parameter 'mass' is fixed by equal bounds; leave it out here, or give bounds that",
        ),
        (
            "[design]\nchannels = ['bar.end.x']\ntimes = [0.5]\ndeviations = { 'bar.end.x' = 0.1 }",
            "[design] needs at least one [parameters.NAME] table whose bounds differ",
        ),
    ],
)
def test_a_study_that_would_vary_it_is_refused(task: str, sentence: str, tmp_path: Path) -> None:
    model = SWEEP.replace('"0.5 m"', '"2 m"') if "design" in task else SWEEP
    with pytest.raises(InputError, match=re.escape(sentence)):
        written(tmp_path, model + task)


ALL: dict[str, Callable[[PythonModel], object]] = {
    "identify": lambda fixed: identify(fixed, measured()),
    "identify_set": lambda fixed: identify_set(fixed, measured(), error=0.1),
    "identify_bands": lambda fixed: identify_bands(fixed, Bands.of(TIMES, {"x": (0 * TIMES, TIMES)})),
    "propagate": lambda fixed: propagate(fixed, {}),
    "design": lambda fixed: design(fixed, deviations=0.1),
    "identifiability": lambda fixed: identifiability(fixed, deviations=0.1),
}


@pytest.mark.parametrize("method", ALL)
def test_where_nothing_varies_there_is_one_sentence(method: str) -> None:
    fixed = model(height=(1.0, 1.0), floor=(0.0, 0.0))
    with pytest.raises(InputError) as error:
        ALL[method](fixed)
    assert str(error.value) == (
        f"{method}: every parameter of the model is fixed by equal bounds; expected at least one parameter whose "
        "bounds differ"
    )
    assert fixed.evaluate(np.zeros((1, 0))).values[0, 0, 0] == 1.0
