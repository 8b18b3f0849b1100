"""The drawing of a study's model: its parts, their tables, the pose at the values of parameters, and what is wrong."""

import re
from base64 import b64decode

import numpy as np
import pytest

from dalembert.studio.editor.reading import read
from dalembert.studio.model.parts import parts_at, place_of
from dalembert.studio.model.picture import NOTHING, Picture, model_picture
from dalembert.studio.worker import Kept
from dalembert.study.template import templates

IDENTIFY = templates()["identify"].text
SWING = IDENTIFY.partition("[data]")[0] + "[simulate]\nend = 1.0\n"
LOOP = """
[parameters]
wire = { lower = 1, upper = 5, start = 2 }
[model]
[[model.body]]
kind = "RigidBar"
name = "rod"
length = 1
mass = 1
angle = 1
[[model.joint]]
kind = "RevoluteJoint"
name = "left"
a = "ground(0, 0)"
b = "rod.start"
[[model.joint]]
kind = "DistanceJoint"
name = "right"
a = "ground(2, 0)"
b = "rod.end"
length = "wire"
[solver]
step = 0.01
[simulate]
end = 1
"""
CURVE = """
from dalembert.forward import PythonModel

def build(parameters):
    return PythonModel(lambda rate: [rate, rate], parameters, ["x"], [0.0, 1.0])
"""


@pytest.fixture
def draw(tmp_path):
    """Draw a text at the start values, or at others."""

    def draw(text: str, template: str = "", box=None, **values: float) -> Picture:
        path = tmp_path / "study.toml"
        for name, content in (templates()[template].files if template else {}).items():
            (tmp_path / name).write_text(content)
        study = read(path, text).study
        start = {} if study is None else study.parameters.mapping(study.parameters.start)
        return model_picture(Kept(), path, text, {**start, **values}, box)

    return draw


def parts(svg: str) -> list[str]:
    """Roles and names of the parts of a drawing."""
    return [f"{role} {name}" for role, name in re.findall(r'<g class="(\w+)" data-part="([^"]*)"', svg)]


def test_each_part_is_drawn_and_has_its_table(draw):
    picture = draw(IDENTIFY, "identify")
    assert sorted(parts(picture.svg)) == [
        "body rod",
        "channel rod.end.x",
        "gravity gravity",
        "joint pin",
        "measured rod.end",
        "point rod.end",
    ]
    assert picture.places["joint pin"] == ("model", "joint", 0)
    assert picture.places["channel rod.end.y"] == ("data",)
    assert place_of(picture.places, "point rod.end") == ("model", "structure")
    assert 'role="button" aria-label="body rod"' in picture.svg
    assert (picture.message, picture.mistake, picture.scene) == ("", "", None)


def test_the_pose_is_that_of_the_values(draw):
    level, hanging = (draw(SWING, "identify", angle=angle).box for angle in (0.0, -np.pi / 3))
    length = 0.8
    assert np.ptp(level, axis=0)[0] == pytest.approx(1.18 * length)
    assert np.ptp(hanging, axis=0) == pytest.approx(length * (np.array([0.5, 3**0.5 / 2]) + 0.18 * 3**0.5 / 2))


def test_a_drawing_that_moves_stands_still(draw):
    first = draw(SWING, "identify", angle=-0.7)
    assert draw(SWING, "identify", first.box, angle=-0.75).box is first.box
    assert draw(SWING, "identify", first.box, angle=-1.0).box is not first.box


def test_measured_positions_are_drawn_near_the_model(draw):
    picture = draw(IDENTIFY, "identify")
    ((_, commands),) = re.findall(
        r'data-part="(rod.end)"[^>]*><title>[^<]*</title><path d="([^"]*)"[^>]*stroke-width="1"', picture.svg
    )
    assert commands.count("M") == 2 * 81  # two strokes a sample
    assert picture.places["measured rod.end"] == ("data",)
    assert np.ptp(picture.box, axis=0)[0] > 1.18 * 0.8
    wrong = draw(IDENTIFY.replace("[data]", '[data]\nunits = { x = "km", y = "km" }'), "identify")
    assert "measured rod.end" not in parts(wrong.svg)
    assert wrong.message == "Measured positions of rod.end are far from the model and not drawn. Check their unit."


def test_parts_of_structures_have_their_tables(draw):
    picture = draw(templates()["response"].text, "response")
    assert {part: place_of(picture.places, part) for part in parts(picture.svg)} == {
        "spring m – ground": ("model", "spring", 0),
        "contact slider": ("model", "contact", 0),
        "body m": ("model", "mass", 0),
        "force m": ("model", "force", 0),
    }


def shapes_of(scene) -> dict[tuple[str, str], np.ndarray]:
    """Points by kind and part of an encoded scene."""
    numbers, first, points = np.frombuffer(b64decode(scene["positions"]), "<f4"), 0, {}
    for shape in scene["shapes"]:
        size = 3 * shape["count"]
        part = f"{shape['role']} {shape['name']}"
        points[shape["kind"], part] = numbers[first : first + size].reshape(-1, 3)
        first += size
    return points


def test_a_mechanism_in_space_has_a_scene(draw):
    scene = draw(templates()["spatial"].text, "spatial").scene
    points = shapes_of(scene)
    assert {part for _, part in points} >= {"body plate", "joint wire1", "load air", "channel plate.first.x"}
    first, second = points["dashes", "joint wire1"]
    assert np.linalg.norm(second - first) == pytest.approx(1.2, abs=1e-6)
    assert scene["gravity"] == [0.0, 0.0, -1.0]
    assert points["ground", "joint wire1"] == pytest.approx(np.array([[0.15, 0.0, 0.0]]))


def test_a_robot_belongs_to_its_table(draw):
    picture = draw(templates()["robot"].text, "robot")
    assert place_of(picture.places, "body upper") == ("model", "robot")
    assert any(shape["kind"] == "surface" for shape in picture.scene["shapes"])


def test_the_parts_of_a_robot_are_chosen_by_its_table(draw):
    picture = draw(templates()["robot"].text, "robot")
    whole = parts_at(picture.places, ("model", "robot"), picture.parts)
    assert {"body upper", "joint shoulder"} <= set(whole)
    assert "ground" not in whole
    one = parts_at(picture.places, ("model", "robot", "positions", "shoulder"), picture.parts)
    assert one == ["joint shoulder"]


def test_drives_of_a_robot_do_not_crowd_its_joints(draw):
    names = draw(templates()["robot"].text, "robot").scene["labels"]
    places = [tuple(np.round(name["at"], 6)) for name in names if name["role"] != "channel"]
    assert len(set(places)) == len(places)


def test_what_cannot_be_assembled_is_drawn_as_placed(draw):
    assert draw(LOOP).mistake == ""
    picture = draw(LOOP, wire=5.0)
    assert "body rod" in parts(picture.svg)
    assert picture.message == "Drawn as placed: the mechanism cannot be assembled."
    assert "has a gap" in picture.mistake


def test_a_model_without_a_shape_says_so(draw, tmp_path):
    (tmp_path / "curve.py").write_text(CURVE)
    text = '[parameters]\nrate = { lower = 1, upper = 2 }\n[model]\nforward = "curve.py:build"\n[sweep]\nat = 1.0\n'
    picture = draw(f'{text}channels = ["x"]\nover = {{ rate = {{ count = 5 }} }}\n')
    assert (picture.svg, picture.message) == ("", NOTHING)


def test_parts_at_a_place():
    places = {"": ("model",), "body rod": ("model", "body", 0), "body disc": ("model", "body", 1)}
    assert parts_at(places, ("model", "body", 1, "mass")) == ["body disc"]
    assert parts_at(places, ("model", "body")) == ["body rod", "body disc"]
    assert parts_at(places, ("model",)) == []
    assert parts_at(places, None) == []
