"""The clamped steel plate of 405 mm × 405 mm × 2 mm: thin-plate elements and solids against Kirchhoff's theory."""

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.linalg import eigh

from dalembert.structure import (
    Material,
    Structure,
    box,
    craig_bampton,
    eigenmodes,
    foot_pairs,
    patched_plate,
    plate,
    solid,
    tie,
)

TOPIC = "Structures"
SOURCE = "Rayleigh-Ritz for the Kirchhoff plate, 16 polynomials each way, computed by the test itself"
STEEL = Material(210e9, 0.3, 7800.0)
SIZE, THICKNESS = (0.405, 0.405), 2e-3


def rayleigh_ritz(modes: int, count: int = 16) -> np.ndarray:
    """Frequencies (Hz) of the clamped square Kirchhoff plate, from above, with (1 - x²)² times Legendre polynomials."""
    points, weights = legendre.leggauss(60)
    clamp = legendre.poly2leg([1.0, 0.0, -2.0, 0.0, 1.0])
    functions = [legendre.legmul(clamp, np.eye(count)[number]) for number in range(count)]
    value, slope, curvature = (
        np.array([legendre.legval(points, legendre.legder(one, order)) for one in functions]) for order in range(3)
    )
    mass, turn, bend = ((one * weights) @ one.T for one in (value, slope, curvature))
    # All round clamped, the energy is that of the squared Laplacian, whatever Poisson's ratio.
    stiffness = np.kron(bend, mass) + np.kron(mass, bend) + 2 * np.kron(turn, turn)
    squares = eigh(stiffness, np.kron(mass, mass), eigvals_only=True, subset_by_index=(0, modes - 1))
    rigidity = STEEL.youngs_modulus * THICKNESS**3 / 12 / (1 - STEEL.poisson_ratio**2)
    return np.sqrt(squares * rigidity / (STEEL.density * THICKNESS)) / (SIZE[0] / 2) ** 2 / (2 * np.pi)


def check(record_evidence, structure: Structure, name: str, tolerances: list[float]) -> None:
    exact = rayleigh_ritz(8)
    ours = eigenmodes(structure.fixed("edge"), 8).frequencies
    for number, (published, found, tolerance) in enumerate(zip(exact, ours, tolerances, strict=True), 1):
        record_evidence(
            f"clamped plate 405 × 405 × 2 mm, {name}, frequency of mode {number}",
            published,
            found,
            unit="Hz",
            tolerance=tolerance * published,
            topic=TOPIC,
            kind="other method",
            source=SOURCE,
        )


def test_thin_plate_elements(record_evidence) -> None:
    check(record_evidence, plate(SIZE, THICKNESS, STEEL, (30, 30)), "30 × 30 Bogner-Fox-Schmit elements", [1e-4] * 8)


@pytest.mark.slow
def test_bricks_of_20_nodes(record_evidence) -> None:
    """One layer through the thickness; the mesh is from above, 24 × 24 × 1 by 0.9 %."""
    allowed = [3.5e-3] * 4 + [3e-3] + [3.5e-3] * 3  # the fifth is the one of the study of friction
    check(
        record_evidence, solid(box((*SIZE, THICKNESS), (60, 60, 1)), STEEL), "60 × 60 × 1 bricks of 20 nodes", allowed
    )


def test_ten_modes_of_the_reduced_plate(record_evidence) -> None:
    """Fifty modes with four forced points and the middles of the edges' strips held; a part in 200 is asked for."""
    full = solid(box((*SIZE, THICKNESS), (14, 14, 1)), STEEL).fixed("edge")
    assert full.nodes is not None
    quarter, middle, near = SIZE[0] / 4, SIZE[0] / 2, SIZE[0] / 20
    places = [(quarter, quarter), (3 * quarter, quarter), (quarter, 3 * quarter), (3 * quarter, 3 * quarter)]
    places += [(middle, near), (middle, SIZE[1] - near), (near, middle), (SIZE[0] - near, middle)]
    masters = [full.nodes.nearest((*place, THICKNESS)) for place in places]
    errors = craig_bampton(full, masters, modes=50).errors(full, 10)
    source = "the full model, 14 × 14 × 1 bricks of 20 nodes"
    record_evidence(
        "clamped plate 405 × 405 × 2 mm, first ten frequencies by Craig-Bampton with 50 modes",
        errors.full,
        errors.reduced,
        unit="Hz",
        tolerance=5e-3,
        relative=True,
        topic=TOPIC,
        kind="other method",
        source=source,
    )
    assert np.all(np.abs(errors.relative) < 5e-3)
    record_evidence(
        "the same, least part of a reduced shape in the full shapes of its frequency",
        1.0,
        errors.similarity.min(),
        tolerance=1e-3,
        topic=TOPIC,
        kind="other method",
        source=source,
    )


@pytest.mark.slow
def test_plate_with_patches(record_evidence) -> None:
    """Bolted patches whose feet are free, and stuck; their measures are chosen for this."""
    unheld = patched_plate()
    whole = unheld.fixed("plate/edge")
    stuck = tie(whole, [(plate, foot) for foot, plate in foot_pairs(whole)])
    assert whole.nodes is not None
    lift = np.array([name.endswith(".z") for name in unheld.dofs.names], dtype=float)
    source = "Ma, Li, Fan, Wu: Friction damping analysis by an accelerated dynamic Lagrangian method (2019)"
    added = lift @ (unheld.mass @ lift) / (STEEL.density * SIZE[0] * SIZE[1] * THICKNESS) - 1
    record_evidence(
        "plate with four patches, added mass",
        0.006,
        added,
        tolerance=5e-5,
        topic=TOPIC,
        kind="published",
        source=f"{source}; chosen",
    )
    quarter, middle = SIZE[0] / 4, SIZE[0] / 2
    places = ((quarter, middle, THICKNESS), (middle, quarter, THICKNESS))
    for state, structure, published in (("free", whole, 400.6), ("stuck", stuck, 408.4)):
        modes = eigenmodes(structure, 6)
        first, second = (modes.shapes[structure.dofs.index(f"{whole.nodes.nearest(place)}.z")] for place in places)
        # Modes 5 and 6 lie close together, and change places: the fifth of the bare plate is antisymmetric.
        ours = modes.frequencies[4:][(first * second)[4:] < -1.0]
        record_evidence(
            f"plate with four patches, {state} feet, frequency of the mode that is the fifth of the bare plate",
            published,
            ours[0],
            unit="Hz",
            tolerance=0.5,
            topic=TOPIC,
            kind="published",
            source=source + ("; chosen" if state == "stuck" else ""),
        )
