"""Modes of free bodies: interface nodes, mean axes, integrals of the mass, and messages."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from dalembert.errors import InputError, SolveError
from dalembert.structure import (
    Dofs,
    InterfaceNode,
    Material,
    Nodes,
    Rayleigh,
    Structure,
    box,
    combine,
    eigenmodes,
    free_body_modes,
    lumped,
    plate,
    solid,
)
from dalembert.structure.craig_bampton import CachedBases

STEEL = Material(210e9, 0.3, 7800.0)
SIDES = {"foot": "left", "tip": "right"}


@pytest.fixture(scope="module")
def bar() -> Structure:
    return solid(box((0.4, 0.02, 0.03), (6, 2, 2), (0.1, 0.2, 0.3)), STEEL)


def numbers_of_nodes(structure: Structure) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix between nodes, which is the same in all directions, and the rows of the nodes' places."""
    names = [name for name in structure.dofs.names if name.endswith(".x")]
    rows = [structure.dofs.index(name) for name in names]
    mass = structure.mass.toarray()[np.ix_(rows, rows)]
    return mass, structure.nodes.rows([name.partition(".")[0] for name in names])


def test_mass_properties_are_those_of_a_box(bar: Structure) -> None:
    modes = free_body_modes(bar, SIDES, modes=2)
    mass = 7800.0 * 0.4 * 0.02 * 0.03
    expected = np.diag([mass, *(mass * side**2 / 12 for side in (0.4, 0.02, 0.03))])
    np.testing.assert_allclose(modes.pseudo_inertia, expected, rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(modes.centre, [0.3, 0.21, 0.315], rtol=1e-12)
    np.testing.assert_allclose(modes.interface_places, [[-0.2, 0.0, 0.0], [0.2, 0.0, 0.0]], atol=1e-13)


def test_integrals_are_sums_over_the_nodes(bar: Structure) -> None:
    modes = free_body_modes(bar, SIDES, modes=2)
    mass, rows = numbers_of_nodes(bar)
    places, shapes = modes.places[rows], modes.shapes[rows]
    weighed = np.tensordot(mass, shapes, 1)
    first = np.einsum("pi,pja->ija", np.c_[np.ones(len(rows)), places], weighed)
    second = np.einsum("pia,pjb->ijab", shapes, weighed)
    np.testing.assert_allclose(modes.first, first, atol=1e-12 * np.abs(first).max())
    np.testing.assert_allclose(modes.second, second, atol=1e-12 * np.abs(second).max())
    np.testing.assert_allclose(np.einsum("iiab->ab", second), modes.mass, atol=1e-11 * modes.mass.max())


def test_modes_have_no_momentum_and_no_angular_momentum(bar: Structure) -> None:
    modes = free_body_modes(bar, SIDES, modes=2)
    first = modes.first / modes.pseudo_inertia[0, 0]
    assert np.abs(first[0]).max() < 1e-11
    assert np.abs(first[1:] - first[1:].transpose(1, 0, 2)).max() < 1e-13
    assert np.abs(modes.shapes).max() <= 1.0


def test_modes_are_those_of_the_structure_with_rigid_interfaces(bar: Structure) -> None:
    # Independently: all degrees of freedom, and conditions that each side keeps the distances of its nodes.
    modes = free_body_modes(bar, SIDES, modes=12)
    places = bar.nodes.places[bar.nodes.rows([name.partition(".")[0] for name in bar.dofs.names])]
    motions = []
    for side in SIDES.values():
        rows = bar.rows(side)
        motion = np.zeros((bar.size, 6))
        for row in rows:
            axis = "xyz".index(bar.dofs.names[row][-1])
            motion[row, :3] = np.eye(3)[axis]
            motion[row, 3:] = [np.cross(unit, places[row])[axis] for unit in np.eye(3)]
        motions.append(motion)
    held = bar.rows(["left", "right"])
    free = np.eye(bar.size)[:, np.setdiff1d(np.arange(bar.size), held)]
    basis = np.hstack([free, *motions])
    small = [basis.T @ (matrix @ basis) for matrix in (bar.stiffness, bar.mass)]
    exact = np.sqrt(np.clip(eigh(*small, eigvals_only=True), 0.0, None))[6:12] / (2 * np.pi)
    np.testing.assert_allclose(modes.frequencies[:6], exact, rtol=1e-4)
    assert np.all(modes.frequencies[:6] >= exact * (1 - 1e-9))


def test_clamped_frequency_is_that_of_the_clamped_structure(bar: Structure) -> None:
    modes = free_body_modes(bar, SIDES, modes=6)
    exact = eigenmodes(bar.fixed("left"), 1).frequencies[0]
    assert modes.clamped_frequency == pytest.approx(exact, rel=1e-3)
    alone = free_body_modes(bar, {"foot": "left"}, modes=6)
    assert alone.clamped_frequency == pytest.approx(exact, rel=1e-7)  # its fixed-interface modes are the clamped ones
    assert alone.count == 6


def test_a_factor_of_stiffness_or_mass_needs_no_new_reduction(bar: Structure) -> None:
    modes = free_body_modes(bar, SIDES, modes=3)
    other = free_body_modes(
        solid(box((0.4, 0.02, 0.03), (6, 2, 2), (0.1, 0.2, 0.3)), Material(70e9, 0.3, 2700.0)), SIDES, 3
    )
    scaled = modes.scaled(70 / 210, 2700 / 7800)
    np.testing.assert_allclose(scaled.stiffness, other.stiffness, rtol=1e-6, atol=1e-6 * other.stiffness.max())
    np.testing.assert_allclose(scaled.pseudo_inertia, other.pseudo_inertia, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(np.abs(scaled.first[1:]).max(), np.abs(other.first[1:]).max(), rtol=1e-6)


def test_interface_nodes_at_other_places_and_of_nodes_by_name(bar: Structure) -> None:
    nodes = bar.nodes.members("right")
    by_name = free_body_modes(bar, {"foot": "left", "tip": InterfaceNode(nodes, (0.5, 0.2, 0.3))}, modes=2)
    np.testing.assert_allclose(by_name.interface_places[1] + by_name.centre, [0.5, 0.2, 0.3], atol=1e-12)
    usual = free_body_modes(bar, SIDES, modes=2)
    np.testing.assert_allclose(by_name.frequencies, usual.frequencies, rtol=1e-8)


def chain(soft: float, light: float) -> Structure:
    """A bar of 20 elements with the exact flexibility of a slender beam; the first one is soft and light."""
    names = tuple(f"{node}.{axis}" for node in range(21) for axis in ("x", "y", "z", "rx", "ry", "rz"))
    places, h = np.linspace(0.0, 1.0, 21)[:, None] * np.array([1.0, 0.0, 0.0]), 0.05
    stiffness, mass = np.zeros((2, 126, 126))
    for element in range(20):
        factor, heavy = (soft, light) if element == 0 else (1.0, 1.0)
        flexibility = np.diag([1e-8, 1e-7, 1e-7, 1e-3, 1e-3, 1e-3]) * h / factor
        carry = np.eye(6)
        carry[1, 5], carry[2, 4] = h, -h
        part, first = np.hstack([-carry, np.eye(6)]), 6 * element
        stiffness[first : first + 12, first : first + 12] += part.T @ np.linalg.inv(flexibility) @ part
        own = heavy * h * np.array([0.5] * 3 + [1e-5] * 3)
        mass[first : first + 12, first : first + 12] += np.diag([*own, *own])
    return Structure(mass, stiffness, Dofs(names), nodes=Nodes(tuple(map(str, range(21))), places))


@pytest.mark.parametrize(("soft", "light"), [(1.0, 1.0), (1e-2, 1e-1), (1e-4, 1e-4), (1e-4, 1e-6), (1e-3, 1e-6)])
def test_a_soft_stalk_keeps_its_low_modes(soft: float, light: float) -> None:
    structure = chain(soft, light)
    modes = free_body_modes(structure, {"foot": "0"}, modes=6)
    exact = np.sqrt(np.clip(eigh(structure.stiffness, structure.mass, eigvals_only=True), 0.0, None)) / (2 * np.pi)
    np.testing.assert_allclose(modes.frequencies[:3], exact[6:9], rtol=1e-5)
    held = structure.fixed("0")
    clamped = 1 / np.sqrt(eigh(held.mass, held.stiffness, eigvals_only=True)[-1]) / (2 * np.pi)
    assert modes.clamped_frequency == pytest.approx(clamped, rel=1e-5)


def test_the_unit_of_length_does_not_matter() -> None:
    small = solid(box((4e-6, 2e-7, 3e-7), (6, 2, 2)), STEEL)
    ratio = free_body_modes(small, SIDES, modes=4).frequencies * 1e-5
    usual = free_body_modes(solid(box((0.4, 0.02, 0.03), (6, 2, 2)), STEEL), SIDES, modes=4).frequencies
    np.testing.assert_allclose(ratio, usual, rtol=1e-6)


def test_kept_bases_serve_a_builder_that_reduces_free_bodies(bar: Structure) -> None:
    bases, answers = CachedBases(), []
    for factor in (1.0, 1.5):
        with bases.call():
            answers.append(free_body_modes(replace(bar, stiffness=factor * bar.stiffness), SIDES, modes=2))
    np.testing.assert_allclose(answers[1].stiffness, 1.5 * answers[0].stiffness, rtol=1e-9, atol=1e-3)
    np.testing.assert_array_equal(answers[1].shapes, answers[0].shapes)


def test_a_node_with_rotations_holds_alone() -> None:
    # A chain of three nodes with six degrees of freedom each, held together by the stiffness of a short Timoshenko beam.
    names = tuple(f"{node}.{axis}" for node in "abc" for axis in ("x", "y", "z", "rx", "ry", "rz"))
    places = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.2, 0.0, 0.0]])
    stiffness, h = np.zeros((18, 18)), 0.1
    flexibility = np.diag([1e-7, 2e-6, 2e-6, 1e-3, 1e-3, 1e-3])
    for first in (0, 6):
        # Deformation of an element: motion of its end less the rigid motion with its start.
        carry = np.eye(6)
        carry[1, 5], carry[2, 4] = h, -h
        part = np.hstack([-carry, np.eye(6)])
        stiffness[first : first + 12, first : first + 12] += part.T @ np.linalg.inv(flexibility) @ part
    mass = np.kron(np.diag([0.2, 0.3, 0.2]), np.diag([1.0] * 3 + [1e-4] * 3))
    modes = free_body_modes(Structure(mass, stiffness, Dofs(names), nodes=Nodes(tuple("abc"), places)), {"foot": "a"})
    inertia = [0.7e-4, 0.7e-4 + 0.4 * 0.01, 0.7e-4 + 0.4 * 0.01]
    second = modes.pseudo_inertia[1:, 1:]
    np.testing.assert_allclose(np.trace(second) * np.eye(3) - second, np.diag(inertia), atol=1e-15)
    exact = np.sqrt(np.clip(eigh(stiffness, mass, eigvals_only=True), 0, None))[6:] / (2 * np.pi)
    np.testing.assert_allclose(modes.frequencies, exact, rtol=1e-9)


def test_directions_of_derivatives_pass_through(bar: Structure) -> None:
    step = 1e-30
    changed = replace(bar, stiffness=bar.stiffness * (1 + 1j * step), mass=bar.mass * (1 + 2j * step))
    modes = free_body_modes(changed, SIDES, modes=2)
    usual = free_body_modes(bar, SIDES, modes=2)
    np.testing.assert_allclose(
        modes.stiffness.imag / step, usual.stiffness, rtol=1e-9, atol=1e-9 * usual.stiffness.max()
    )
    np.testing.assert_allclose(modes.second.imag / step, 2 * usual.second, rtol=1e-9, atol=1e-10)
    np.testing.assert_allclose(modes.pseudo_inertia.imag / step, 2 * usual.pseudo_inertia, rtol=1e-9, atol=1e-10)


def test_damping_of_the_structure_is_reduced(bar: Structure) -> None:
    damped = free_body_modes(bar.with_damping(Rayleigh(2.0, 1e-5)), SIDES, modes=2)
    np.testing.assert_allclose(
        damped.damping, 2.0 * damped.mass + 1e-5 * damped.stiffness, atol=1e-8 * np.abs(damped.damping).max()
    )


def masses_in_space(places: np.ndarray, springs: list) -> Structure:
    """Masses of 1 kg at places."""
    names = [f"{number}.{axis}" for number in range(len(places)) for axis in "xyz"]
    structure = lumped(dict.fromkeys(names, 1.0), springs)
    return replace(structure, nodes=Nodes(tuple(map(str, range(len(places)))), places))


def test_messages(bar: Structure) -> None:
    held = replace(bar, stiffness=bar.stiffness + 1e9 * bar.mass)
    cases = [
        (held, SIDES, "a displacement along x strains the structure; expected a free one"),
        (bar.with_loss(0.01), SIDES, "hysteretic damping"),
        (bar, {}, "there are no interface nodes"),
        (bar, {"foot": "left", "side": "front"}, "'foot' and 'side' share the node '[0-9]+'; expected separate nodes"),
        (bar, {"foot": bar.nodes.members("left")[:2]}, "'foot' lie on a line or at a point"),
        (plate((1.0, 1.0), 0.01, STEEL, (2, 2)), {"a": "0"}, "moves by displacements x, y, z and rotations"),
        (replace(bar, nodes=None), SIDES, "does not say where its nodes are"),
        (bar, {"foot": []}, "'foot' has no nodes of the structure"),
        (bar, {"foot": "lift"}, "unknown node or set of nodes 'lift'"),
        (bar, {"foot": InterfaceNode("left", (0.0, 0.0, np.nan))}, "the position of the interface node 'foot'"),
        (bar, {"all": bar.nodes.names}, "all nodes belong to interface nodes"),
    ]
    for structure, interfaces, message in cases:
        with pytest.raises(InputError, match=message):
            free_body_modes(structure, interfaces)
    for factors in ((-1.0, 1.0), (1.0, 0.0), ("a", 1.0)):
        with pytest.raises(InputError, match="expected a positive factor"):
            free_body_modes(bar, SIDES, 1).scaled(*factors)
    with pytest.raises(InputError, match="expected a real number"):
        free_body_modes(bar, SIDES, 1, {"gauge": {"0.x": 1j}})
    with pytest.raises(InputError, match="modes is 0; expected 1 or more"):
        free_body_modes(bar, SIDES, modes=0)
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    uneven = masses_in_space(corners, [])
    uneven = replace(uneven, mass=np.diag([1.0, 2.0, 1.0] * 4))
    with pytest.raises(InputError, match="4, 8, 4 kg along x, y and z; expected the same positive mass"):
        free_body_modes(uneven, {"a": ["0", "1", "2"]})
    with pytest.raises(SolveError, match="can move without strains while its interface nodes are held"):
        free_body_modes(masses_in_space(corners, []), {"a": ["0", "1", "2"]})


def test_parts_that_are_not_connected_are_refused() -> None:
    parts = {
        name: solid(box((0.1, 0.1, 0.1), (1, 1, 1), (at, 0.0, 0.0)), STEEL, "brick 27")
        for name, at in (("first", 0.0), ("second", 0.5))
    }
    pair = combine(parts)
    with pytest.raises(InputError, match="moves freely against the others"):
        free_body_modes(pair, {"a": "first/left", "b": "second/right"}, modes=2)
