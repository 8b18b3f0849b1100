import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.structure import Material, eigenmodes, plate
from support import says

STEEL = Material(210e9, 0.3, 7800.0)


def test_rigid_motions_carry_no_energy_and_all_mass() -> None:
    free = plate((0.4, 0.3), 2e-3, STEEL, (3, 2))
    assert free.nodes is not None
    x, y, _ = free.nodes.places.T
    motions = np.zeros((len(x), 4, 3))  # z, rx = w_y, ry = -w_x, rxy
    motions[:, 0] = np.transpose([np.ones_like(x), y, x])
    motions[:, 1, 1] = 1
    motions[:, 2, 2] = -1
    motions = motions.reshape(-1, 3)
    assert np.abs(free.stiffness @ motions).max() < 1e-9 * np.abs(free.stiffness).max()
    mass = 7800 * 0.4 * 0.3 * 2e-3
    inertia = motions.T @ (free.mass @ motions)
    np.testing.assert_allclose(np.diag(inertia), [mass, mass * 0.3**2 / 3, mass * 0.4**2 / 3])


def test_a_strip_bends_like_a_beam() -> None:
    """Without Poisson's effect, a cantilever's w = x² (3 L - x) / 6 needs the force E I at its end and none between."""
    strip = plate((1.0, 0.1), 0.01, Material(210e9, 0.0, 7800.0), (4, 1))
    assert strip.nodes is not None
    x = strip.nodes.places[:, 0]
    bent = np.transpose([x**2 * (3 - x) / 6, 0 * x, -(x - x**2 / 2), 0 * x]).ravel()
    forces = (strip.stiffness @ bent).reshape(-1, 4)
    rigidity = 210e9 * 0.1 * 0.01**3 / 12
    right, left = (strip.nodes.rows(strip.nodes.members(side)) for side in ("right", "left"))
    np.testing.assert_allclose(forces[right].sum(axis=0)[[0, 2]], [rigidity, 0], atol=1e-9 * rigidity)
    np.testing.assert_allclose(forces[left].sum(axis=0)[[0, 2]], [-rigidity, rigidity], rtol=1e-9)
    between = np.setdiff1d(np.arange(len(x)), [*left, *right])
    assert np.abs(forces[between]).max() < 1e-9 * rigidity


def test_frequencies_converge_with_the_fourth_power_of_the_element() -> None:
    coarse, middle, fine = (
        eigenmodes(plate((1.0, 1.0), 0.01, STEEL, (count, count)).fixed("edge"), 1).frequencies[0]
        for count in (8, 16, 32)
    )
    assert np.log2((coarse - middle) / (middle - fine)) == pytest.approx(4, abs=0.3)


def test_derivatives_run_through_material_and_thickness() -> None:
    step = 1e-30j
    turned = plate((0.4, 0.3), 2e-3 * (1 + step), Material(210e9 * (1 + step), 0.3, 7800 * (1 + step)), (2, 2))
    np.testing.assert_allclose(turned.stiffness.imag.toarray(), 4e-30 * turned.stiffness.real.toarray(), atol=1e-35)
    np.testing.assert_allclose(turned.mass.imag.toarray(), 2e-30 * turned.mass.real.toarray(), atol=1e-45)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: plate((0.4, -0.3), 2e-3, STEEL), "plate: size is (0.4, -0.3); expected two positive numbers in m"),
        (lambda: plate((0.4, 0.3), 0.0, STEEL), "plate: thickness is 0.0 m; expected a positive number"),
        (
            lambda: plate((0.4, 0.3), 2e-3, STEEL, (0, 2)),
            "plate: elements is (0, 2); expected two positive whole numbers",
        ),
        (lambda: Material(-1.0, 0.3, 1.0), "Material: youngs_modulus is -1 Pa; expected a positive number"),
        (lambda: Material(1.0, 0.3, 0.0), "Material: density is 0 kg/m^3; expected a positive number"),
        (
            lambda: Material(1.0, 0.5, 1.0),
            "Material: poisson_ratio is 0.5; expected a number between -1 and 0.5",
        ),
    ],
)
def test_numbers_out_of_range_are_told(make, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        make()
