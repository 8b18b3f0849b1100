"""Motions and shapes as VTK's files, read back number by number."""

import sys
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError, StorageError
from frequency_cases import strip
from support import says


@pytest.fixture(scope="module")
def trajectory():
    """A beam, a rigid triangle and a point mass: all that lines and points are made of."""
    system = da.System(gravity=(0.0, -9.81))
    section = dict(density=1000.0, height=0.1, width=0.05)
    beam = system.add(da.AncfBeam("beam", 1.0, 2, 1e7, poisson_ratio=0.3, angle=-0.5, **section))
    corners = {"a": (0.0, 0.0), "b": (0.3, 0.0), "c": (0.0, 0.2)}
    body = system.add(da.RigidBody("body", 2.0, 0.3, position=beam.end, anchor="a", points=corners))
    system.add(da.PointMass("bead", 0.5, position=(2.0, 0.0), velocity=(1.0, 0.5)))
    system.add(da.RevoluteJoint("O", system.ground, beam.start))
    system.add(da.RevoluteJoint("A", beam.end, body.point("a")))
    return da.simulate(system, 0.2, times=np.linspace(0, 0.2, 5), solver=da.GeneralizedAlpha(step=1e-3))


def _series(path):
    """Times and meshes of a series."""
    listed = ElementTree.parse(path).getroot().findall("./Collection/DataSet")
    return [float(one.attrib["timestep"]) for one in listed], [
        meshio.read(path.parent / one.attrib["file"]) for one in listed
    ]


def test_a_motion_is_written_with_its_bodies_joints_and_velocities(trajectory, tmp_path):
    path = da.export_vtk(trajectory, tmp_path / "motion.pvd", points=4)
    times, meshes = _series(path)
    assert times == trajectory.times.tolist()
    drawing = trajectory.drawing(points=4)
    own = [*drawing.lines.values(), *(place[:, None] for place in drawing.joints.values())]
    places = np.concatenate(own, axis=1)
    for mesh, place in zip(meshes, places, strict=True):
        np.testing.assert_array_equal(mesh.points[:, :2], place)
        assert not mesh.points[:, 2].any()
        np.testing.assert_allclose(mesh.point_data["displacement"][:, :2], place - places[0], atol=1e-15)
    names = ["beam.end.vx", "beam.end.vy", "body.c.vx", "body.c.vy", "bead.vx", "bead.vy"]
    names = [name if name in trajectory.channel_names else name.replace("bead.", "bead.centre.") for name in names]
    speeds = trajectory.channels(names).reshape(-1, 3, 2)
    rows = [8, 9 + 2, 9 + 4, 9 + 4 + 2]  # ends of the beam's eight pieces, third corner, point mass, joint at the end
    for mesh, speed in zip(meshes, speeds, strict=True):
        velocity = mesh.point_data["velocity"]
        np.testing.assert_allclose(velocity[rows[:3], :2], speed, rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(velocity[rows[3], :2], speed[0], rtol=1e-12, atol=1e-12)
    mesh = meshes[0]
    assert mesh.cells_dict["line"].tolist() == [*([k, k + 1] for k in range(8)), *([k, k + 1] for k in range(9, 12))]
    assert mesh.cells_dict["vertex"].tolist() == [[13], [14], [15]]
    assert [marks.tolist() for marks in mesh.cell_data["body"]] == [[0] * 8 + [1] * 3, [2, -1, -1]]
    assert [marks.tolist() for marks in mesh.cell_data["joint"]] == [[-1] * 11, [-1, 0, 1]]
    assert mesh.point_data["height"].tolist() == [0.1] * 9 + [0.0] * 7
    assert mesh.point_data["width"].tolist() == [0.05] * 9 + [0.0] * 7


def test_velocities_are_the_derivative_of_the_places(tmp_path):
    system = da.System(gravity=(0.0, -9.81))
    cable = system.add(da.AncfCable("cable", 1.0, 2, 1e6, density=1000.0, height=0.05, width=0.05))
    system.add(da.RevoluteJoint("O", system.ground, cable.start))
    times = np.linspace(0, 0.02, 41)
    motion = da.simulate(system, 0.02, times=times, solver=da.GeneralizedAlpha(step=1e-4))
    meshes = _series(da.export_vtk(motion, tmp_path / "cable.pvd"))[1]
    places = np.array([mesh.points for mesh in meshes])
    velocities = np.array([mesh.point_data["velocity"] for mesh in meshes])
    difference = (places[2:] - places[:-2]) / (times[2] - times[0])
    assert np.abs(velocities).max() > 0.1
    np.testing.assert_allclose(velocities[1:-1], difference, atol=1e-3 * np.abs(velocities).max())


def test_fewer_frames_keep_both_ends_and_leave_no_other_listed(trajectory, tmp_path):
    da.export_vtk(trajectory, tmp_path / "motion.pvd")
    times, meshes = _series(da.export_vtk(trajectory, tmp_path / "motion.pvd", frames=3))
    assert times == trajectory.times[[0, 2, 4]].tolist()
    assert len(meshes) == 3


@pytest.fixture(scope="module")
def shape():
    system = strip()
    curve = da.frequency_response(system, np.linspace(60.0, 90.0, 7), da.HarmonicBalance(harmonics=3, samples=256))
    return da.deformation(system, curve)


def test_a_deformed_shape_moves_over_its_period(shape, tmp_path):
    times, meshes = _series(da.export_vtk(shape, tmp_path / "shape.pvd", frames=32))
    phases = 2 * np.pi * np.arange(32) / 32
    np.testing.assert_allclose(times, phases / (2 * np.pi * shape.frequency), rtol=1e-15)
    nodes = len(shape.places)
    for mesh, moved in zip(meshes, shape.motion(phases), strict=True):
        np.testing.assert_array_equal(mesh.points[:nodes], shape.places)
        np.testing.assert_array_equal(mesh.points[nodes:], shape.contact_places)
        np.testing.assert_allclose(mesh.point_data["displacement"][:nodes], moved, atol=1e-18)
        np.testing.assert_array_equal(mesh.cells[0].data, shape.faces)
    # Of a trigonometric polynomial of few harmonics the Fourier derivative of equal samples is exact.
    waves = np.fft.rfft(shape.motion(phases), axis=0)
    orders = np.arange(len(waves))[:, None, None]
    speeds = np.fft.irfft(2j * np.pi * shape.frequency * orders * waves, n=32, axis=0)
    found = np.array([mesh.point_data["velocity"][:nodes] for mesh in meshes])
    np.testing.assert_allclose(found, speeds, atol=1e-12 * np.abs(speeds).max())
    states = np.array([mesh.point_data["state"] for mesh in meshes])
    assert (states[:, :nodes] == -1).all()
    np.testing.assert_array_equal(states[:, nodes:].T, shape.states[:, :: shape.states.shape[1] // 32])
    np.testing.assert_array_equal(meshes[0].point_data["dissipated"][nodes:], shape.energies)


def test_harmonics_are_complex_amplitudes(shape, tmp_path):
    mesh = meshio.read(da.export_vtk(shape, tmp_path / "shape.vtu"))
    assert set(mesh.point_data) == {
        "mean",
        *(f"harmonic {order} {part}" for order in shape.orders if order for part in ("real", "imaginary")),
    }
    phase = 0.7
    motion = mesh.point_data["mean"].copy()
    for order in shape.orders[1:]:
        amplitude = mesh.point_data[f"harmonic {order} real"] + 1j * mesh.point_data[f"harmonic {order} imaginary"]
        motion += (amplitude * np.exp(1j * order * phase)).real
    np.testing.assert_allclose(motion, shape.motion(np.array([phase]))[0], atol=1e-18)


def _square() -> tuple[da.Structure, da.ModeShapes]:
    square = da.plate((0.4, 0.3), 2e-3, da.Material(210e9, 0.3, 7800.0), (4, 3)).fixed("edge")
    return square, da.mode_shapes(square, da.eigenmodes(square, 3))


def test_modes_are_fields_named_by_their_frequencies(tmp_path):
    shapes = _square()[1]
    mesh = meshio.read(da.export_vtk(shapes, tmp_path / "modes.vtu"))
    np.testing.assert_array_equal(mesh.points, shapes.places)
    np.testing.assert_array_equal(mesh.cells_dict["quad"], shapes.faces)
    for name, frequency, shape in zip(mesh.point_data, shapes.frequencies, shapes.shapes, strict=True):
        assert name.endswith(f"({frequency:.6g} Hz)")
        np.testing.assert_array_equal(mesh.point_data[name], shape)


def test_complex_modes_are_two_fields_each(tmp_path):
    real = _square()[1]
    shapes = da.ModeShapes(real.frequencies, real.places, real.faces, real.shapes * np.exp(0.3j))
    mesh = meshio.read(da.export_vtk(shapes, tmp_path / "modes.vtu"))
    first = f"mode 1 ({real.frequencies[0]:.6g} Hz)"
    assert len(mesh.point_data) == 6
    np.testing.assert_array_equal(mesh.point_data[f"{first} real"], shapes.shapes[0].real)
    np.testing.assert_array_equal(mesh.point_data[f"{first} imaginary"], shapes.shapes[0].imag)
    assert np.abs(shapes.shapes[0].imag).max() > 0.1


def test_a_structure_without_faces_is_points(tmp_path):
    shapes = _square()[1]
    bare = da.ModeShapes(shapes.frequencies, shapes.places, np.zeros((0, 4), dtype=int), shapes.shapes)
    mesh = meshio.read(da.export_vtk(bare, tmp_path / "modes.vtu"))
    assert mesh.cells_dict["vertex"].tolist() == [[row] for row in range(len(shapes.places))]


def test_names_that_do_not_fit_and_other_results_are_refused(trajectory, shape, tmp_path):
    square, shapes = _square()
    for result, name, sentence in (
        (trajectory, "a.vtu", "'a.vtu' does not fit a motion; expected a name that ends with .pvd"),
        (shapes, "a.pvd", "'a.pvd' does not fit mode shapes; expected a name that ends with .vtu"),
        (
            shape,
            "a.vtk",
            "'a.vtk' does not fit a deformed shape; expected a name that ends with .pvd (over the period) or "
            ".vtu (harmonics)",
        ),
        (
            da.eigenmodes(square, 2),
            "a.vtu",
            "a EigenModes cannot be written; expected a Trajectory, a Deformation or ModeShapes; "
            "mode_shapes(structure, modes) makes what is drawn",
        ),
    ):
        with pytest.raises(InputError, match=says(f"export_vtk: {sentence}")):
            da.export_vtk(result, tmp_path / name)
    with pytest.raises(InputError, match=says("export_vtk: frames is 0; expected a whole number, at least 1")):
        da.export_vtk(trajectory, tmp_path / "a.pvd", frames=0)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there_or_in_the_way_is_said(trajectory, tmp_path):
    path = tmp_path / "none" / "a.pvd"
    with pytest.raises(InputError, match=r"cannot be written: there is no folder .*none; make it, or choose another"):
        da.export_vtk(trajectory, path)
    (tmp_path / "a").write_text("a file where the folder of the series would be")
    with pytest.raises(StorageError, match=r"/a cannot be written: File exists"):
        da.export_vtk(trajectory, tmp_path / "a.pvd")


def test_without_meshio_the_extra_is_named(trajectory, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)
    sentence = "export_vtk: meshio is needed and not installed; run: pip install 'dalembert[vtk]'"
    with pytest.raises(InputError, match=says(sentence)):
        da.export_vtk(trajectory, tmp_path / "a.pvd")
    assert not list(tmp_path.iterdir())
