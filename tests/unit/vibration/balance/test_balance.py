"""The equations of harmonic balance and their Jacobian, against the complex step."""

from collections.abc import Callable

import numpy as np
import pytest

from dalembert.structure import Dofs, Structure
from dalembert.vibration import (
    BilinearStop,
    CubicSpring,
    ElasticSlider,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    Iwan,
    Rigid,
    StaticForce,
    UserElement,
    VibrationSystem,
    frequency_response,
)
from dalembert.vibration.balance import balance as module
from dalembert.vibration.balance import block_tangent
from dalembert.vibration.balance.equations import equations
from dalembert.vibration.balance.first_guesses import at_rest
from dalembert.vibration.balance.tangents import BlockTangent, DenseTangent, bordered, orientation
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


def contact(law: ElasticSlider | Iwan | Rigid, second: str | None = None, **options: object) -> Fill:
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
    "elastic": contact(ElasticSlider(3.0)),
    "elastic-spatial": contact(ElasticSlider(3.0, 4.0, 0.02), "b", **SPATIAL),
    "iwan": contact(Iwan((1.0, 4.0), (0.4, 0.6), 2.0), tangential=("y",), normal="z"),
    "rigid": contact(Rigid()),
    "rigid-velocity": contact(Rigid(prediction="velocity")),
    "rigid-spatial": contact(Rigid(gap=0.02), "b", **SPATIAL),
    "rigid-spatial-velocity": contact(Rigid(prediction="velocity"), "b", **SPATIAL),
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
        exact = balance.residual(np.tensordot(blocks, moved, 2) - load, moved, point.omega).residual.imag / 1e-30
        np.testing.assert_allclose(tangent.jacobian[:, :, *place], exact, atol=1e-12 * scale)
    slope = balance.linear(point.slope, point.force_slope, unknowns)
    linear = balance.linear(point.stiffness, point.force, unknowns)
    stepped = balance.residual(linear + 1e-30j * slope, unknowns, point.omega)
    np.testing.assert_allclose(tangent.slope, stepped.residual.imag / 1e-30, atol=1e-12 * np.abs(tangent.slope).max())
    np.testing.assert_allclose(evaluation.residual, stepped.residual.real, atol=1e-12 * scale)


def test_the_condensed_structure_and_its_slope_are_those_of_the_whole_one() -> None:
    problem = equations(system(contact(ElasticSlider(3.0, 4.0), "b", **SPATIAL)), HarmonicBalance(harmonics=2))
    lowered, own = problem.lowered, structure()
    rows = lowered.matrix.toarray()
    omega = 1.3
    point = problem.condensation.at(omega)
    series = problem.balance(64).series
    loads = lowered.loads(series).constant
    for number, s in enumerate(omega * np.arange(3)):
        whole = own.stiffness - s**2 * own.mass + 1j * s * own.damping
        np.testing.assert_allclose(np.linalg.inv(point.stiffness[number]), rows @ np.linalg.solve(whole, rows.T))
        force = point.stiffness[number] @ rows @ np.linalg.solve(whole, loads[number])
        np.testing.assert_allclose(point.force[number], force, atol=1e-12)
    up, down = (problem.condensation.at(omega + shift) for shift in (1e-5, -1e-5))
    np.testing.assert_allclose(point.slope, (up.stiffness - down.stiffness) / 2e-5, atol=1e-7)
    np.testing.assert_allclose(point.force_slope, (up.force - down.force) / 2e-5, atol=1e-7)


def mixed(to: VibrationSystem) -> None:
    """Elastic and rigid contacts and springs, each on coordinates of its own."""
    to.add(FrictionContact("first", "a", friction=0.4, preload=0.3, law=Rigid(), **SPATIAL))  # type: ignore[arg-type]
    to.add(FrictionContact("second", "b", friction=0.4, preload=0.3, law=ElasticSlider(3.0)))
    to.add(CubicSpring("cubic", "b.y", stiffness=3.0))
    to.add(UserElement("user", ["c.x", "c.y"], lambda u: np.stack([u[0] * u[1] ** 2, u[0] ** 2 * u[1]])))


SEPARATE = {name: CASES[name] for name in ("elastic", "elastic-spatial", "iwan", "rigid", "rigid-spatial")}
SEPARATE |= {"mixed": mixed}


@pytest.mark.parametrize("direct", [0, 1000], ids=["iterated", "direct"])
@pytest.mark.parametrize("size", [0.003, 0.1, 1.0])
@pytest.mark.parametrize("name", SEPARATE)
def test_the_jacobian_by_its_structure_is_the_dense_one(
    name: str, size: float, direct: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = equations(system(SEPARATE[name]), HarmonicBalance(harmonics=3, samples=64))
    balance, point = problem.balance(64), problem.condensation.at(1.3)
    rng = np.random.default_rng(2)
    unknowns = rng.normal(size=balance.shape) * size
    _, dense = balance.linearised(point, unknowns)
    monkeypatch.setattr(module, "LARGE", 0)
    monkeypatch.setattr(block_tangent, "DIRECT", direct)
    _, block = balance.linearised(point, unknowns)
    assert isinstance(dense, DenseTangent)
    assert isinstance(block, BlockTangent)
    np.testing.assert_allclose(block.jacobian, dense.jacobian, atol=1e-11 * np.abs(dense.jacobian).max())
    np.testing.assert_allclose(block.slope, dense.slope, atol=1e-11 * np.abs(dense.slope).max())
    right = rng.normal(size=(*balance.shape, 2))
    expected = dense.solve(right)
    np.testing.assert_allclose(block.solve(right), expected, atol=1e-8 * np.abs(expected).max())
    direction = rng.normal(size=unknowns.size + 1)
    solved = [bordered(own, direction, (0.1, 2.0, 3.0), right[:, :, 0], 0.7) for own in (dense, block)]
    for one, other in zip(*solved, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-7, atol=1e-9 * np.abs(one).max())
    for row in (direction, -direction, rng.normal(size=direction.shape)):
        signs = [orientation(own, row, (0.1, 2.0, 3.0)) for own in (dense, block)]
        assert signs[0] == signs[1] != 0


def gears(to: VibrationSystem) -> None:
    """Contacts and a stop that alone hold two nodes against each other and the ground."""
    to.add(FrictionContact("joint", "a", "b", friction=0.4, preload=0.3, law=ElasticSlider(3.0, 4.0), **SPATIAL))  # type: ignore[arg-type]
    to.add(FrictionContact("foot", "b", friction=0.4, preload=0.3, law=Rigid(penalty=3.0), **SPATIAL))  # type: ignore[arg-type]
    to.add(Gap("stop", "c.z", stiffness=2.0, gap=0.5))


def loose(fill: Fill) -> VibrationSystem:
    """Three bodies that no spring holds."""
    names = tuple(f"{node}.{axis}" for node in "abc" for axis in "xyz")
    result = VibrationSystem(Structure(np.diag(np.arange(1.0, 10.0)), np.zeros((9, 9)), Dofs(names), 0.1 * np.eye(9)))
    result.add(HarmonicForce("c.x", 3.0, 0.3))
    fill(result)
    return result


@pytest.mark.parametrize("direct", [0, 1000], ids=["iterated", "direct"])
@pytest.mark.parametrize("size", [0.003, 0.1, 1.0], ids=["closed and open", "slipping", "all open at times"])
def test_linear_systems_of_a_part_that_elements_alone_hold_are_solved_without_singular_values(
    size: float, direct: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = equations(loose(gears), HarmonicBalance(harmonics=3, samples=64))
    balance, point = problem.balance(64), problem.condensation.at(1.3)
    assert point.free_motions.shape[1] == 7
    rng = np.random.default_rng(2)
    unknowns = rng.normal(size=balance.shape) * size
    _, dense = balance.linearised(point, unknowns)
    monkeypatch.setattr(module, "LARGE", 0)
    monkeypatch.setattr(block_tangent, "DIRECT", direct)
    _, block = balance.linearised(point, unknowns)
    assert isinstance(dense, DenseTangent)
    assert isinstance(block, BlockTangent)
    np.testing.assert_allclose(block.jacobian, dense.jacobian, atol=1e-11 * np.abs(dense.jacobian).max())
    # Right-hand sides that are in balance: of all solutions the one with the smallest mean positions.
    right = (dense.matrix @ rng.normal(size=(unknowns.size, 2))).reshape(*balance.shape, 2)
    expected = np.linalg.lstsq(dense.matrix, right.reshape(-1, 2), rcond=1e-11)[0].reshape(right.shape)
    for tangent in (dense, block):
        np.testing.assert_allclose(tangent.solve(right), expected, atol=1e-8 * np.abs(expected).max())
    direction = rng.normal(size=unknowns.size + 1)
    solved = [bordered(own, direction, (0.1, 2.0, 3.0), right[:, :, 0], 0.7) for own in (dense, block)]
    for one, other in zip(*solved, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-7, atol=1e-9 * np.abs(one).max())
    signs = [orientation(own, direction, (0.1, 2.0, 3.0)) for own in (dense, block)]
    assert signs[0] == signs[1] != 0


def test_a_mean_force_that_no_element_resists_moves_towards_contact() -> None:
    to_stop = VibrationSystem(Structure(np.eye(1), np.zeros((1, 1)), Dofs(("m.x",)), 0.1 * np.eye(1)))
    to_stop.add(StaticForce("m.x", 0.1))
    to_stop.add(HarmonicForce("m.x", 0.01))
    to_stop.add(Gap("stop", "m.x", stiffness=2.0, gap=1.0))
    problem = equations(to_stop, HarmonicBalance(harmonics=1))
    balance, point = problem.balance(64), problem.condensation.at(1.0)
    evaluation, tangent = balance.linearised(point, np.zeros(balance.shape))
    assert tangent.unresisted.shape == (1, 1)
    step = -tangent.solve(evaluation.residual[:, :, None])
    assert step[0, 0, 0] == pytest.approx(0.1 / 2.0)  # as the closed stop would yield
    np.testing.assert_allclose(at_rest(balance, point), [[1.0 + 0.1 / 2.0, 0.0, 0.0]], rtol=1e-12)


def test_curves_by_the_structure_are_the_dense_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    ends, method = (0.05, 0.07), HarmonicBalance(harmonics=3, samples=64, resolution=0.2)
    dense = [frequency_response(system(mixed), ends, method, continuation=way) for way in ("natural", "arc-length")]
    monkeypatch.setattr(module, "LARGE", 0)
    block = [frequency_response(system(mixed), ends, method, continuation=way) for way in ("natural", "arc-length")]
    for one, other in zip(dense, block, strict=True):
        assert one.converged.all()
        np.testing.assert_allclose(one.amplitude("a.x"), other.amplitude("a.x"), rtol=1e-6)
