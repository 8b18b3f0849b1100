"""URDF files: what is read, what is listed, what is refused, what is written."""

import re
from dataclasses import replace
from pathlib import Path
from xml.dom import minidom

import numpy as np
import pytest

from dalembert.errors import InputError, ModelError
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.orientation import Orientation, Pose
from dalembert.multibody.trees import Link, Shape, Tree, TreeJoint, read_urdf, write_urdf
from dalembert.multibody.trees.urdf_writer import roll_pitch_yaw
from robot_files import ARM
from support import says

LISTED = re.compile(r"\((\d+) elements?, (\d+) attributes?\)$")


@pytest.fixture
def file(tmp_path):
    """Writes a text to a file, and returns its path."""

    def write(text: str = ARM) -> Path:
        path = tmp_path / "arm.urdf"
        path.write_text(text)
        return path

    return write


def numbers_of(tree: Tree) -> np.ndarray:
    """All numbers of a tree in one array."""
    found = []
    for link in tree.links:
        joint, shapes = link.joint, (*link.shapes, *link.collisions)
        poses = [link.joint.pose, *(shape.pose for shape in shapes)]
        for pose in poses:
            found += [*pose.position, *pose.orientation.matrix.ravel()]
        found += [*joint.axis, joint.lower, joint.upper, joint.velocity, joint.effort]
        found += [
            joint.damping,
            joint.friction,
            joint.armature,
            *(size for shape in shapes for size in shape.sizes),
        ]
        if link.inertia is not None:
            found += [link.inertia.mass, *link.inertia.centre, *link.inertia.tensor.ravel()]
    return np.array(found)


def words_of(tree: Tree) -> list:
    """All texts of a tree."""
    return [tree.name, tree.root, len(tree.shapes), len(tree.collisions)] + [
        (
            link.name,
            link.parent,
            link.joint.name,
            link.joint.kind,
            link.joint.mimic,
            link.inertia is None,
            *((shape.kind, shape.file) for shape in link.shapes),
            *((shape.kind, shape.file) for shape in link.collisions),
        )
        for link in tree.links
    ]


def test_numbers_of_a_file(file):
    tree = read_urdf(file())
    assert (tree.name, tree.root, tree.inertia.mass) == ("arm", "base", 7.0)
    assert [link.name for link in tree.links] == ["column", "slider", "wrist", "tool", "tip"]
    assert [joint.name for joint in tree.moving] == ["turn", "slide", "bend"]
    turn, slide, bend = tree.moving
    assert (turn.kind, turn.lower, turn.upper, turn.velocity, turn.effort) == ("revolute", -np.inf, np.inf, 2.0, 80.0)
    assert (turn.damping, turn.friction, turn.armature) == (0.7, 0.4, 0.35)
    assert (slide.kind, slide.axis, slide.lower, slide.upper) == ("prismatic", (2.0, 0.0, 1.0), -0.2, 0.4)
    assert (bend.lower, bend.upper, tree.link("tip").inertia) == (-2.0, 2.5, None)
    roll, pitch, yaw = 0.3, -0.2, 0.7
    x = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
    y = np.array([[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]])
    z = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    own = np.array([[0.11, 0.004, -0.003], [0.004, 0.12, 0.002], [-0.003, 0.002, 0.03]])
    assert np.allclose(tree.link("column").inertia.tensor, z @ y @ x @ own @ (z @ y @ x).T, rtol=0, atol=1e-16)
    assert tree.link("tool").shapes[0].file == "package://arm/meshes/tool.stl"
    assert tree.link("tool").shapes[0].sizes == (0.001, 0.001, 0.002)


def test_what_is_not_imported_is_listed(file):
    assert read_urdf(file()).unsupported == (
        "line 30: the mesh 'package://arm/meshes/tool.stl' of link 'tool' is not there, so it is not drawn",
        "contacts of collision shapes are not imported",
        "line 4: material 'grey' is not imported (2 elements, 2 attributes)",
        "line 7: attribute 'name' of <visual> of link 'base' is not imported",
        "line 7: <material> of link 'base' is not imported (1 element, 1 attribute)",
        "line 44: <safety_controller> of joint 'slide' is not imported (1 element, 1 attribute)",
        "line 53: <axis> of joint 'flange' is not imported (1 element, 1 attribute)",
        "line 56: transmission 'drive' is not imported (3 elements, 2 attributes)",
    )


def attributes_of(node):
    """All attributes of a document."""
    found = [] if node.attributes is None else list(node.attributes.values())
    return found + [own for child in node.childNodes for own in attributes_of(child)]


def test_no_attribute_is_dropped_silently(file):
    """A change of any attribute changes the tree, is listed, or is refused."""
    tree = read_urdf(file())
    for k in range(len(attributes_of(minidom.parseString(ARM)))):
        document = minidom.parseString(ARM)
        attribute = attributes_of(document)[k]
        attribute.value = (
            "-0.0123 0.3 0.7" if " " in attribute.value else attribute.value[:-1] + "78"[attribute.value[-1] == "7"]
        )
        try:
            changed = read_urdf(file(document.toxml()))
        except (InputError, ModelError):
            continue
        where = f"{attribute.ownerElement.tagName} {attribute.name}"
        same = words_of(changed) == words_of(tree) and np.array_equal(numbers_of(changed), numbers_of(tree))
        same = same and (changed.inertia, changed.shapes) == (tree.inertia, tree.shapes)
        own = attribute.ownerElement
        listed = any(f"attribute {attribute.name!r} of <{own.tagName}>" in one for one in tree.unsupported)
        while own.nodeType == own.ELEMENT_NODE:
            listed = listed or any(
                re.search(rf": <?{own.tagName}\b", one) and LISTED.search(one) for one in tree.unsupported
            )
            own = own.parentNode
        assert listed or not same, where


def test_written_files_are_read_as_the_same_tree(file, tmp_path):
    once = read_urdf(file())
    write_urdf(once, tmp_path / "again.urdf")
    again = read_urdf(tmp_path / "again.urdf")
    assert words_of(again) == words_of(once)
    assert np.allclose(numbers_of(again), numbers_of(once), rtol=0, atol=4e-16)
    assert [note for note in again.unsupported if "mesh" not in note] == [CONTACTS]
    assert (again.numbers, again.inertia) == (once.numbers, once.inertia)  # to the last bit


def test_identified_values_are_written(file, tmp_path):
    values = {"tool.mass": 0.123456789012345678, "slide.damping": 1 / 3, "wrist.inertia_xy": 1e-5, "bend.friction": 0.2}
    write_urdf(read_urdf(file()).with_numbers(values), tmp_path / "again.urdf")
    again = read_urdf(tmp_path / "again.urdf")
    assert {name: again.numbers[name] for name in values} == values


def test_all_kinds_of_limits_and_mimic_are_written(tmp_path):
    inertia = Inertia.box(1.0, (0.1, 0.2, 0.3))
    joints = [
        TreeJoint("free", "prismatic"),
        TreeJoint("half", lower=-1.0),
        TreeJoint("rated", "prismatic", velocity=2.0),
        TreeJoint("follower", lower=-1.0, upper=1.0, mimic=("half", -0.5, 0.1)),
    ]
    shapes = (Shape("sphere", (0.1,)), Shape("mesh", (1.0, 1.0, 1.0), file="missing.stl"))
    links = tuple(Link(f"link {joint.name}", "base", joint, inertia, shapes) for joint in joints)
    tree = Tree("all", "base", links, shapes)
    write_urdf(tree, tmp_path / "all.urdf")
    again = read_urdf(tmp_path / "all.urdf")
    assert again.links[1:2] == tree.links[1:2]
    assert again.links[3] == tree.links[3]
    assert again.links[0] == tree.links[0]
    assert again.shapes == tree.shapes
    assert again.links[2].joint.velocity == 2.0


@pytest.mark.parametrize("pitch", [0.3, np.pi / 2, -np.pi / 2, np.pi / 2 - 1e-9, 3.0])
def test_roll_pitch_and_yaw_of_a_matrix(pitch):
    matrix = Orientation.by_angles("XYZ", [0.4, pitch, -2.0]).matrix
    again = Orientation.by_angles("XYZ", roll_pitch_yaw(matrix)).matrix
    assert np.abs(again - matrix).max() < 1e-15


def test_floating_joints_are_fixed_and_listed(file):
    tree = read_urdf(file(ARM.replace('"turn" type="continuous"', '"turn" type="floating"')))
    assert [joint.name for joint in tree.moving] == ["slide", "bend"]
    sentence = "line 33: joint 'turn' is floating, which is not supported; it is fixed at its zero position"
    assert sentence in tree.unsupported


def test_the_omissions_on_which_the_motion_depends_are_marked(file):
    dynamics = '<dynamics damping="0.5" stiffness="3"/><dynamics friction="1"/>'
    text = ARM.replace("</robot>", '<gazebo reference="tool"/></robot>')
    text = text.replace('<joint name="turn" type="continuous">', f'<joint name="turn" type="continuous">{dynamics}')
    moving = [omission.text.partition(": ")[2] for omission in read_urdf(file(text)).omissions if omission.moves]
    assert moving[:2] == [
        "attribute 'stiffness' of <dynamics> of joint 'turn' is not imported",
        "<dynamics> of joint 'turn' is not imported (1 element, 1 attribute)",
    ]
    assert len(moving) <= 3  # ARM has <dynamics> too, which is then the third one


CONTACTS = "contacts of collision shapes are not imported"
SOLIDS = {
    "box": ('box size="0.1 0.2 0.3"', [("box", (0.1, 0.2, 0.3), 0.5)]),
    "cylinder": ('cylinder radius="0.1" length="0.4"', [("cylinder", (0.1, 0.4), 0.5)]),
    "sphere": ('sphere radius="0.1"', [("sphere", (0.1,), 0.5)]),
    "mesh": ('mesh filename="package://none/a.stl" scale="1 1 2"', [("mesh", (1.0, 1.0, 2.0), 0.5)]),
    "capsule": (
        'capsule radius="0.1" length="0.4"',
        [("cylinder", (0.1, 0.4), 0.5), ("sphere", (0.1,), 0.3), ("sphere", (0.1,), 0.7)],
    ),
}
BODY = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
CHAIN = """<robot name="r"><link name="base">{shape}</link><link name="arm">{body}{shape}</link><link name="tool">{shape}{shape}</link>
<joint name="pin" type="continuous"><parent link="base"/><child link="arm"/></joint>
<joint name="bolt" type="continuous"><parent link="arm"/><child link="tool"/></joint></robot>"""


@pytest.mark.parametrize("name", SOLIDS)
def test_collision_shapes_are_kept_and_written(file, tmp_path, name):
    """Through fixing of joints and new numbers; they are neither drawn nor do they change the motion."""
    text, solids = SOLIDS[name]
    collision = f'<collision><origin xyz="0 0 0.5" rpy="0 0 0.3"/><geometry><{text}/></geometry></collision>'
    tree = read_urdf(file(CHAIN.format(shape=collision, body=BODY)))
    assert tree.unsupported == (CONTACTS,)
    changed = tree.with_fixed_joints({"bolt": 0.3}).with_numbers({"arm.mass": 2.0})
    write_urdf(changed, tmp_path / "again.urdf")
    for robot in (tree, changed, read_urdf(tmp_path / "again.urdf")):
        assert not any((robot.shapes, *(link.shapes for link in robot.links)))
        parts = {robot.root: robot.collisions} | {link.name: link.collisions for link in robot.links}
        for link, repeats in (("base", 1), ("arm", 1), ("tool", 2)):
            own = [(shape.kind, shape.sizes, shape.pose.position[2]) for shape in parts[link]]
            assert [one[:2] for one in own] == [one[:2] for one in solids] * repeats
            np.testing.assert_allclose([one[2] for one in own], [one[2] for one in solids] * repeats, rtol=1e-15)
            turns = [shape.pose.orientation.matrix[1, 0] for shape in parts[link]]
            np.testing.assert_allclose(turns, np.sin(0.3), rtol=1e-15)
    assert all(body.surface is None for body in changed.system().bodies)


def test_collision_shapes_of_size_zero_are_left_out(file):
    collision = '<collision><geometry><box size="1 0 1"/></geometry></collision>'
    tree = read_urdf(file(CHAIN.format(shape="", body=BODY + collision)))
    assert tree.unsupported == ("line 1: the box of link 'arm' has a size of zero; it is left out",)
    assert tree.link("arm").collisions == ()


@pytest.mark.parametrize("shape", ['box size="0.1 0 0.2"', 'sphere radius="0"', 'cylinder radius="0" length="0.2"'])
def test_shapes_of_size_zero_are_left_out(file, shape):
    link = f'<link name="arm">{BODY}<visual><geometry><{shape}/></geometry></visual></link>'
    joint = '<joint name="pin" type="continuous"><parent link="base"/><child link="arm"/></joint>'
    tree = read_urdf(file(f'<robot name="r"><link name="base"/>{link}{joint}</robot>'))
    kind = shape.partition(" ")[0]
    assert tree.unsupported == (f"line 1: the {kind} of link 'arm' has a size of zero; it is not drawn",)
    assert tree.link("arm").shapes == ()


@pytest.mark.parametrize("encoding", ["foo", "utf-32", "shift_jis"])
def test_encodings_that_cannot_be_decoded_are_refused(tmp_path, encoding):
    path = tmp_path / "arm.urdf"
    path.write_text(f'<?xml version="1.0" encoding="{encoding}"?><robot name="r"><link name="a"/></robot>')
    with pytest.raises(InputError, match=r"the file cannot be decoded \(.*\)\. Save it as UTF-8$"):
        read_urdf(path)


REFUSED = {
    "wrong number": (
        'mass value="4"',
        'mass value="heavy"',
        "arm.urdf, line 12: link 'column': <mass>: value is 'heavy'; expected a finite number",
    ),
    "xacro": (
        'mass value="4"',
        'mass value="${m}"',
        "arm.urdf, line 12: link 'column': <mass>: value is '${m}'; expected a finite number. Convert the file by xacro first",
    ),
    "two numbers": (
        'box size="0.1 0.1 0.6"/></geometry></visual>',
        'box size="0.1 0.1"/></geometry></visual>',
        "arm.urdf, line 15: link 'column': <box>: size is '0.1 0.1'; expected 3 finite numbers",
    ),
    "missing attribute": (
        'cylinder radius="0.1"',
        "cylinder",
        "arm.urdf, line 7: link 'base': <cylinder> has no attribute 'radius'. Add it",
    ),
    "missing element": (
        '<mass value="4"/>',
        "",
        "arm.urdf, line 10: link 'column': <inertial> has no element <mass>. Add it",
    ),
    "unknown kind": (
        'type="revolute"',
        'type="revolut"',
        "arm.urdf, line 46: joint 'bend': unknown type 'revolut'; did you mean 'revolute'?",
    ),
    "missing link": (
        'child link="wrist"',
        'child link="wrst"',
        "arm.urdf, line 46: joint 'bend': unknown child link 'wrst'; did you mean 'wrist'?",
    ),
    "two parents": (
        'child link="tip"',
        'child link="tool"',
        "arm.urdf, line 55: joint 'end': its child 'tool' is that of joint 'flange' too (line 52). A link of a tree hangs on "
        "one joint; close loops by a joint of the SpatialSystem",
    ),
    "two roots": (
        '<link name="tip"/>',
        '<link name="tip"/><link name="spare"/>',
        "arm.urdf: 'base' and 'spare' are the child of no joint; expected one such link, the base. Add joints, or remove links",
    ),
    "loop": (
        'parent link="column"',
        'parent link="tool"',
        "arm.urdf: the joints 'bend', 'flange' and 'slide' form a loop. Remove one, and close the loop in the system",
    ),
    "same link": (
        '<link name="tip"/>',
        '<link name="tip"/><link name="tool"/>',
        "arm.urdf: link 'tool' is in lines 27 and 32. Give each link another name",
    ),
    "zero axis": (
        'axis xyz="2 0 1"',
        'axis xyz="0 0 0"',
        "arm.urdf, line 41: joint 'slide': <axis> is zero; expected a direction, such as 0 0 1",
    ),
    "exchanged limits": (
        'lower="-0.2"',
        'lower="0.9"',
        "arm.urdf, line 42: joint 'slide': <limit>: lower is 0.9 and upper is 0.4; expected lower not above upper",
    ),
    "negative damping": (
        'damping="3"',
        'damping="-3"',
        "arm.urdf, line 43: joint 'slide': <dynamics>: damping is -3; expected zero or more",
    ),
    "impossible inertia": (
        'ixx="0.002" iyy="0.001" izz="0.002"',
        'ixx="0.002" iyy="0.001" izz="0.004"',
        "arm.urdf, line 24: link 'wrist': <inertial>: Inertia: the principal moments are 0.001, 0.002, 0.004 kg m^2; the "
        "largest, about (0, 0, 1), is 0.001 larger than the sum of both others, which no body can have. Check moments and products, or "
        "read with impossible='replace'",
    ),
    "a leader that is not there": (
        '<axis xyz="0 1 0.2"/>',
        '<axis xyz="0 1 0.2"/><mimic joint="trun"/>',
        "arm.urdf, line 48: joint 'bend': <mimic>: unknown joint 'trun'; did you mean 'turn'?",
    ),
    "mass without a body": (
        '<mass value="0.8"/>',
        '<mass value="0"/>',
        "arm.urdf, line 24: link 'wrist': <inertial>: the mass is 0 kg with an inertia tensor that is not zero; expected a "
        "positive mass. Correct it, or read with impossible='replace'",
    ),
}


@pytest.mark.parametrize(("old", "new", "sentence"), REFUSED.values(), ids=REFUSED)
def test_refused_files(file, old, new, sentence):
    assert ARM.count(old) == 1
    with pytest.raises((InputError, ModelError), match=says(sentence)):
        read_urdf(file(ARM.replace(old, new)))


def test_files_that_are_missing_or_no_urdf(file, tmp_path):
    missing = tmp_path / "none.urdf"
    with pytest.raises(InputError, match=says(f"{missing}: there is no such file. Check the path")):
        read_urdf(missing)
    path = file("<robot><link></robot>")
    sentence = f"{path}, line 1: the file is no XML (mismatched tag). Expected a URDF file; convert xacro files first"
    with pytest.raises(InputError, match=says(sentence)):
        read_urdf(path)
    with pytest.raises(InputError, match=says(f"{path}: unknown outermost element 'mujoco'; known: robot")):
        read_urdf(file("<mujoco/>"))
    with pytest.raises(ModelError, match=says(f"{path}: the file has no <link>. A robot has at least one")):
        read_urdf(file("<robot/>"))


def test_impossible_inertias_are_replaced_by_the_nearest(file):
    old, new = 'ixx="0.002" iyy="0.001" izz="0.002"', 'ixx="0.002" iyy="0.001" izz="0.004"'
    tree = read_urdf(file(ARM.replace(old, new)), impossible="replace")
    # second moments -0.5, 1.5 and 2.5 g m^2 along z, x and y: the first becomes almost zero
    assert np.allclose(tree.link("wrist").inertia.moments, (0.0025, 0.0015, 0.004), rtol=1e-5)
    assert tree.unsupported[0].endswith("Replaced by the nearest possible one, which differs by 0.0005 kg m^2")
    thin = read_urdf(file(ARM.replace(old, 'ixx="0.002" iyy="0.002" izz="0"')))
    assert np.allclose(thin.link("wrist").inertia.moments, (0.002, 0.002, 1.6e-12), rtol=1e-6, atol=0)
    assert thin.unsupported[0] == (
        "arm.urdf, line 24: link 'wrist': <inertial>: a thin body, imported with a radius of gyration of 1e-06 m where it "
        "has none"
    )
    point = read_urdf(file(ARM.replace(old, 'ixx="0" iyy="0" izz="1e-21"')))
    assert np.allclose(point.link("wrist").inertia.moments, 0.8 * 2e-12, rtol=1e-6, atol=0)
    massless = read_urdf(file(ARM.replace('<mass value="0.8"/>', '<mass value="0"/>')), impossible="replace")
    assert massless.link("wrist").inertia is None


def test_joints_may_be_in_any_order(file):
    document = minidom.parseString(ARM)
    joints = [node for node in document.getElementsByTagName("joint") if node.hasAttribute("type")]
    for joint in joints:  # each before the next one
        document.documentElement.insertBefore(joint, document.documentElement.firstChild)
    tree = read_urdf(file(document.toxml()))
    assert [link.name for link in tree.links] == ["column", "slider", "wrist", "tool", "tip"]


def test_meshes_are_found_beside_the_file_and_in_packages(file, tmp_path):
    path = file()
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    (tmp_path / "arm" / "meshes" / "tool.stl").touch()
    assert not any("mesh" in note for note in read_urdf(path).unsupported)
    assert not any("mesh" in note for note in read_urdf(file(ARM.replace("package://", ""))).unsupported)


def test_complex_numbers_are_not_written(file, tmp_path):
    tree = read_urdf(file())
    links = (*tree.links[:-1], replace(tree.links[-1], joint=TreeJoint("end", "fixed", Pose((1j, 0.0, 0.0)))))
    with pytest.raises(InputError, match="expected real numbers"):
        write_urdf(replace(tree, links=links), tmp_path / "again.urdf")


UNLIMITED_JOINTS = {
    "turn": TreeJoint("turn"),
    "slide": TreeJoint("slide", "prismatic"),
    "one side": TreeJoint("bend", lower=-0.5),
    "limited": TreeJoint("bend", lower=-0.5, upper=1.5, effort=20.0, velocity=3.0),
}


@pytest.mark.parametrize("name", UNLIMITED_JOINTS)
def test_written_joints_have_the_limits_that_other_programs_require(tmp_path, name):
    """The element with finite effort and velocity; for joints other than continuous ones also lower and upper."""
    joint, path = UNLIMITED_JOINTS[name], tmp_path / "arm.urdf"
    write_urdf(Tree("robot", "base", (Link("arm", "base", joint, Inertia.sphere(2.0, 0.1)),)), path)
    element = minidom.parse(str(path)).getElementsByTagName("joint")[0]
    (limit,) = element.getElementsByTagName("limit")
    required = {"effort", "velocity"} | (set() if element.getAttribute("type") == "continuous" else {"lower", "upper"})
    assert set(limit.attributes.keys()) == required
    assert all(np.isfinite(float(value)) for _, value in limit.attributes.items())
    assert read_urdf(path).joints == (joint,)


@pytest.mark.parametrize("name", UNLIMITED_JOINTS)
def test_pinocchio_reads_written_joints(tmp_path, name):
    pinocchio = pytest.importorskip("pinocchio")
    joint, path = UNLIMITED_JOINTS[name], tmp_path / "arm.urdf"
    write_urdf(Tree("robot", "base", (Link("arm", "base", joint, Inertia.sphere(2.0, 0.1)),)), path)
    model = pinocchio.buildModelFromUrdf(str(path))
    assert model.nv == 1
    largest = np.finfo(float).max
    assert model.velocityLimit[0] == min(joint.velocity, largest)
    assert model.effortLimit[0] == min(joint.effort, largest)
    if joint.kind == "prismatic" or np.isfinite(joint.lower):
        assert model.lowerPositionLimit[0] == max(joint.lower, -largest)


@pytest.mark.parametrize("name", UNLIMITED_JOINTS)
def test_mujoco_reads_written_joints(tmp_path, name):
    mujoco = pytest.importorskip("mujoco")
    path = tmp_path / "arm.urdf"
    write_urdf(Tree("robot", "base", (Link("arm", "base", UNLIMITED_JOINTS[name], Inertia.sphere(2.0, 0.1)),)), path)
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    assert np.all(np.isfinite(data.qacc))
