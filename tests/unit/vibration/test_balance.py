"""The equations of harmonic balance and their Jacobian, against the complex step."""

from collections.abc import Callable

import numpy as np
import pytest

from dalembert.structure import Dofs, Structure
from dalembert.vibration import (
    BilinearStop,
    CubicSpring,
    Elastic,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    Iwan,
    Rigid,
    StaticForce,
    UserElement,
    VibrationSystem,
)
from dalembert.vibration.equations import equations
from dalembert.vibration.fourier import real_blocks

Fill = Callable[[VibrationSystem], None]


def structure() -> Structure:
    """Two nodes with three directions each, and a third that nothing touches."""
    rng = np.random.default_rng(1)
    names = tuple(f"{node}.{axis}" for node in "abc" for axis in "xyz")
    root = rng.normal(size=(9, 9))
    stiffness = root @ root.T + 5 * np.eye(9)
    return Structure(np.diag(rng.uniform(1, 2, 9)), stiffness, Dofs(names), 0.1 * np.eye(9) + 0.02 * stiffness)


def system(fill: Fill) -> VibrationSystem:
    result = VibrationSystem(structure())
    result.add(HarmonicForce("c.x", 3.0, 0.3))
    result.add(HarmonicForce("a.y", 2.0, -0.5, harmonic=2))
    result.add(StaticForce("b.z", 0.5))
    fill(result)
    return result


def springs(to: VibrationSystem) -> None:
    to.add(CubicSpring("cubic", "a.x", "b.x", stiffness=3.0))
    to.add(Gap("gap", "a.x", stiffness=2.0, gap=0.1))
    to.add(BilinearStop("stop", "b.x", stiffness=2.0, gap=0.1))
    to.add(UserElement("user", ["a.x", "b.y"], lambda u: np.stack([u[0] * u[1] ** 2, u[0] ** 2 * u[1]])))


def contact(law: Elastic | Iwan | Rigid, second: str | None = None, **options: object) -> Fill:
    def fill(to: VibrationSystem) -> None:
        to.add(FrictionContact("first", "a", second, friction=0.4, preload=0.3, law=law, **options))  # type: ignore[arg-type]

    return fill


def both(*fills: Fill) -> Fill:
    def fill(to: VibrationSystem) -> None:
        for one in fills:
            one(to)

    return fill


SPATIAL = {"tangential": ("x", "y"), "normal": "-z"}
CASES = {
    "springs": springs,
    "elastic": contact(Elastic(3.0)),
    "elastic-spatial": contact(Elastic(3.0, 4.0, 0.02), "b", **SPATIAL),
    "iwan": contact(Iwan((1.0, 4.0), (0.4, 0.6), 2.0), tangential=("y",), normal="z"),
    "rigid": contact(Rigid()),
    "rigid-velocity": contact(Rigid(kind="velocity")),
    "rigid-spatial": contact(Rigid(gap=0.02), "b", **SPATIAL),
    "rigid-spatial-velocity": contact(Rigid(kind="velocity"), "b", **SPATIAL),
    "rigid-beside-springs": both(contact(Rigid(penalty=7.0), "b", **SPATIAL), springs),
}


@pytest.mark.parametrize("size", [0.003, 0.1, 1.0])
@pytest.mark.parametrize("name", CASES)
def test_the_jacobian_is_that_of_the_complex_step(name: str, size: float) -> None:
    problem = equations(system(CASES[name]), HarmonicBalance(harmonics=3, samples=64))
    balance, point = problem.balance(64), problem.condensation.at(1.3)
    unknowns = np.random.default_rng(2).normal(size=balance.shape) * size
    evaluation, tangent = balance.linearised(point, unknowns)
    blocks = real_blocks(point.stiffness, 1)
    load = balance.series.coefficients(point.force)
    scale = np.abs(tangent.jacobian).max()
    for place in np.ndindex(*balance.shape):
        moved = unknowns.astype(complex)
        moved[place] += 1e-30j
        exact = balance.residual(np.tensordot(blocks, moved, 2) - load, moved).residual.imag / 1e-30
        np.testing.assert_allclose(tangent.jacobian[:, :, *place], exact, atol=1e-12 * scale)
    slope = balance.linear(point.slope, point.force_slope, unknowns)
    linear = balance.linear(point.stiffness, point.force, unknowns)
    stepped = balance.residual(linear + 1e-30j * slope, unknowns)
    np.testing.assert_allclose(tangent.slope, stepped.residual.imag / 1e-30, atol=1e-12 * np.abs(tangent.slope).max())
    np.testing.assert_allclose(evaluation.residual, stepped.residual.real, atol=1e-12 * scale)


def test_the_condensed_structure_and_its_slope_are_those_of_the_whole_one() -> None:
    problem = equations(system(contact(Elastic(3.0, 4.0), "b", **SPATIAL)), HarmonicBalance(harmonics=2))
    lowered, own = problem.lowered, structure()
    rows = lowered.matrix.toarray()
    omega = 1.3
    point = problem.condensation.at(omega)
    series = problem.balance(64).series
    loads = series.phasors(np.real(lowered.loads(series)))
    for number, s in enumerate(omega * np.arange(3)):
        whole = own.stiffness - s**2 * own.mass + 1j * s * own.damping
        np.testing.assert_allclose(np.linalg.inv(point.stiffness[number]), rows @ np.linalg.solve(whole, rows.T))
        force = point.stiffness[number] @ rows @ np.linalg.solve(whole, loads[number])
        np.testing.assert_allclose(point.force[number], force, atol=1e-12)
    up, down = (problem.condensation.at(omega + shift) for shift in (1e-5, -1e-5))
    np.testing.assert_allclose(point.slope, (up.stiffness - down.stiffness) / 2e-5, atol=1e-7)
    np.testing.assert_allclose(point.force_slope, (up.force - down.force) / 2e-5, atol=1e-7)
