"""The motion of a whole structure, from what a curve keeps of it."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.structure import ModeShapes, eigenmodes, mode_shapes, node_motion
from dalembert.vibration import Deformation, HarmonicBalance, deformation, frequency_response
from dalembert.vibration.balance import preparation
from frequency_cases import strip
from support import says
from vibrating_systems import two_masses


@pytest.fixture(scope="module")
def solved():
    system = strip()
    curve = frequency_response(system, np.linspace(60.0, 90.0, 7), HarmonicBalance(harmonics=3, samples=256))
    return system, curve, deformation(system, curve)


def test_nodes_move_as_the_observed_degrees_of_freedom_do(solved):
    system, curve, shape = solved
    point = int(np.argmax(np.abs(curve.frequencies - shape.frequency) < 1e-12))
    nodes = system.structure.nodes
    kept = np.unique(nodes.faces)
    for dof in curve.dofs:
        node, _, axis = dof.rpartition(".")
        if axis != "q":
            row = int(np.flatnonzero(kept == nodes.rows([node])[0])[0])
            own = shape.coefficients[row, "xyz".index(axis)]
            np.testing.assert_allclose(own, curve.harmonics(dof)[point], rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(
        shape.motion(np.array([0.0]))[0], shape.coefficients[:, :, [0, 1, 3, 5]].sum(axis=2), atol=1e-18
    )
    assert not shape.coefficients[np.isin(kept, nodes.rows(nodes.members("left")))].any()  # clamped


def test_it_needs_no_kernel(solved, monkeypatch):
    system, curve, _ = solved
    monkeypatch.setattr(preparation, "prepare", lambda kernels: pytest.fail(f"{kernels} would be compiled"))
    deformation(system, curve)


def test_contacts_keep_their_places_states_and_energies(solved):
    _, curve, shape = solved
    assert shape.contacts == ("foot 1", "foot 2", "foot 3")
    np.testing.assert_allclose(shape.contact_places[2], (0.2, 0.05, 0.0), atol=1e-12)
    point = int(np.flatnonzero(curve.frequencies == shape.frequency)[0])
    np.testing.assert_array_equal(shape.states, curve.states[point])
    total = sum(curve.dissipated(name)[point] for name in curve.coordinates)
    assert shape.energies.sum() == pytest.approx(total)


def test_a_deformation_is_kept_whole(solved, tmp_path):
    shape = solved[2]
    shape.save(tmp_path / "shape.nc")
    again = Deformation.load(tmp_path / "shape.nc")
    np.testing.assert_array_equal(again.coefficients, shape.coefficients)
    np.testing.assert_array_equal(again.faces, shape.faces)
    assert (again.contacts, again.orders, again.frequency) == (shape.contacts, shape.orders, shape.frequency)
    assert again.summary() == shape.summary()


def test_modes_are_kept_whole_and_largest_is_one(solved, tmp_path):
    structure = solved[0].structure
    modes = eigenmodes(structure, 3)
    shapes = mode_shapes(structure, modes)
    np.testing.assert_allclose(np.linalg.norm(shapes.shapes, axis=2).max(axis=1), 1.0)
    moved = node_motion(structure, modes.shapes)
    np.testing.assert_allclose(moved[structure.nodes.rows([_forced(solved[0])])[0], 2], modes.shapes[_row(solved[0])])
    shapes.save(tmp_path / "modes.nc")
    np.testing.assert_array_equal(ModeShapes.load(tmp_path / "modes.nc").shapes, shapes.shapes)
    assert float(shapes.key_values()["mode 1"].split()[0]) == pytest.approx(modes.frequencies[0], rel=1e-5)


def _forced(system):
    return system.forces[0].dof.rpartition(".")[0]


def _row(system):
    return system.structure.dofs.index(system.forces[0].dof)


def test_a_structure_without_places_is_refused():
    system = two_masses()
    curve = frequency_response(system, np.array([0.1]), HarmonicBalance(harmonics=3, samples=128))
    sentence = "deformation: the structure does not say where its nodes are; give it nodes=Nodes(...)"
    with pytest.raises(InputError, match=says(sentence)):
        deformation(system, curve)


def test_another_system_and_a_point_that_was_not_found_are_refused(solved):
    system, curve, _ = solved
    less = strip()
    less.elements.pop()
    sentence = (
        "deformation: the curve has unknowns of shape (6, 7) and 3 contacts; the system has (4, 7) and 2; give the "
        "system of the curve"
    )
    with pytest.raises(InputError, match=says(sentence)):
        deformation(less, curve)
    with pytest.raises(
        InputError, match=says("deformation: the point 9 was not found; expected one of the 7 that were")
    ):
        deformation(system, curve, 9)
