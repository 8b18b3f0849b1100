"""Mechanisms in space as study files write them: what is understood, and every sentence about what cannot be."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import wires
from dalembert.errors import InputError
from dalembert.multibody.spatial import Inertia, Orientation, SpatialSystem
from dalembert.study import json_schema, load, plan, run_study
from dalembert.study.template import begin, templates
from json_schemas import fits

STUDY = """
[parameters]
J = { lower = 0.05, upper = 0.1 }
[constants]
R = "150 mm"
[model]
space = true
gravity = [0, 0, "-10 m/s^2"]
[[model.body]]
kind = "RigidBody"
name = "plate"
inertia = { mass = "3 kg", moments = ["J/2", "J/2", "J"] }
position = [0, 0, "-R"]
orientation = { axes = "z", angles = "90 deg" }
points = { a = ["R", 0, 0] }
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = { position = ["R", 0, 0], orientation = { z = [0, 2, 0], x = [0, 0, 1] } }
b = "plate.a"
[[model.load]]
kind = "Force"
name = "push"
at = "plate.centre"
x = { kind = "Harmonic", amplitude = "J", angular_frequency = "60 rpm" }
[solver]
step = "1 ms"
[simulate]
end = "1 s"
"""
INERTIA = '{ mass = "3 kg", moments = ["J/2", "J/2", "J"] }'
TURNED = '{ axes = "z", angles = "90 deg" }'
SIDE = '{ position = ["R", 0, 0], orientation = { z = [0, 2, 0], x = [0, 0, 1] } }'
HEAD = "[[model.body]] 'plate'"
WAYS = (
    "expected axes with angles, such as axes = 'zyx' and angles = ['10 deg', 0, 0], or quaternion, or rotation_vector, "
    "or z, which may have x beside it"
)


@pytest.fixture
def write(tmp_path):
    def write(*changes: tuple[str, str]) -> Path:
        text = STUDY
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "study.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_a_mechanism_in_space_is_a_function_of_its_parameters(write):
    system = load(write()).builder(J=0.08)
    (plate,), (pin,), (push,) = system.bodies, system.joints, system.loads
    assert isinstance(system, SpatialSystem)
    assert system.gravity == (0.0, 0.0, -10.0)
    assert plate.inertia == Inertia(3.0, (0.04, 0.04, 0.08))
    assert plate.place.position == (0.0, 0.0, -0.15)
    np.testing.assert_allclose(plate.orientation.matrix, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)
    assert pin.a.position == (0.15, 0.0, 0.0)
    np.testing.assert_allclose(pin.a.orientation.matrix, [[0, 1, 0], [0, 0, 1], [1, 0, 0]], atol=1e-15)
    assert str(pin.b) == "plate.a"
    assert push.x.amplitude == 0.08


def test_joints_begin_at_stated_coordinates(write):
    stated = 'space = true\npose = { pin = "10*J" }\nrates = { "pin.angle" = "60 rpm" }'
    aligned = '{ axes = "x", angles = "-90 deg" }'
    study = load(write(("space = true", stated), (TURNED, aligned)))
    assert study.builder(J=0.08).stated.coordinates == {("pin", "angle"): pytest.approx(0.8)}
    start = study.forward(["pin.angle", "pin.rate"], [0.0, 0.01]).evaluate([[0.08]]).only()[0, 0]
    np.testing.assert_allclose(start, [0.8, 2 * np.pi], atol=1e-12)


@pytest.mark.parametrize(
    ("stated", "sentence"),
    [
        ("3", "[model], pose: 3 was given; expected a table of joints, such as { pin = '30 deg' }"),
        (
            '{ pin = "fast" }',
            "[model.pose]: 'fast' was given, but unknown name 'fast'; known: J, R; expected an angle such as",
        ),
    ],
)
def test_what_a_pose_cannot_be(write, stated, sentence):
    assert any(sentence in line for line in wrong(write(("space = true", f"space = true\npose = {stated}"))))


def test_numbers_of_parts_carry_the_complex_step(write):
    turned = (TURNED, '{ rotation_vector = [0, 0, "J"] }')
    shape = (INERTIA, '{ kind = "tube", radius = "J", inner = 0.01, length = 1, density = "7.8 g/cm^3" }')
    (plate,) = load(write(turned, shape)).builder(J=0.06 + 1e-30j).bodies
    mass = 7800 * np.pi * (0.06**2 - 0.01**2)
    assert plate.inertia.mass.real == pytest.approx(mass, rel=1e-14)
    assert plate.inertia.mass.imag / 1e-30 == pytest.approx(7800 * np.pi * 2 * 0.06, rel=1e-14)
    assert plate.orientation.matrix[1, 0].imag / 1e-30 == pytest.approx(np.cos(0.06), rel=1e-14)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ('{ axes = "zyx", angles = ["10 deg", 0.2, "J"] }', Orientation.by_angles("zyx", [np.pi / 18, 0.2, 0.07])),
        ('{ axes = "XY", angles = [0.1, 0.2] }', Orientation.by_angles("XY", [0.1, 0.2])),
        ("{ quaternion = [1, 0, 0, 1] }", Orientation.by_angles("z", [np.pi / 2])),
        ('{ rotation_vector = [0, "30 deg", 0] }', Orientation.by_angles("y", [np.pi / 6])),
        ("{ z = [3, 0, 0] }", Orientation.by_axes((1, 0, 0))),
        ("{ z = [3, 0, 0], x = [0, 0, -1] }", Orientation.by_axes((1, 0, 0), (0, 0, -1))),
    ],
)
def test_every_way_to_write_an_orientation(write, given, expected):
    (plate,) = load(write((TURNED, given))).builder(J=0.07).bodies
    np.testing.assert_allclose(plate.orientation.matrix, expected.matrix, atol=1e-14)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (
            '{ kind = "moments", mass = 1, moments = [2, 3, 4], products = [0.1, 0.2, 0.3], centre = [0, 0, "1 cm"] }',
            Inertia(1.0, (2.0, 3.0, 4.0), (0.1, 0.2, 0.3), (0.0, 0.0, 0.01)),
        ),
        ('{ kind = "box", sides = [1, 2, 3], mass = 6 }', Inertia.box(6.0, (1.0, 2.0, 3.0))),
        ('{ kind = "box", sides = [1, 2, 3], density = 2 }', Inertia.box(12.0, (1.0, 2.0, 3.0))),
        ('{ kind = "sphere", radius = 2, density = 3 }', Inertia.sphere(32 * np.pi, 2.0)),
        ('{ kind = "cylinder", radius = 2, length = 3, density = 1 }', Inertia.cylinder(12 * np.pi, 2.0, 3.0)),
        (
            '{ kind = "tube", radius = 2, inner = 1, length = 3, density = 1 }',
            Inertia.cylinder(9 * np.pi, 2.0, 3.0, 1.0),
        ),
        (
            '{ kind = "box", sides = [1, 2, 3], mass = 6, centre = [0, 0, 1], orientation = { axes = "z", angles = "90 deg" } }',
            Inertia.box(6.0, (2.0, 1.0, 3.0)).moved((0.0, 0.0, 1.0)),
        ),
    ],
)
def test_every_way_to_write_an_inertia(write, given, expected):
    (plate,) = load(write((INERTIA, given))).builder(J=0.07).bodies
    np.testing.assert_allclose(plate.inertia.pseudo, expected.pseudo, rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize(
    ("given", "position"),
    [("[1, 2, 'J']", (1.0, 2.0, 0.07)), ("'ground(1, 2, 300 mm)'", (1.0, 2.0, 0.3)), ("'ground'", None)],
)
def test_places(write, given, position):
    (pin,) = load(write((SIDE, given))).builder(J=0.07).joints
    assert getattr(pin.a, "position", None) == position


def test_friction_has_the_units_of_its_joint(write):
    joint = 'b = "plate.a"\n'
    turning = write((joint, joint + 'friction = { viscous = "2 N*mm*s", coulomb = "1 N*mm", slip = "60 rpm" }\n'))
    (pin,) = load(turning).builder(J=0.07).joints
    assert (pin.friction.viscous, pin.friction.coulomb, pin.friction.slip) == pytest.approx((2e-3, 1e-3, 2 * np.pi))
    law = '\nfriction = { viscous = "2 N*s/mm", coulomb = "1 kN", slip = "1 mm/s" }\n'
    (slide,) = load(write(("RevoluteJoint", "PrismaticJoint"), (joint, joint + law))).builder(J=0.07).joints
    assert (slide.friction.viscous, slide.friction.coulomb, slide.friction.slip) == pytest.approx((2e3, 1e3, 1e-3))


def test_matrices_of_bushings(write):
    rows = "[" + ", ".join("[" + ", ".join(str(10 * (i == j)) for j in range(6)) + "]" for i in range(6)) + "]"
    bushing = f"""[[model.load]]
kind = "Bushing"
name = "rubber"
a = "ground"
b = "plate.a"
stiffness = ["1 kN/m", 2, 3, "4 N*m/rad", "5 N*mm/rad", "J"]
damping = {rows}
[solver]"""
    (_, rubber) = load(write(("[solver]", bushing))).builder(J=0.07).loads
    assert rubber.stiffness == (1e3, 2.0, 3.0, 4.0, 5e-3, 0.07)
    np.testing.assert_array_equal(rubber.damping, 10 * np.eye(6))


SENSOR = """[[model.load]]
kind = "InertialSensor"
name = "imu"
at = "plate.a"
acceleration_gain = GAIN
rate_gain = [["J", 0, 0.1], [0, 1, 0], [0, 0, "2*J"]]
[solver]"""


def test_gains_of_sensors(write):
    (_, imu) = load(write(("[solver]", SENSOR.replace("GAIN", '[1, "J", 0.9]')))).builder(J=0.07 + 1e-30j).loads
    np.testing.assert_array_equal(imu.acceleration_gain, [1, 0.07 + 1e-30j, 0.9])
    np.testing.assert_array_equal(imu.rate_gain, [[0.07 + 1e-30j, 0, 0.1], [0, 1, 0], [0, 0, 0.14 + 2e-30j]])


COUPLED = """[[model.joint]]
kind = "ScrewJoint"
name = "thread"
a = "ground"
b = "plate.centre"
lead = "4 mm"
[[model.joint]]
kind = "GearJoint"
name = "gear"
a = "pin"
b = "thread"
ratio = "-J"
[[model.load]]
kind = "AngleLimit"
name = "stop"
joint = "pin"
upper_limit = "720 deg"
stiffness = "3 N*m/deg^1.5"
[[model.load]]"""


def test_couplings_and_limits_refer_to_joints(write):
    system = load(write(("[[model.load]]", COUPLED))).builder(J=0.07)
    pin, thread, gear = system.joints
    assert thread.lead == 0.004
    assert (gear.a, gear.b, gear.ratio) == (pin, thread, -0.07)
    assert (system.loads[0].joint, system.loads[0].upper_limit) == (pin, 4 * np.pi)
    assert system.loads[0].stiffness == pytest.approx(3 * (180 / np.pi) ** 1.5)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            ('b = "thread"', 'b = "tread"'),
            "[[model.joint]] 'gear', b: 'tread' was given; unknown joint 'tread'; did you",
        ),
        (('a = "pin"', 'a = "gear"'), "'gear' was given; unknown joint 'gear'; known: pin, thread; a joint must stand"),
        (('joint = "pin"', "joint = 3"), "'stop', joint: 3 was given; expected the name of a joint, such as 'pin'"),
    ],
)
def test_wrong_names_of_joints(write, change, message):
    (line,) = wrong(write(("[[model.load]]", COUPLED.replace(*change))))
    assert message in line


def wrong(path: Path) -> list[str]:
    with pytest.raises(InputError) as caught:
        plan(load(path))
    return [line.removeprefix("study.toml: ") for line in str(caught.value).split("\n")]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("space = true", ""), "[model]: its components are those of a mechanism in space; write space = true"),
        (
            ("space = true", "space = 1"),
            "[model]: its components are those of a mechanism in space; write space = true",
        ),
        (
            ("gravity = [0, 0, ", "gravity = [0, "),
            "[model], gravity: [0, '-10 m/s^2'] was given; expected three numbers, along x, y and z, since the "
            "mechanism is in space (space = true)",
        ),
        (
            ("RigidBody", "RigidBar"),
            f"{HEAD}: 'RigidBar' is a planar component, and the model is in space (space = true); expected one of "
            "Beam, Cable, PointMass, ReducedBody, RigidBody",
        ),
        ((INERTIA, "2"), f"{HEAD}, inertia: 2 was given; expected a table"),
        (
            (INERTIA, '{ kind = "cone" }'),
            f"{HEAD}, inertia: unknown kind 'cone'; known: box, cylinder, moments, sphere, tube",
        ),
        (
            (INERTIA, '{ kind = "box", sides = [1, 2, 3] }'),
            f"{HEAD}, inertia: neither mass nor density given; give either a mass or a density",
        ),
        (
            (INERTIA, '{ kind = "sphere", radius = 1, mass = 1, density = 1 }'),
            f"{HEAD}, inertia: both mass and density given; give either a mass or a density",
        ),
        (
            (INERTIA, '{ kind = "tube", radius = 1, inner = 2, length = 1, density = 1 }'),
            f"{HEAD}, inertia: inner is 2.0 m and radius 1.0 m; expected a smaller inner radius",
        ),
        (
            (INERTIA, '{ mass = 1, moments = ["1 kg", 1, 1] }'),
            f"{HEAD}, inertia, moments, entry 1: '1 kg' was given; expected a moment of inertia such as "
            "'120 kg*cm^2' or 0.012 in kg*m^2",
        ),
        ((TURNED, '"zyx"'), f"{HEAD}, orientation: 'zyx' was given; expected a table"),
        ((TURNED, "{}"), f"{HEAD}, orientation: nothing given; {WAYS}"),
        ((TURNED, '{ axes = "z" }'), f"{HEAD}, orientation: axes given; {WAYS}"),
        ((TURNED, "{ angles = 1 }"), f"{HEAD}, orientation: angles given; {WAYS}"),
        (
            (TURNED, "{ z = [1, 0, 0], quaternion = [1, 0, 0, 0] }"),
            f"{HEAD}, orientation: quaternion and z given; {WAYS}",
        ),
        (
            (TURNED, '{ axes = "zyx", angles = 1 }'),
            f"{HEAD}, orientation: Orientation: 1 angles for the axes 'zyx'; expected 3",
        ),
        (
            (TURNED, '{ axes = "z", angles = "1 m" }'),
            f"{HEAD}, orientation, angles: '1 m' was given; expected an angle such as '45 deg' or 0.785398 in rad",
        ),
        (
            (SIDE, "[1, 2]"),
            "[[model.joint]] 'pin', a: [1, 2] was given; expected x, y and z in m, such as 'ground(0.3, 0, 1)'",
        ),
        (
            (SIDE, "3"),
            "[[model.joint]] 'pin', a: 3 was given; expected a point such as 'ground', 'OA.end', 'ground(0.3, 0, 1)', "
            "[0.3, 0.0, 1.0] or { position = [0.3, 0.0, 1.0], orientation = {} }",
        ),
        ((SIDE, '"disc.a"'), "[[model.joint]] 'pin', a: 'disc.a' was given; unknown body 'disc'; known: plate"),
        (('kind = "Force"', 'kind = "Bushing"\na = "ground"\nb = "plate.a"\nstiffness = [1, 2]'), ""),
    ],
)
def test_each_mistake_has_its_place(write, change, message):
    lines = wrong(write(change))
    if message:
        assert lines == [message]
    else:
        assert (
            "[[model.load]] 'push', stiffness: [1, 2] was given; expected six numbers, or six rows of six numbers"
            in lines
        )


@pytest.mark.parametrize(
    ("gain", "message"),
    [
        ("[1, 2]", "[1, 2] was given; expected three numbers, or three rows of three numbers"),
        (
            "[[1, 2], [3, 4], [5, 6]]",
            "[[1, 2], [3, 4], [5, 6]] was given; expected three numbers in each of the three rows",
        ),
    ],
)
def test_gains_of_the_wrong_shape(write, gain, message):
    lines = wrong(write(("[solver]", SENSOR.replace("GAIN", gain))))
    assert lines == [f"[[model.load]] 'imu', acceleration_gain: {message}"]


def test_a_component_in_space_is_refused_in_the_plane(write):
    lines = wrong(write(("space = true", ""), ("RevoluteJoint", "UniversalJoint"), ("Force", "Motor")))
    # Other tests may have registered joints of their own, which the end of the sentence lists.
    assert any(
        line.startswith(
            "[[model.joint]] 'pin': 'UniversalJoint' is a component in space, and the model is planar without "
            "space = true; expected one of DistanceJoint, FixedJoint, GearJoint, PrescribedMotion, PrismaticJoint, "
        )
        for line in lines
    )
    assert (
        "[model], gravity: [0, 0, '-10 m/s^2'] was given; expected two numbers, along x and y; a mechanism in space has "
        "space = true in [model]"
    ) in lines


def test_a_planar_study_imports_nothing_of_space(tmp_path):
    path = begin("motion", tmp_path / "motion")
    code = f"import sys; from dalembert.study import load; load({str(path)!r}).system(); print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "dalembert.multibody.components.planar.rigid_bar" in run.stdout.split()
    assert not [name for name in run.stdout.split() if name.startswith("dalembert.") and "spatial" in name]


def test_space_needs_components(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text("[model]\nspace = true\n[solver]\nstep = 0.1\n[simulate]\nend = 1.0\n")
    assert wrong(path) == [
        "[model]: space belongs to a model of [[model.body]] tables or of a robot, and there is none"
    ]


def test_a_function_may_return_a_mechanism_in_space(tmp_path):
    (tmp_path / "own.py").write_text(
        "from dalembert.multibody.spatial import PointMass, SpatialSystem\n\n\n"
        "def ball():\n    system = SpatialSystem()\n    system.add(PointMass('ball', 1.0))\n    return system\n"
    )
    path = tmp_path / "study.toml"
    path.write_text("[model]\nfunction = 'own.py:ball'\n[solver]\nstep = 0.1\n[simulate]\nend = 1.0\n")
    assert isinstance(load(path).system(), SpatialSystem)


def test_the_schema_fits_the_template_and_knows_what_is_wrong():
    schema = json_schema()
    for text in (templates()["spatial"].text, STUDY):
        assert fits(tomllib.loads(text), schema, schema)
    study = tomllib.loads(STUDY)
    study["model"]["body"][0]["angle"] = 1.0
    assert not fits(study, schema, schema)
    properties = schema["$defs"]["SpatialModelTable"]["properties"]
    known = {"file", "space", "gravity", "driving", "start", "pose", "rates", "body", "joint", "load", "robot"}
    assert properties.keys() == known


def test_the_template_holds_what_the_script_writes(tmp_path):
    """To two units of the last digit, since integrators differ between machines."""
    wires.main(tmp_path)
    text = templates()["spatial"].files["wires.csv"]
    written = (tmp_path / "wires.csv").read_text(encoding="utf-8")
    numbers = [np.array([row.split(",") for row in one.splitlines()[1:]], float) for one in (text, written)]
    np.testing.assert_allclose(*numbers, atol=2.1e-5, rtol=0)


@pytest.mark.slow
def test_the_template_finds_the_truth(tmp_path):
    study = begin("spatial", tmp_path / "plate")
    _, outcome = run_study(load(study), tmp_path / "fit")
    fit = outcome.result
    truth = {"moment": wires.MOMENT, "drag": wires.DRAG, "twist": wires.TWIST}
    for name, deviation in zip(fit.parameters.names, fit.deviations, strict=True):
        assert abs(fit.estimates[name] - truth[name]) < 3 * deviation
    assert outcome.success


def test_the_template_simulates_what_the_script_integrates(tmp_path):
    """By the task that stands in its comment."""
    path = begin("spatial", tmp_path / "plate")
    text = path.read_text(encoding="utf-8").partition("\n[data]\n")[0].replace("# [sim", "[sim")
    for key, value in {"moment": wires.MOMENT, "drag": wires.DRAG, "twist": wires.TWIST}.items():
        text = re.sub(rf"^{key} = {{.*$", f"{key} = {{ lower = {value}, upper = {value} }}", text, flags=re.MULTILINE)
    path.write_text(text.replace("# times", "times").replace("# points", "points"), encoding="utf-8")
    run, outcome = run_study(load(path), tmp_path / "motion")
    assert run.report.is_file()
    turned = wires.angle()
    exact = wires.RADIUS * np.column_stack([np.cos(turned), np.sin(turned)])
    np.testing.assert_allclose(outcome.result.channels(["plate.first.x", "plate.first.y"]), exact, atol=1e-5)


def test_displacements_of_joints_are_lengths(write):
    wrong_unit = wrong(write(("space = true", 'space = true\npose = { "pin.displacement_1" = "3 deg" }')))
    assert any("expected a length" in line for line in wrong_unit)
    no_such_coordinate = wrong(write(("space = true", 'space = true\npose = { "pin.displacement_1" = "3 cm" }')))
    assert any("unknown coordinate 'displacement_1'; known: angle" in line for line in no_such_coordinate)
