"""MJCF files, by MuJoCo's parser; without it a sentence says what to install."""

import sys

import numpy as np
import pytest

from dalembert.errors import InputError, ModelError
from dalembert.multibody import GeneralizedAlpha, simulate
from dalembert.multibody.trees import read_mjcf, write_urdf
from support import says

ARM = """<mujoco model="arm">
  <compiler angle="radian"/>
  <default><joint damping="0.3" armature="0.05"/></default>
  <option gravity="0 0 -9.7"/>
  <worldbody>
    <body name="upper" pos="0.1 0 0.5" euler="0.2 0.1 0">
      <joint name="shoulder" axis="0 1 0.3" pos="0.02 0 0.1" range="-1 2" limited="true" frictionloss="0"/>
      <inertial mass="2" pos="0 0.01 -0.2" fullinertia="0.03 0.031 0.004 0.001 0 0.0005"/>
      <geom type="box" size="0.02 0.03 0.2" contype="0" conaffinity="0"/>
      <body name="lower" pos="0 0 -0.4" quat="0.9 0.1 0 0.3">
        <joint name="slide" type="slide" axis="1 0 1" ref="0.1" stiffness="0"/>
        <geom type="sphere" size="0.05" mass="1.2" pos="0.1 0 0" contype="0" conaffinity="0"/>
        <body name="tool" pos="0 0 -0.2"><geom type="cylinder" size="0.02 0.05" mass="0.4" contype="0" conaffinity="0"/></body>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="shoulder"/></actuator>
</mujoco>
"""


def test_missing_mujoco(tmp_path, monkeypatch):
    path = tmp_path / "arm.xml"
    with pytest.raises(InputError, match=says(f"{path}: there is no such file. Check the path")):
        read_mjcf(path)
    path.write_text(ARM)
    monkeypatch.setitem(sys.modules, "mujoco", None)
    sentence = "read_mjcf: MuJoCo is needed and not installed; run: pip install 'dalembert[mujoco]'"
    with pytest.raises(InputError, match=says(sentence)):
        read_mjcf(path)


def test_accelerations_against_mujoco(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    path = tmp_path / "arm.xml"
    path.write_text(ARM)
    tree = read_mjcf(path)
    assert [joint.name for joint in tree.joints] == ["shoulder", "slide", "tool fixed"]
    assert (tree.joints[0].lower, tree.joints[0].upper, tree.joints[1].damping) == (-1.0, 2.0, 0.3)
    assert "1 actuator not imported" in tree.unsupported
    assert "joint 'slide': its reference 0.1 is the position zero here" in tree.unsupported
    assert "the gravity (0.0, 0.0, -9.7) is not imported; give it to Tree.system" in tree.unsupported
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = [0.7, 0.4], [1.5, -0.8]
    mujoco.mj_forward(model, data)
    system = tree.system([0.7, 0.3], [1.5, -0.8], (0.0, 0.0, -9.7))
    step = 1e-5
    motion = simulate(system, 2 * step, GeneralizedAlpha(step=step), times=np.array([0.0, step, 2 * step]))
    place = motion.channels([f"lower.tool.{axis}" for axis in "xyz"])[0]
    assert np.abs(place - data.xpos[3]).max() < 1e-9
    rates = motion.channels(["shoulder.rate", "slide.speed"])
    ours = (-1.5 * rates[0] + 2.0 * rates[1] - 0.5 * rates[2]) / step
    assert np.abs(ours - data.qacc).max() < 1e-4 * np.abs(data.qacc).max()


def test_files_that_mujoco_refuses(tmp_path):
    pytest.importorskip("mujoco")
    path = tmp_path / "arm.xml"
    path.write_text("<mujoco><worldbody><body><joint/></body></worldbody></mujoco>")
    with pytest.raises(InputError, match="MuJoCo cannot read the file"):
        read_mjcf(path)


def test_a_capsule_is_drawn_as_a_cylinder_between_spheres(tmp_path):
    pytest.importorskip("mujoco")
    path = tmp_path / "arm.xml"
    capsule = (
        '<geom type="capsule" fromto="0.1 0 0 0.1 0 -0.4" size="0.02" mass="1"/><geom type="ellipsoid" size="1 2 3"/>'
    )
    path.write_text(f'<mujoco><worldbody><body name="arm"><joint axis="0 1 0"/>{capsule}</body></worldbody></mujoco>')
    tree = read_mjcf(path)
    (link,) = tree.links
    assert [(shape.kind, shape.sizes) for shape in link.shapes] == [
        ("cylinder", (0.02, 0.4)),
        ("sphere", (0.02,)),
        ("sphere", (0.02,)),
    ]
    places = np.array([shape.pose.position for shape in link.shapes])
    np.testing.assert_allclose(places[0], [0.1, 0.0, -0.2], atol=1e-12)
    np.testing.assert_allclose(np.sort(places[1:, 2]), [-0.4, 0.0], atol=1e-12)
    assert "shape 1 of body 'arm' is neither drawn nor a collision shape" in tree.unsupported


def test_shapes_that_collide_are_written_as_collision_shapes(tmp_path):
    """MuJoCo reads the same shapes from the written file; a capsule is the union of three."""
    mujoco = pytest.importorskip("mujoco")
    path, written = tmp_path / "arm.xml", tmp_path / "arm.urdf"
    shown = 'contype="0" conaffinity="0"'
    shapes = (
        '<geom type="box" size="0.1 0.2 0.3" pos="0 0 0.1" quat="0.9 0.1 0 0.3"/>'
        f'<geom type="sphere" size="0.4" {shown}/><geom type="cylinder" size="0.02 0.3" contype="0"/>'
        '<geom type="capsule" fromto="0.1 0 0 0.1 0 -0.4" size="0.02" mass="1"/>'
    )
    arm = f'<body name="arm"><joint pos="0 0 0.5" axis="0 1 0"/>{shapes}</body>'
    path.write_text(f'<mujoco><worldbody><geom type="box" size="1 1 0.1"/>{arm}</worldbody></mujoco>')
    tree = read_mjcf(path)
    assert (len(tree.shapes), len(tree.collisions)) == (1, 1)
    (link,) = tree.links
    assert [shape.kind for shape in link.shapes] == ["box", "sphere", "cylinder", "cylinder", "sphere", "sphere"]
    assert link.collisions == (link.shapes[0], *link.shapes[2:])
    write_urdf(tree, written)
    again = mujoco.MjModel.from_xml_path(str(written))  # collision shapes alone
    kinds = mujoco.mjtGeom
    expected = [kinds.mjGEOM_BOX] * 2 + [kinds.mjGEOM_CYLINDER] * 2 + [kinds.mjGEOM_SPHERE] * 2
    assert again.geom_type.tolist() == [int(kind) for kind in expected]
    assert again.geom_size[1].tolist() == [0.1, 0.2, 0.3]
    assert again.geom_size[3:, 0].tolist() == [0.02] * 3
    np.testing.assert_allclose(again.geom_pos[1], [0.0, 0.0, 0.1 - 0.5], atol=1e-15)


LEFT_OUT = """<mujoco><option><flag gravity="disable"/></option>
<worldbody>
  <body name="arm"><joint name="turn" axis="0 1 0" stiffness="2"/>
    <geom name="rod" type="capsule" fromto="0 0 0 0 0 -0.4" size="0.02" contype="0" conaffinity="0"/></body>
  <body name="ball"><freejoint name="root"/><geom name="egg" type="ellipsoid" size="0.1 0.2 0.3" contype="0" conaffinity="0"/></body>
  <camera name="eye"/>
</worldbody>
<actuator><position joint="turn" kp="10"/></actuator>
<equality><joint joint1="turn"/></equality>
</mujoco>"""


def test_what_is_left_out_is_listed_with_whether_the_motion_depends_on_it(tmp_path):
    pytest.importorskip("mujoco")
    path = tmp_path / "arm.xml"
    path.write_text(LEFT_OUT)
    tree = read_mjcf(path)
    assert {omission.text: omission.moves for omission in tree.omissions} == {
        "joint 'turn': its spring is not imported; add a TorsionSpring or a Spring to the system": True,
        "joint 'root' of body 'ball' is free, which is not supported; it is fixed": True,
        "shape 'egg' of body 'ball' is not drawn": False,
        "1 actuator not imported": True,
        "1 equality constraint not imported": True,
        "1 camera not imported": False,
        "the file switches gravity off, which is not imported; give gravity (0, 0, 0)": True,
    }
    findings = [(finding.code, finding.severity, finding.values) for finding in tree.findings]
    assert findings == [
        ("not-imported", "warning", {"robot": "arm", "parts": 5, "moves": True}),
        ("not-imported", "note", {"robot": "arm", "parts": 2, "moves": False}),
    ]
    assert tree.system().findings == tree.findings
    assert simulate(tree.system(), 0.01).findings[:2] == tree.findings


@pytest.mark.parametrize(
    ("flag", "numbers"), [("damper", [0.0, 0.3]), ("frictionloss", [0.7, 0.0]), ("constraint", [0.7, 0.0])]
)
def test_flags_switch_damping_and_friction_off(tmp_path, flag, numbers):
    pytest.importorskip("mujoco")
    path = tmp_path / "arm.xml"
    joint = '<joint name="turn" axis="0 1 0" damping="0.7" frictionloss="0.3"/><geom size="0.1"/>'
    path.write_text(
        f'<mujoco><option><flag {flag}="disable"/></option><worldbody><body>{joint}</body></worldbody></mujoco>'
    )
    (link,) = read_mjcf(path).links
    assert [link.joint.damping, link.joint.friction] == numbers


IMPOSSIBLE = {
    "diagonal": ('diaginertia="0.001 0.001 0.01"', [0.005, 0.005, 0.01]),
    "full": ('fullinertia="0.001 0.001 0.01 0 0 0"', [0.005, 0.005, 0.01]),
    "negative": ('fullinertia="0.004 -0.001 0.006 0 0 0"', [0.006, 0.0, 0.006]),
}


@pytest.mark.parametrize("kind", IMPOSSIBLE)
def test_impossible_inertias_are_refused_or_replaced(tmp_path, kind):
    """The nearest possible one has the second moments of the file, the negative ones raised to zero.

    The second moments tr(J)/2 - J of the first two are 0.005, 0.005 and -0.004; of the last 0.0005, 0.0055 and -0.0015.
    """
    pytest.importorskip("mujoco")
    inertia, moments = IMPOSSIBLE[kind]
    path = tmp_path / "arm.xml"
    inertial = f'<inertial pos="0 0 -0.2" mass="1" {inertia}/>'
    path.write_text(f'<mujoco><worldbody><body name="arm"><joint axis="0 1 0"/>{inertial}</body></worldbody></mujoco>')
    with pytest.raises(ModelError, match=r"^arm\.xml: body 'arm': Inertia: .*read with impossible='replace'$"):
        read_mjcf(path)
    tree = read_mjcf(path, impossible="replace")
    (link,) = tree.links
    second = np.sort(np.trace(np.diag(moments)) / 2 - np.array(moments))
    second = second if kind != "negative" else np.array([0.0, 0.0005, 0.0055])
    found = np.sort(np.trace(link.inertia.tensor) / 2 - np.linalg.eigvalsh(link.inertia.tensor))
    np.testing.assert_allclose(found, second, atol=1e-7)
    (omission,) = tree.omissions
    assert omission.moves
    assert "Replaced by the nearest possible one" in omission.text


def test_names_that_are_no_utf8_are_refused(tmp_path):
    pytest.importorskip("mujoco")
    path = tmp_path / "arm.xml"
    path.write_bytes(b'<mujoco><worldbody><body name="\xe4"><joint/><geom size="0.1"/></body></worldbody></mujoco>')
    with pytest.raises(InputError, match="a name in the file is no UTF-8"):
        read_mjcf(path)
