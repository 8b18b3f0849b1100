"""Meshes of URDF files: drawn where they are there, named where not."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from dalembert.multibody import RungeKutta4, simulate
from dalembert.multibody.components.spatial import mesh_files
from dalembert.multibody.components.spatial.mesh_files import CORNERS, simplified
from dalembert.multibody.motion.sketch import sketch
from dalembert.multibody.spatial import Orientation, Pose
from dalembert.multibody.trees import read_urdf
from dalembert.report import Animation
from dalembert.report.scene.mechanism import mechanism_scene

ROBOT = """<robot name="pendulum"><link name="base"/>
<link name="arm"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><origin xyz="0 0 -0.5" rpy="0 0 1.5707963267948966"/>
<geometry><mesh filename="{file}" scale="0.001 0.001 0.002"/></geometry></visual></link>
<joint name="pin" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint></robot>"""
SIDES = (100.0, 40.0, 300.0)


@pytest.fixture
def robot(tmp_path: Path):
    """Reads a pendulum whose arm has this mesh."""

    def read(file: str, text: str = ROBOT):
        path = tmp_path / "robots" / "pendulum.urdf"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text.format(file=file))
        return read_urdf(path)

    return read


def test_shapes_of_the_base_are_drawn_in_the_ground(robot):
    text = ROBOT.replace(
        '<link name="base"/>',
        '<link name="base"><visual><origin xyz="0 0 0.1"/><geometry><box size="0.2 0.4 0.6"/></geometry></visual></link>',
    )
    system = robot("arm.stl", text).system(base=Pose((1.0, 0.0, 0.0), Orientation.by_angles("z", [np.pi / 2])))
    corners = np.abs(system.ground_surface.corners - [1.0, 0.0, 0.1])
    np.testing.assert_allclose(corners, np.tile([0.2, 0.1, 0.3], (8, 1)), atol=1e-12)
    drawing = simulate(system, 0.02, RungeKutta4(step=1e-2)).drawing()
    shapes = Animation.of(drawing).scene.primitives
    assert [shape.role for shape in shapes if shape.kind == "surface"] == ["ground"]
    assert [shape.part for shape in mechanism_scene(sketch(system)).primitives if shape.kind == "surface"] == ["ground"]


@pytest.mark.parametrize("suffix", ["stl", "obj", "dae", "ply", "STL"])
def test_a_mesh_has_its_scale_and_its_place(robot, tmp_path, suffix):
    folder = tmp_path / "pendulum" / "meshes"
    folder.mkdir(parents=True)
    data = trimesh.creation.box(SIDES).export(file_type=suffix.lower())
    (folder / f"arm.{suffix}").write_bytes(data if isinstance(data, bytes) else data.encode())
    tree = robot(f"package://pendulum/meshes/arm.{suffix}")
    assert tree.unsupported == ()
    surface = tree.system().bodies[0].surface
    half = np.array([0.02, 0.05, 0.3])  # turned by 90 degrees about z
    np.testing.assert_allclose(np.abs(surface.corners - [0.0, 0.0, -0.5]), np.tile(half, (8, 1)), atol=1e-9)
    assert len(surface.triangles) == 12


def test_it_is_drawn_in_the_animation(robot, tmp_path):
    ball = trimesh.creation.icosphere(subdivisions=4, radius=100.0)
    (tmp_path / "robots").mkdir()
    ball.export(tmp_path / "robots" / "ball.stl")
    motion = simulate(robot("ball.stl").system(), 0.05, RungeKutta4(step=1e-2))
    (mesh,) = (shape for shape in Animation.of(motion.drawing()).scene.primitives if shape.kind == "surface")
    assert 50 < mesh.points.shape[1] <= CORNERS < len(ball.vertices)
    assert np.ptp(mesh.positions[0, :, 2]) == pytest.approx(0.4, rel=0.05)  # 0.002 along z


def test_a_mesh_that_is_not_drawn_is_named(robot, tmp_path, monkeypatch):
    assert robot("arm.stl").unsupported == (
        "line 5: the mesh 'arm.stl' of link 'arm' is not there, so it is not drawn",
    )
    for name in ("arm.mesh", "arm.stl"):
        (tmp_path / "robots" / name).write_text("solid")
    assert robot("arm.mesh").unsupported == (
        "line 5: the mesh 'arm.mesh' of link 'arm' is no .dae, .obj, .ply or .stl file. Convert it to be drawn",
    )
    monkeypatch.setattr(mesh_files, "find_spec", lambda name: None)
    assert robot("arm.stl").unsupported == (
        "line 5: the mesh 'arm.stl' of link 'arm' needs trimesh, which is not installed, to be drawn; "
        "run: pip install 'dalembert[meshes]'",
    )


@pytest.mark.parametrize(("name", "text"), [("arm.stl", "solid\n"), ("arm.dae", "<COLLADA"), ("arm.obj", "v 1 2\n")])
def test_a_damaged_mesh_is_not_drawn(robot, tmp_path, name, text):
    (tmp_path / "robots").mkdir()
    (tmp_path / "robots" / name).write_text(text)
    with pytest.warns(RuntimeWarning, match=f"{name} cannot be read, so it is not drawn"):
        drawing = simulate(robot(name).system(), 0.02, RungeKutta4(step=1e-2)).drawing()
    assert drawing.surfaces == {}
    assert len(Animation.of(drawing).scene.times) > 1


def test_simplified_meshes_keep_their_size():
    mesh = trimesh.creation.torus(1.0, 0.3, major_sections=80, minor_sections=40)
    corners, triangles = simplified(mesh.vertices, mesh.faces, 300)
    assert 150 < len(corners) <= 300
    assert triangles.max() < len(corners)
    assert np.abs(np.ptp(corners, axis=0) - np.ptp(mesh.vertices, axis=0)).max() < 0.2
    same, whole = simplified(mesh.vertices, mesh.faces, 10_000)
    assert (len(same), len(whole)) == (len(mesh.vertices), len(mesh.faces))
