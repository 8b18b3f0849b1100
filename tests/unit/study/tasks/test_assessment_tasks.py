"""What data can tell, in study files: profiles and predictions of a fit, designs, priors, the look before solving."""

from types import SimpleNamespace

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert as da
from dalembert.errors import DalembertError
from dalembert.inverse import Designs, Prediction, Profiles
from dalembert.study import load, plan, report_run, run_study
from dalembert.study.tasks import TASKS, assessments
from pages import read_page
from support import says

TIMES = np.linspace(0, 2, 21)
MODELS = """
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 2, 21)

def decay(parameters):
    return PythonModel(lambda rate, height: height * np.exp(-rate * times), parameters, ["x"], times)

def gained(parameters):
    return PythonModel(lambda rate, height, gain: gain * height * np.exp(-rate * times), parameters, ["x"], times)

def moving(parameters):
    def response(rate, height):
        x = height * np.exp(-rate * times)
        return np.stack([x, -rate * x], axis=1)
    return PythonModel(response, parameters, ["x", "vx"], times)
"""
HEAD = """
[parameters]
rate = { lower = 0.2, upper = 3.0, start = 1.0 }
height = { lower = 0.1, upper = 2.0 }
[model]
forward = "models.py:decay"
"""
IDENTIFY = (
    HEAD
    + """
[data]
file = "data.csv"
columns = { x = "x" }
deviations = { x = 0.02 }
[identify]
starts = 2
profile = true
prediction = true
level = 0.9
"""
)
DESIGN = (
    HEAD.replace("decay", "moving")
    + """
[design]
deviations = 0.01
horizons = [0.5, 2.0]
at = { rate = 1.2 }
"""
)


@pytest.fixture
def write(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "models.py").write_text(MODELS)
    x = np.exp(-TIMES) + 0.02 * np.random.default_rng(0).standard_normal(21)
    np.savetxt("data.csv", np.column_stack([TIMES, x]), fmt="%.17g", delimiter=",", header="t,x", comments="")

    def write(text):
        path = tmp_path / "decay.toml"
        path.write_text(text)
        return load(path)

    return write


def test_profiles_and_prediction_stand_beside_the_result_and_in_summary_and_report(write):
    folder, outcome = run_study(write(IDENTIFY))
    assert outcome.success
    profiles = Profiles.load(folder.path / "profiles.nc")
    prediction = Prediction.load(folder.path / "prediction.nc")
    assert (profiles.level, prediction.level) == (0.9, 0.9)
    assert profiles.summary() in outcome.summary
    assert prediction.summary() in outcome.summary
    first = folder.report.read_text()
    assert [attrs["id"] for tag, attrs in read_page(folder.report).tags if tag == "section"][-3:] == [
        "profile-likelihood",
        "prediction",
        "provenance",
    ]
    folder.report.unlink()
    report_run(folder)
    assert folder.report.read_text() == first


def test_without_the_keys_there_are_no_such_files(write):
    folder, _ = run_study(write(IDENTIFY.replace("true", "false")))
    assert not list(folder.path.glob("pr*.nc"))


def foreseen(study):
    return TASKS[study.task].foreseen(study)


def test_a_check_foresees_what_the_data_tell(write):
    assert foreseen(write(IDENTIFY)) == ("At the first guesses: All parameters are identifiable.",)
    three = IDENTIFY.replace("decay", "gained").replace("[model]", "gain = { lower = 0.5, upper = 2.0 }\n[model]")
    told = foreseen(write(three))
    assert told == snapshot(
        (
            "At the first guesses: Only a combination of 'height' and 'gain' is identifiable: changing 'height' by +0.126 and 'gain' by -0.15 together does not change the response. Fix one of them, or measure a quantity that separates them.",
        )
    )
    unknown = foreseen(write(IDENTIFY.replace("deviations = { x = 0.02 }", "")))
    assert unknown == snapshot(
        (
            "At the first guesses: The noise of the data is not given: only parameters that exact data of these channels cannot identify are listed. Give the standard deviations of the data.",
        )
    )


def test_a_check_of_another_task_foresees_nothing(write):
    assert foreseen(write(DESIGN)) == ()


def test_a_prior_in_the_file_enters_the_fit(write):
    free, known = IDENTIFY, IDENTIFY.replace("upper = 2.0 }", "upper = 2.0, start = 0.5, deviation = '10 mm' }")
    with pytest.raises(DalembertError, match="deviation: "):
        write(known.replace("'10 mm'", "'10 s'").replace("height = {", "height = { unit = 'm',"))
    without, with_prior = (run_study(write(text))[1].result for text in (free, known))
    assert with_prior.parameters.items[1].deviation == 0.01
    assert without.values[1] == pytest.approx(1.0, abs=0.03)
    assert 0.5 < with_prior.values[1] < without.values[1] - 0.03


def test_a_design_ranks_sensors_and_horizons(write):
    study = write(DESIGN)
    assert plan(study) == (
        "ranks experiments that measure x, vx by how well they would determine rate, height, from one simulation with 2 "
        "sensitivities"
    )
    folder, outcome = run_study(study)
    designs = Designs.load(folder.result)
    assert designs.sensors[0] == ("vx",)
    assert designs.at.tolist() == [1.2, 1.05]
    assert outcome.best["values"]["score"] == designs.scores[0]
    assert outcome.best["values"]["deviation of rate"] == designs.deviations[0, 0]
    page = read_page(folder.report)
    assert "The best design is vx until time 2 s" in page.text
    assert len(page.table("designs")) == 5


def test_a_design_with_correlated_noise(write):
    noise = 'noise = { model = "autoregressive", order = 1, partial = [0.8], deviation = { model = "known" } }'
    _, plain = run_study(write(DESIGN))
    _, correlated = run_study(write(DESIGN.replace("deviations =", f"{noise}\ndeviations =")))
    assert correlated.best["values"]["deviation of rate"] != plain.best["values"]["deviation of rate"]


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("deviations = 0.01", "", "[design] needs the noise of what could be measured; give deviations or noise"),
        ("rate = 1.2", "raet = 1.2", "[design.at]: unknown parameter 'raet'; did you mean 'rate'?"),
        (
            "[design]",
            "[design]\nchannels = ['x']",
            "[design], channels: a forward model has its own; leave the key out",
        ),
        ("forward =", "function =", "[design]: the key 'times' is missing; a mechanism needs it"),
    ],
)
def test_a_design_that_cannot_be_meant_is_refused(write, old, new, sentence):
    with pytest.raises(DalembertError) as error:
        write(DESIGN.replace(old, new))
    assert sentence in str(error.value)


def test_a_profile_of_a_robust_loss_is_refused(write):
    sentence = (
        "decay.toml: [identify], profile: the minimum of the loss 'huber' is no likelihood; leave one of the keys out"
    )
    with pytest.raises(DalembertError, match=says(sentence)):
        write(IDENTIFY.replace("starts = 2", "starts = 2\nloss = 'huber'"))


def test_friction_that_does_not_suit_the_motion_is_foreseen():
    def pendulum(slip_rate):
        def build(coulomb):
            system = da.System()
            rod = system.add(da.RigidBar("rod", length=0.4, mass=0.8, angle=-0.4))
            system.add(da.RevoluteJoint("pin", system.ground, rod.start, coulomb=coulomb, slip_rate=slip_rate))
            return system

        return da.TimeResponse(build, {"coulomb": (0.0, 0.1)}, ["pin.angle"], times, da.GeneralizedAlpha(4e-3))

    times = np.linspace(0.0, 2.0, 21)
    data = da.Measurements.of(times, {"pin.angle": np.sin(times)}, deviations=0.01)
    noted = [sentence for sentence in assessments.foreseen(pendulum(1e-3), data) if "'pin'" in sentence]
    assert len(noted) == 1
    assert "crosses the smoothed friction" in noted[0]
    assert not [sentence for sentence in assessments.foreseen(pendulum(0.3), data) if "'pin'" in sentence]


def test_only_a_swarm_has_a_settled_number_of_simulations():
    swarm = {"kind": "standard-swarm", "particles": 5, "iterations": 8}
    tables = [TASKS["identify"].table()(**table) for table in ({}, {"method": swarm}, {"method": swarm, "starts": 3})]
    assert [TASKS["identify"].planned(SimpleNamespace(table=table)) for table in tables] == [None, 40, 120]
