"""Mean forces of a step: their work is the change of the strain energy, and rigid motions see nothing of them."""

import numpy as np
import pytest

from dalembert.multibody.components.spatial.beam_element import BEAMS
from dalembert.multibody.components.spatial.cable_element import CABLE
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.model.evaluate import energies, residual
from dalembert.multibody.model.lowering import lower
from spatial_scenes import SCENES, beam

STEP = 0.1
CASES = {f"beam {degree}": (beam(degree), SCENES["beam"][1], BEAMS[degree - 1]) for degree in (1, 2, 3, 4)}
CASES["cable"] = (*SCENES["cable"], CABLE)


def mean_forces(model: BlockModel, kind, x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Mean forces of a kind alone in a step whose middle is ``x``, (N + 1,)."""
    (middle,) = (entry for entry in model.averaged()._kernels if isinstance(entry, BlockModel))
    still, forces = np.zeros_like(x), np.zeros_like(x)
    middle.each("residual", middle.call().set(x=x, v=v, a=still, r=forces, step=STEP), only=kind)
    return forces


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
    np.testing.assert_allclose(mean_forces(own.real, kind, x, still), forces, atol=1e-13 * np.abs(forces).max())


@pytest.mark.parametrize("case", [pytest.param(case, marks=[pytest.mark.slow] * (case != "beam 2")) for case in CASES])
def test_damping_takes_energy(case):
    own, kind = lowered(case, damping=0.05)
    undamped, _ = lowered(case)
    way = 0.1 * np.random.default_rng(4).normal(size=len(own.x))
    way[own.structure.n :] = 0.0
    work = [mean_forces(entry.real, kind, entry.x, way / STEP) @ way for entry in (undamped, own)]
    assert work[1] > work[0]
