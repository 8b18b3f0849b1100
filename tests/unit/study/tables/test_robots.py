"""Robots in study files: the model, the identification of inertias, exciting trajectories, and wrong input."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from typer.testing import CliRunner

from dalembert.cli import app
from dalembert.errors import DataError, InputError, ModelError
from dalembert.inverse.inertial import TorquePrediction
from dalembert.multibody import RungeKutta4, simulate
from dalembert.multibody.trees import inverse_dynamics, read_urdf
from dalembert.report import figures, report
from dalembert.studio.editor.reading import read
from dalembert.study import load, plan, report_run, run_study
from dalembert.study.run.model_findings import model_findings
from dalembert.study.tasks.identify_inertias import _records as records
from dalembert.study.template import begin
from pages import read_page

SIMULATED = """
[parameters]
payload = { lower = 1.0, upper = 3.0, start = 1.9 }
[model]
space = true
gravity = [0, 0, -9.0]
[model.robot]
file = "robot.urdf"
slip = 0.05
numbers = { "lower.mass" = "payload", "elbow.damping" = "0.1*payload" }
positions = { shoulder = "20 deg" }
rates = { elbow = "1.0" }
torques = { shoulder = 3.0, elbow = { input = "tau" } }
[inputs.tau]
file = "motion.csv"
column = "tau2"
[[model.load]]
kind = "Force"
name = "push"
at = "lower.origin"
z = 5.0
[solver]
step = "2 ms"
[simulate]
end = 0.2
channels = ["shoulder.angle", "elbow.angle"]
"""


@pytest.fixture
def folder(tmp_path):
    """The files of the template."""
    return begin("robot", tmp_path / "arm").parent


def wrong(folder, text):
    path = folder / "wrong.toml"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        load(path)
    return [line.partition("wrong.toml: ")[2] for line in str(error.value).split("\n")]


def test_a_robot_has_the_numbers_torques_and_initial_state_of_the_study(folder):
    path = folder / "simulated.toml"
    path.write_text(SIMULATED)
    study = load(path)
    assert "1 simulation" in plan(study)
    system = study.system()
    assert [body.name for body in system.bodies] == ["upper", "lower"]
    assert [load.name for load in system.loads if "drive" in load.name] == ["shoulder drive", "elbow drive"]
    motion = study.motion(0.2)
    tau = study.inputs["tau"].signal({})
    tree = read_urdf(folder / "robot.urdf").with_numbers({"lower.mass": 1.9, "elbow.damping": 0.19})
    direct = tree.system(
        [np.deg2rad(20), 0.0], [0.0, 1.0], (0, 0, -9.0), slip=0.05, torques={"shoulder": 3.0, "elbow": tau}
    )
    bare = study._with(model=study.file.model.model_copy(update={"load": []}))
    names = ["shoulder.angle", "elbow.angle"]
    other = simulate(direct, 0.2, solver=study.solver)
    np.testing.assert_allclose(bare.motion(0.2).channels(names), other.channels(names), atol=1e-12)
    assert np.abs(motion.channels(names)[-1] - other.channels(names)[-1]).max() > 1e-3  # the push acts


FIXED = """<robot name="arm"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0 -0.2"/><mass value="2"/>
  <inertia ixx="0.03" iyy="0.03" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="tool"/><link name="tip"/>
<joint name="upper" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
<joint name="flange" type="fixed"><parent link="upper"/><child link="tool"/><origin xyz="0 0 -0.4"/></joint>
<joint name="end" type="fixed"><parent link="tool"/><child link="tip"/><origin xyz="0 0 -0.1"/></joint>
</robot>"""
OF_FIXED = """
[model]
space = true
robot = { file = "arm.urdf", positions = { upper = 0.5 } }
[solver]
step = "0.5 ms"
[simulate]
end = "0.2 s"
points = ["upper.tip"]
"""


def test_links_that_are_fixed_to_a_moving_body_are_parts_of_it(tmp_path):
    """A pendulum of 2 kg with 0.11 kg m^2 about its pin; the point is 0.5 m below the pin."""
    (tmp_path / "arm.urdf").write_text(FIXED)
    (tmp_path / "arm.toml").write_text(OF_FIXED)
    study = load(tmp_path / "arm.toml")
    assert study.file.model.robot_table.names == (["upper"], ["upper joint"])
    pendulum = solve_ivp(
        lambda _, y: [y[1], -2 * 9.81 * 0.2 / 0.11 * np.sin(y[0])], (0, 0.2), [0.5, 0], rtol=1e-10, atol=1e-12
    )
    angle = pendulum.y[0, -1]
    found = study.motion(0.2).channels(["upper joint.angle", "upper.tip.x", "upper.tip.z"])[-1]
    np.testing.assert_allclose(found, [angle, -0.5 * np.sin(angle), -0.5 * np.cos(angle)], atol=2e-6)


def test_components_are_placed_at_the_joints_that_the_mechanism_has(tmp_path):
    (tmp_path / "arm.urdf").write_text(FIXED)
    spring = (
        '[[model.load]]\nkind = "AngleLimit"\nname = "stop"\njoint = "JOINT"\nstiffness = 10.0\nupper_limit = 1.0\n'
    )
    (tmp_path / "arm.toml").write_text(OF_FIXED + spring.replace("JOINT", "upper joint"))
    assert [load.name for load in load(tmp_path / "arm.toml").system().loads] == ["stop"]
    sentences = wrong(tmp_path, OF_FIXED + spring.replace("JOINT", "upper"))
    assert sentences == [
        "[[model.load]] 'stop', joint: 'upper' was given; unknown joint 'upper'; did you mean 'upper joint'?"
    ]
    same = spring.replace("JOINT", "upper joint").replace('"stop"', '"upper"')
    assert wrong(tmp_path, OF_FIXED + same) == ["[model]: 2 components are called 'upper'; expected different names"]


def test_what_an_import_left_out_is_listed(tmp_path):
    """In the check, the run, its report, and what the studio shows above the text."""
    floating = FIXED.replace("flange", "root").replace('type="fixed"', 'type="floating"', 1)
    (tmp_path / "arm.urdf").write_text(floating)
    (tmp_path / "arm.toml").write_text(OF_FIXED)
    sentence = (
        "Robot 'arm': the import left out parts of the file on which the motion depends: line 6: joint 'root' is "
        "floating, which is not supported; it is fixed at its zero position."
    )
    checked = CliRunner().invoke(app, ["check", str(tmp_path / "arm.toml")])
    assert f"Warning: {sentence}" in checked.output
    folder, outcome = run_study(load(tmp_path / "arm.toml"), tmp_path / "run")
    findings = [finding for finding in outcome.findings if finding.code == "not-imported"]
    assert [(finding.severity, finding.values["moves"]) for finding in findings] == [("warning", True)]
    assert folder.state()["findings"][0]["code"] == "not-imported"
    assert sentence in outcome.summary
    assert sentence in read_page(folder.report).text
    assert read(tmp_path / "arm.toml", OF_FIXED).findings == tuple(findings)


def test_limits_without_effect_are_listed_by_tasks_that_simulate(tmp_path):
    limited = FIXED.replace('type="continuous"', 'type="revolute"').replace(
        '<axis xyz="0 1 0"/>', '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9" velocity="2"/>'
    )
    (tmp_path / "arm.urdf").write_text(limited)

    def listed(text: str) -> list[tuple]:
        (tmp_path / "arm.toml").write_text(text)
        found = model_findings(load(tmp_path / "arm.toml"))
        return [(own.code, own.severity, own.values["parts"]) for own in found]

    assert listed(OF_FIXED) == [("not-imported", "note", 3)]
    stop = '[[model.load]]\nkind = "AngleLimit"\nname = "stop"\njoint = "upper joint"\nstiffness = 10.0\nupper_limit = 1.0\n'
    assert listed(OF_FIXED + stop) == [("not-imported", "note", 2)]
    (tmp_path / "arm.toml").write_text(OF_FIXED)
    checked = CliRunner().invoke(app, ["check", str(tmp_path / "arm.toml")])
    assert "the limits of the positions of 'upper' have no effect" in checked.output
    table = "[exciting_trajectory]\nperiod = 2.0\nacceleration = 9.0\n"
    assert listed(OF_FIXED.partition("[solver]")[0] + table) == []


REFUSED = (
    "the system has no body",
    "but has no mass, and no link with mass",
    "the file has no <link>",
    "<mimic>: unknown joint",
)


@pytest.mark.slow
def test_studies_take_the_robots_of_others(tmp_path):
    """All URDF files of example-robot-data, but those without a moving body or with a moving link without mass."""
    package = Path(pytest.importorskip("pinocchio").__file__).parents[4]
    found = sorted(package.glob("share/example-robot-data/robots/**/*.urdf"))
    taken, refused = 0, []
    for file in found:
        path = tmp_path / "robot.toml"
        robot = f"robot = {{ file = {str(file)!r}, impossible = 'replace' }}"
        path.write_text(f'[model]\nspace = true\n{robot}\n[solver]\nstep = "1 ms"\n[simulate]\nend = 0.01\n')
        try:
            plan(load(path))
            taken += 1
        except (InputError, ModelError) as error:
            refused.append(str(error))
    assert all(any(words in sentence for words in REFUSED) for sentence in refused), refused
    assert taken >= 62


def test_the_reactions_of_torques_at_joints_are_those_of_inverse_dynamics(folder):
    """Along a simulated motion, inverse dynamics of its accelerations returns the torques."""
    tree = read_urdf(folder / "robot.urdf")
    system = tree.system([0.3, -0.7], [0.5, 0.2], slip=0.5, torques={"shoulder": 12.0, "elbow": -2.0})
    motion = simulate(tree.system([0.3, -0.7], [0.5, 0.2], slip=0.5, torques={"shoulder": 12.0, "elbow": -2.0}), 0.02,
                      solver=RungeKutta4(step=1e-3))  # fmt: skip
    assert len(system.loads) == 4  # two drives, two armatures
    q, v = (motion.channels([f"{name}.{what}" for name in ("shoulder", "elbow")]) for what in ("angle", "rate"))
    rates = np.array([np.polynomial.Polynomial.fit(motion.times, own, 6).deriv()(motion.times[10]) for own in v.T])
    torques = inverse_dynamics(tree, q[10:11], v[10:11], rates[None], slip=0.5)
    np.testing.assert_allclose(torques, [[12.0, -2.0]], atol=1e-4)


def test_bodies_have_the_shapes_of_all_their_links(folder):
    system = read_urdf(folder / "robot.urdf").with_fixed_joints({"elbow": np.pi / 2}).system()
    (body,) = system.bodies
    assert [shape.kind for shape in body.shapes] == ["box", "cylinder"]
    # 0.4 m along x, then turned by 90 degrees about y: x of the lower link is -z
    np.testing.assert_allclose(body.shapes[1].pose.position, [0.4, 0.06, -0.15], atol=1e-15)


def test_the_template_is_identified_and_predicts_the_other_motion(folder, tmp_path):
    true = {"lower.first_x": 1.9 * 0.17, "lower.first_z": 1.9 * 0.02, "elbow.damping": 0.24, "elbow.friction": 0.5}
    run, outcome = run_study(load(folder / "arm.toml"), tmp_path / "run")
    assert outcome.success
    found = outcome.result
    deviations = dict(zip(found.inertias.base.base, found.inertias.base_deviations, strict=True))
    for name, value in true.items():
        assert abs(outcome.best["values"][name] - value) < 3 * deviations[name]
    assert outcome.best["values"]["prediction / noise"] == found.ratios.max() < found.most
    page = read_page(run.report)
    assert "The torques of the unseen motion are predicted as exactly as the noise allows" in page.text
    assert {"fitted-torques-1", "unseen-torques-2"} <= figures(found).keys()
    written = read_urdf(run.path / "identified.urdf")
    assert written.numbers["lower.mass"] == pytest.approx(found.inertias.estimates["lower.mass"])
    assert written.numbers["elbow.armature"] == pytest.approx(found.inertias.estimates["elbow.armature"])
    stored = TorquePrediction.load(run.result)
    np.testing.assert_array_equal(stored.ratios, found.ratios)
    assert stored.summary() == found.summary()
    run.report.unlink()
    report_run(run)
    assert run.report.is_file()


def test_a_prediction_beyond_the_noise_is_doubted(folder, tmp_path):
    path = folder / "arm.toml"
    path.write_text(path.read_text().replace('"elbow.torque" = "tau2"', '"elbow.torque" = "tau2"'))
    lines = (folder / "other.csv").read_text().splitlines()
    heavier = [",".join([*row.split(",")[:-1], str(1.2 * float(row.split(",")[-1]))]) for row in lines[1:]]
    (folder / "other.csv").write_text("\n".join([lines[0], *heavier]))
    outcome = run_study(load(path), tmp_path / "run")[1]
    (finding,) = [one for one in outcome.findings if one.code == "unseen-torques"]
    assert finding.values["joint"] == "elbow"
    assert "are not predicted: the rms error at joint 'elbow' is" in finding.message
    report(outcome.result, tmp_path / "page.html")


def test_zero_friction_is_not_identified_and_deviations_may_be_given(folder, tmp_path):
    path = folder / "arm.toml"
    text = path.read_text().replace("slip = 0.05", 'slip = 0.05\nnumbers = { "elbow.friction" = 0 }')
    path.write_text(text.replace('unseen = "other.csv"', "deviations = { shoulder = 0.2, elbow = 0.05 }"))
    outcome = run_study(load(path), tmp_path / "run")[1]
    assert "elbow.friction" not in outcome.result.inertias.names
    assert outcome.result.inertias.noise.tolist() == [0.2, 0.05]
    assert not len(outcome.result.ratios)


def test_an_exciting_motion_keeps_the_limits_and_is_written(folder, tmp_path):
    path = folder / "excite.toml"
    path.write_text(
        '[model]\nspace = true\nrobot = { file = "robot.urdf", slip = 0.05 }\n[exciting_trajectory]\nperiod = 5.0\n'
        "evaluations = 20\nrate = 50.0\nvelocity = { elbow = 2.0 }\nacceleration = 15.0\npositions = { shoulder = [-0.5, 1] }\n"
    )
    assert "among 20 motions: no simulation" in plan(load(path))
    run, outcome = run_study(load(path), tmp_path / "run")
    assert outcome.success
    table = np.loadtxt(run.path / "motion.csv", delimiter=",", skiprows=1)
    assert table.shape == (251, 7)
    assert -0.5 <= table[:, 1].min() < table[:, 1].max() <= 1.0
    assert np.abs(table[:, 4]).max() <= 2.0
    assert np.abs(table[:, 5:]).max() <= 15.0
    assert (run.path / "motion.csv").read_text().startswith("t,shoulder.position,elbow.position,shoulder.velocity,")


@pytest.mark.parametrize(
    ("old", "new", "sentences"),
    [
        ('"lower.mass" =', '"lower.mas" =',
         ["[model.robot]: numbers: unknown number 'lower.mas'; did you mean 'lower.mass' or 'upper.mass'?"]),
        ("shoulder = \"20 deg\"", "sholder = 1.0",
         ["[model.robot]: positions: unknown joint 'sholder'; did you mean 'shoulder'?"]),
        ('input = "tau" }', 'input = "tau2" }', None),
        ('at = "lower.origin"', 'at = "lwer.origin"', None),
        ('"robot.urdf"', '"rob.urdf"', None),
    ],
)  # fmt: skip
def test_wrong_robots_get_a_sentence(folder, old, new, sentences):
    found = wrong(folder, SIMULATED.replace(old, new))
    if sentences is not None:
        assert found[: len(sentences)] == sentences
    else:
        assert new.split('"')[1] in found[0]


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('type="revolute"', 'type="ball"', "unknown type 'ball'"),
        ('<child link="lower"/>', '<child link="lowr"/>', "unknown child link 'lowr'"),
        ('<parent link="base"/>', '<parent link="lower"/>', "form a loop"),
    ],
)
def test_a_wrong_file_is_refused_with_its_line(folder, old, new, sentence):
    file = folder / "robot.urdf"
    file.write_text(file.read_text().replace(old, new, 1))
    (found,) = wrong(folder, SIMULATED)
    assert found.startswith("[model.robot]: file: ")
    assert sentence in found


def test_the_tasks_say_what_they_need(folder):
    text = (folder / "arm.toml").read_text()
    plane = '[model]\n[[model.body]]\nkind = "PointMass"\nname = "ball"\nmass = 1.0\n[exciting_trajectory]\nperiod = 1.0\nacceleration = 1.0\n'
    assert wrong(folder, plane) == [
        "[exciting_trajectory] needs a robot; name its URDF or MJCF file by [model.robot], file"
    ]
    assert wrong(folder, text.replace('"elbow.torque" = "tau2"', '"elbow.angl" = "tau2"')) == [
        "[data], columns: no column is given for 'elbow.torque'",
        "[data], columns: unknown channel 'elbow.angl'; did you mean 'elbow.angle'?",
    ]
    assert wrong(folder, text.replace("cutoff", "deviations = { shoulder = 1.0, elbw = 1.0 }\ncutoff")) == [
        "[identify_inertias], deviations: unknown joint 'elbw'; did you mean 'elbow'?",
        "[identify_inertias], deviations: none is given for joint 'elbow'",
    ]
    free = folder / "robot.urdf"
    free.write_text(free.read_text().replace('lower="-2.5" upper="2.5"', 'lower="-inf" upper="inf"'))
    text = '[model]\nspace = true\nrobot = { file = "robot.urdf" }\n[exciting_trajectory]\nperiod = 5.0\nacceleration = { elbow = 1.0 }\n'
    assert wrong(folder, text) == [
        "[exciting_trajectory], acceleration: none is given for joint 'shoulder'",
        "[exciting_trajectory], positions: joint 'elbow' has no limits in the file; give its lower and its upper one",
    ]


def test_a_filter_that_does_not_fit_is_refused_before_a_run(folder):
    path = folder / "arm.toml"
    path.write_text(path.read_text().replace("12.5 Hz", "30 Hz"))
    with pytest.raises(
        InputError, match=r"^\[data\]: lowpass: the cutoff frequency is 30 Hz and the sampling rate 50 Hz"
    ):
        plan(load(path))


def inertias(folder, *changes):
    text = (folder / "arm.toml").read_text()
    for before, after in changes:
        assert before in text
        text = text.replace(before, after, 1)
    (folder / "changed.toml").write_text(text)
    return load(folder / "changed.toml")


DATA_FILE = 'file = "motion.csv"'


def test_an_unseen_motion_is_read_whole(folder):
    """The range and the start of the data are those of one record."""
    whole = records(inertias(folder))
    part = records(inertias(folder, (DATA_FILE, f"{DATA_FILE}\nbetween = [1.0, 3.0]\nstart = 0.5")))
    even = '{ start = 0.0, end = 2.0, every = "20 ms" }'
    splined = records(inertias(folder, (DATA_FILE, f"{DATA_FILE}\nresample = {even}")))
    assert len(part[0][0]) < len(whole[0][0])
    np.testing.assert_array_equal(part[1][2], whole[1][2])
    assert len(splined[1][0]) >= len(whole[1][0]) - 1


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            (DATA_FILE, f'{DATA_FILE}\nunits = {{ tau1 = "mm" }}'),
            "torque': the unit 'mm' was given; expected that of a torque",
        ),
        (
            ('cutoff = "12.5 Hz"', 'cutoff = "12.5 Hz"\ndeviations = "1 s"'),
            "deviations, shoulder: '1 s' was given; expected a torque",
        ),
        (
            (DATA_FILE, f'{DATA_FILE}\nmore = [{{ file = "other.csv", columns = {{ x = "q1" }} }}]'),
            "unseen: the data have further files",
        ),
    ],
)
def test_torques_and_deviations_have_units_of_torques(change, sentence, folder):
    with pytest.raises((InputError, DataError)) as caught:
        records(inertias(folder, change))
    assert sentence in str(caught.value)
