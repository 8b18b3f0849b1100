"""Every kind of component is in the drawing of its model, or in the list below it."""

import re
from html import unescape

import numpy as np
import pytest

import dalembert.multibody.spatial as sp
from dalembert.multibody.motion.sketch import sketch
from dalembert.report.pictures.svg import scene_picture
from dalembert.report.player.film import encoded
from dalembert.report.scene.mechanism import mechanism_scene
from dalembert.report.scene.scene import MOST_LABELS, Label, readable
from dalembert.report.scene.structure import structure_scene
from dalembert.structure import Material, box, solid
from dalembert.studio.model.parts import absent_parts, place_of
from dalembert.studio.model.picture import model_picture
from dalembert.studio.worker import Kept
from dalembert.study.loader import load
from dalembert.study.tables.catalogue import kinds_of, structure_parts
from dalembert.vibration import HarmonicForce, VibrationSystem
from mechanisms import PIECES, mechanism
from spatial_scenes import SCENES, two_rods


def wind(t, at, against):
    """A force and a torque that change over time."""
    return np.cos(t), 0.0, 1.0, 0.0, 0.0, 0.1


def driven() -> sp.SpatialSystem:
    """Two rods with the kinds that no other scene has."""
    system, first, second = two_rods(on_ball=None)
    system.add(sp.SphericalJoint("hold", system.ground, first.point("origin")))
    system.add(sp.RevoluteJoint("pin", first.point("end"), second.point("origin"), axis=(0.0, 1.0, 0.0)))
    system.add(sp.Armature("drive", first.point("end"), second.point("origin"), 0.1, axis=(0.0, 1.0, 0.0)))
    system.add(sp.UserForce("wind", second.point("tip"), wind))
    return system


PLANE = {name: lambda name=name: mechanism(name) for name in PIECES}
SPACE = {name: lambda build=build, fields=fields: build(**fields) for name, (build, fields) in SCENES.items()}
SPACE["driven"] = driven
LISTS = {"body": "bodies", "joint": "joints", "load": "loads"}


def drawn(svg: str) -> set[str]:
    """Roles and names of the parts of a drawing."""
    return {f"{role} {unescape(name)}" for role, name in re.findall(r'<g class="(\w+)" data-part="([^"]*)"', svg)}


def missing(system) -> set[str]:
    """Components that the drawing, or the scene, does not show."""
    scene = mechanism_scene(sketch(system, assemble=False))
    shown = drawn(scene_picture(scene, "Drawing", choosable=True))
    if scene.dimensions == 3:
        shown &= {f"{shape['role']} {shape['name']}" for shape in encoded(scene)["shapes"]}
    return {f"{role} {part.name}" for role, parts in LISTS.items() for part in getattr(system, parts)} - shown


@pytest.mark.parametrize(
    "make", [*PLANE.values(), *SPACE.values()], ids=[*PLANE, *(f"{name}, space" for name in SPACE)]
)
def test_every_component_of_a_mechanism_is_drawn(make):
    assert missing(make()) == set()


@pytest.mark.parametrize("space", [False, True], ids=["plane", "space"])
def test_the_mechanisms_above_have_all_kinds(space):
    systems = [make() for make in (SPACE if space else PLANE).values()]
    known = {type(part) for system in systems for parts in LISTS.values() for part in getattr(system, parts)}
    kinds = {kind for role in LISTS for kind in kinds_of(role, space=space)}
    kinds = {kind for kind in kinds if kind.__module__.startswith("dalembert.")}  # other tests define some
    assert {kind.__name__ for kind in kinds - known} <= {"RigidBarBetween"}  # which makes a RigidBar


@pytest.mark.parametrize("follower", [False, True])
def test_a_force_has_an_arrow_along_its_direction(follower):
    system = mechanism("follower force" if follower else "force")
    own = sketch(system, assemble=False)
    load = next(load for load in system.loads if load.at.body.name.endswith("p"))  # on a plate at 0.3 rad
    turn = 0.3 if follower else 0.0
    size = np.array([2.0, 2.0] if follower else [2.0, 3.0])
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    assert own.forces[load.name] == pytest.approx(rotation @ size)


def test_a_follower_force_in_space_turns_with_its_marker():
    build, fields = SCENES["follower force"]
    system = build(**fields)
    own = sketch(system, assemble=False)
    (load,) = [load for load in system.loads if load.name in own.forces]
    axes = own.drawing.axes[load.at.body.name][0, 1:].T @ load.at.body.marker(load.at.name).axes
    size = [getattr(getattr(load, axis), "value", getattr(load, axis)) for axis in "xyz"]
    size = np.array([getattr(one, "amplitude", one) for one in size], dtype=float)
    assert own.forces[load.name] == pytest.approx(axes @ size)
    assert own.forces[load.name] != pytest.approx(size)
    arrow = next(shape for shape in mechanism_scene(own).primitives if shape.kind == "arrow")
    assert arrow.along == pytest.approx(own.forces[load.name] / np.linalg.norm(size))


STRUCTURE = """
[model]
mass = [{ name = "m", mass = 1.0 }, { name = "n", mass = 1.0 }]
force = [{ dof = "m", amplitude = 1.0 }, { dof = "m", amplitude = 2.0, harmonic = 3 }]
[[model.spring]]
first = "m"
stiffness = 4.0
[[model.spring]]
first = "m"
second = "n"
stiffness = 4.0
[[model.spring]]
kind = "CubicSpring"
name = "hard"
first = "m"
second = "n"
stiffness = 1.0
[[model.contact]]
name = "slider"
first = "m"
friction = 0.3
preload = 1.0
law = { kind = "ElasticSlider", tangential_stiffness = 2.0 }
[frequency_response]
frequencies = [0.2, 0.25]
observe = ["n"]
"""


def test_every_table_of_a_structure_is_drawn_or_listed(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STRUCTURE)
    study = load(path)
    picture = model_picture(Kept(), path, STRUCTURE, {})
    tables = {
        ("model", table, number)
        for table in structure_parts()
        for number in range(len(getattr(study.file.model, table)))
    }
    shown = {place_of(picture.places, part) for part in (*drawn(picture.svg), *picture.absent)}
    assert tables <= shown
    assert picture.absent == ("force m (2)",)
    assert {"spring hard", "contact slider", "channel n"} <= drawn(picture.svg)


def test_what_is_not_drawn_is_listed_once_a_table():
    places = {"": ("model",), "body a": ("model", "body", 0), "channel e": ("data",), "channel f": ("data",)}
    assert absent_parts(places, {"channel e"}) == ["body a", "channel f"]


def test_channels_and_forces_keep_their_labels_where_contacts_have_too_many():
    counts = (("contact", 32), ("channel", 3), ("force", 2))
    labels = [Label(role, str(k), np.zeros(3), "") for role, count in counts for k in range(count)]
    parts = [label.part for label in readable(labels)]
    assert parts == ["channel 0", "channel 1", "channel 2", "force 0", "force 1"]
    few = labels[:MOST_LABELS]
    assert readable(few) == tuple(few)


def test_a_structure_shows_its_mesh_and_pulls_at_its_faces():
    plate = solid(box((0.2, 0.1, 0.02), (2, 2, 1)), Material(210e9, 0.3, 7800.0))
    system = VibrationSystem(plate)
    system.add(HarmonicForce(f"{plate.nodes.names[0]}.z", 1.0))
    mesh, outline, arrow = structure_scene(system).primitives
    assert mesh.faces.shape == (16, 4)
    assert outline.points.shape == (1, 2 * 20, 3)  # twelve edges of the box, eight of them of two elements
    assert (arrow.kind, arrow.role, arrow.along.tolist()) == ("arrow", "force", [0.0, 0.0, 1.0])
