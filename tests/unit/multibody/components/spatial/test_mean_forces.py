"""Mean forces of a step: their work is the change of the strain energy, and rigid motions see nothing of them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dalembert.multibody.components.spatial.beam_element import BEAMS
from dalembert.multibody.components.spatial.spatial_cable_element import CABLE
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.model.evaluate import energies, residual
from dalembert.multibody.model.lowering import lower
from spatial_scenes import SCENES, beam

STEP = 0.1
CASES = {f"beam {degree}": (beam(degree), SCENES["beam"][1], BEAMS[degree - 1]) for degree in (1, 2, 3, 4)}
CASES["cable"] = (*SCENES["cable"], CABLE)


def of_step(model: BlockModel, kind, x: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, float]:
    """Mean forces of a kind alone in a step whose middle is ``x``, (N + 1,), and their power without a potential."""
    (middle,) = (entry for entry in model.averaged(True)._kernels if isinstance(entry, BlockModel))
    still, forces, totals = np.zeros_like(x), np.zeros_like(x), np.zeros(3)
    call = middle.call().set(x=x, v=v, a=still, r=forces, totals=totals, step=STEP)
    middle.each("residual", call, only=kind)
    middle.each("energy", call, only=kind)
    return forces, totals[2]


def mean_forces(model: BlockModel, kind, x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The first of both."""
    return of_step(model, kind, x, v)[0]


def lowered(case: str, **fields):
    """Arrays of a scene without gravity, and its kind."""
    build, numbers, kind = CASES[case]
    system = build(**numbers | {"mass_damping": 0.0, "damping": 0.0} | fields)
    system.gravity = (0.0, 0.0, 0.0)
    return lower(system), kind


@pytest.mark.parametrize("case", [pytest.param(case, marks=[pytest.mark.slow] * (case != "beam 2")) for case in CASES])
def test_their_work_is_the_change_of_the_energy(case):
    own, kind = lowered(case)
    n, rng = own.structure.n, np.random.default_rng(2)
    x, way = own.x.copy(), 0.1 * rng.normal(size=len(own.x))
    x[n:] = way[n:] = 0.0
    forces = mean_forces(own.real, kind, x, way / STEP)
    times, still = np.zeros(2), np.zeros((2, len(x)))
    before, after = energies(own.real, np.stack([x - way / 2, x + way / 2]), still, times, times)[:, 1]
    assert forces @ way == pytest.approx(after - before, rel=1e-7 if case == "cable" else 1e-9)
    for axis in range(3):
        total = forces[:n][np.flatnonzero(np.array(own.structure.kinds) == "position")[axis::3]].sum()
        assert abs(total) < 1e-11 * np.abs(forces).max()


@pytest.mark.parametrize("case", [pytest.param(case, marks=[pytest.mark.slow] * (case != "beam 2")) for case in CASES])
def test_at_rest_they_are_the_forces(case):
    own, kind = lowered(case)
    still = np.zeros_like(own.x)
    x = own.x + 0.05 * np.random.default_rng(3).normal(size=len(still))
    x[own.structure.n :] = 0.0
    forces = residual(own, own.real, x, still, still, only=kind)
    np.testing.assert_allclose(mean_forces(own.real, kind, x, still)[:-1], forces, atol=1e-13 * np.abs(forces).max())


@pytest.mark.parametrize("case", [pytest.param(case, marks=[pytest.mark.slow] * (case != "beam 2")) for case in CASES])
def test_damping_takes_what_their_power_says(case):
    own, kind = lowered(case, damping=0.05, mass_damping=0.3)
    way = 0.1 * np.random.default_rng(4).normal(size=len(own.x))
    way[own.structure.n :] = 0.0
    forces, power = of_step(own.real, kind, own.x, way / STEP)
    times, still = np.zeros(2), np.zeros((2, len(way)))
    before, after = energies(own.real, np.stack([own.x - way / 2, own.x + way / 2]), still, times, times)[:, 1]
    assert power < 0.0
    assert forces @ way == pytest.approx(after - before - STEP * power, rel=1e-7)


@pytest.mark.parametrize("case", [pytest.param(case, marks=[pytest.mark.slow] * (case != "beam 2")) for case in CASES])
def test_a_rigid_rotation_loses_nothing(case):
    """Of a beam about any axis; of a cable about one across its line, which is straight."""
    fields = {"span": 0.8, "bending_stiffness": 0.3} if case == "cable" else {}
    own, kind = lowered(case, damping=0.05, **fields)
    n, axis = own.structure.n, np.array([0.3, -0.5, 0.8])
    vectors = own.x[:n].reshape(-1, 3)
    if case == "cable":
        axis = np.cross(vectors[-3], axis)
    turned = [Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).apply(vectors) for angle in (-0.3, 0.3)]
    before, after = (np.append(part.ravel(), np.zeros(len(own.x) - n)) for part in turned)
    forces, power = of_step(own.real, kind, (before + after) / 2, (after - before) / STEP)
    assert abs(power) < 1e-12
    assert forces @ (after - before) == pytest.approx(0.0, abs=1e-12)
