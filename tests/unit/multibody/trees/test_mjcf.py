"""MJCF files, by MuJoCo's parser; without it a sentence says what to install."""

import sys

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.multibody import GeneralizedAlpha, simulate
from dalembert.multibody.trees import read_mjcf
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
    assert "shape 1 of body 'arm' is not drawn" in tree.unsupported
