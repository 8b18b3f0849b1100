"""Motions in space as VTK's files, read back number by number."""

from xml.etree import ElementTree

import meshio
import numpy as np

import dalembert as da
from dalembert.multibody.spatial import (
    Inertia,
    PointMass,
    Pose,
    RigidBody,
    Shape,
    SpatialSystem,
    SphericalJoint,
    Spring,
)

BOX = Shape.box((0.1, 0.06, 0.4), Pose((0.0, 0.0, -0.2)))
BALL = Shape.sphere(0.05)
CORNER = (0.05, 0.03, -0.4)


def test_a_motion_in_space_is_written_with_places_velocities_and_shapes(tmp_path):
    system = SpatialSystem()
    inertia = Inertia.box(2.0, (0.1, 0.06, 0.4)).moved((0.0, 0.0, -0.2))
    first = system.add(
        RigidBody("first", inertia, points={"low": CORNER}, angular_velocity=(2.0, 3.0, 0.5), shapes=[BOX])
    )
    second = system.add(
        RigidBody("second", Inertia.sphere(1.0, 0.05), position=first.point("low"), angular_velocity=(1.0, 0.0, 4.0),
                  shapes=[BALL])
    )  # fmt: skip
    bead = system.add(PointMass("bead", 0.5, position=(1.0, 0.0, 0.3), velocity=(0.2, -0.3, 0.4)))
    system.add(SphericalJoint("ball", system.ground, first.point("origin")))
    system.add(SphericalJoint("tip", first.point("low"), second.point("origin")))
    system.add(Spring("spring", second.point("centre"), bead.point("centre"), stiffness=10.0))
    trajectory = da.simulate(system, 0.3, times=np.linspace(0, 0.3, 7), solver=da.GeneralizedAlpha(step=1e-3))
    path = da.export_vtk(trajectory, tmp_path / "motion.pvd")
    listed = ElementTree.parse(path).getroot().findall("./Collection/DataSet")
    assert [float(one.attrib["timestep"]) for one in listed] == trajectory.times.tolist()
    meshes = [meshio.read(path.parent / one.attrib["file"]) for one in listed]

    drawing = trajectory.drawing()
    sizes = [line.shape[1] for line in drawing.lines.values()]
    cells = meshes[0].cells_dict
    assert len(cells["vertex"]) == 3  # the bead, two joints
    box, sphere = (shape.surface for shape in (BOX, BALL))
    assert len(cells["triangle"]) == len(box.triangles) + len(sphere.triangles)
    marks = dict(zip([block.type for block in meshes[0].cells], meshes[0].cell_data["body"], strict=True))
    assert marks["triangle"].tolist() == [0] * len(box.triangles) + [1] * len(sphere.triangles)
    assert marks["vertex"].tolist() == [2, -1, -1]

    begin = sum(sizes) + 2  # of the corners
    corner = begin + int(np.argmin(np.linalg.norm(box.corners - np.array(CORNER), axis=1)))
    bead_row = sum(sizes[:2])
    for row, name in ((corner, "first.low"), (sum(sizes), "first.origin"), (sum(sizes) + 1, "second.origin"),
                      (bead_row, "bead.centre")):  # fmt: skip
        places = trajectory.channels([f"{name}.{axis}" for axis in "xyz"])
        speeds = trajectory.channels([f"{name}.v{axis}" for axis in "xyz"])
        for mesh, place, speed in zip(meshes, places, speeds, strict=True):
            np.testing.assert_allclose(mesh.points[row], place, atol=1e-12)
            np.testing.assert_allclose(mesh.point_data["displacement"][row], place - places[0], atol=1e-12)
            np.testing.assert_allclose(mesh.point_data["velocity"][row], speed, atol=1e-10)
    # shapes stay rigid: the edges of all triangles keep their lengths
    corners = cells["triangle"]
    edges = [np.linalg.norm(mesh.points[corners[:, 0]] - mesh.points[corners[:, 1]], axis=1) for mesh in meshes]
    np.testing.assert_allclose(edges[-1], edges[0], rtol=1e-10)
