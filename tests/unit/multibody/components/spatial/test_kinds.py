"""Kernels of component kinds in space: formulas against automatic differentiation, forces against energies."""

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dalembert.multibody.components.spatial.kinds import no_residual
from dalembert.multibody.components.spatial.line_force import ON_CABLE
from dalembert.multibody.kernels.block_table import c_function
from dalembert.multibody.kernels.constraints import forces_of, rates_of
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.records import Inputs
from dalembert.multibody.model.evaluate import constraint_rates, energies, residual
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower
from spatial_scenes import SCENES

TIME = 0.3
#: Their energies and powers are those of aligned axes, and of points on the axis.
ALIGNED = {"prismatic, rubbing", "motor", "motor to ground"}
#: Their torques are those of rotations: they do what energies lose where directors are orthonormal.
RIGID = {"bushing", "bushing to ground", "rigid body", "beam", "reduced body"}


@cache
def lowered(scene: str) -> Lowered:
    build, fields = SCENES[scene]
    return lower(build(**fields))


FOUND = {kind: scene for scene in SCENES for kind in lowered(scene).data}
CONSTRAINED = [kind for kind in FOUND if kind.constraint is not None]


def states(dtype: type, size: int, seed: int = 1) -> np.ndarray:
    """Unknowns, velocities and accelerations (3, size); in complex numbers with a direction."""
    chance = np.random.default_rng(seed)
    values = chance.normal(size=(3, size)).astype(dtype)
    if dtype is complex:
        values += 1j * STEP * chance.normal(size=(3, size))
    return values


def component(kind: Kind, dtype: type) -> tuple:
    """Local states, numbers, integers and inputs of the first component of a kind."""
    model = lowered(FOUND[kind]).model(dtype)
    numbers, integers = None, None
    if kind.numbers:
        numbers = model.blocks.numbers[kind].view(kind.number_record(dtype)).view(np.recarray).ravel()[0]
    if kind.integers:
        integers = model.blocks.integers[kind].view(kind.integer_record).view(np.recarray).ravel()[0]
    call = model.call()
    model.evaluate(call, TIME, TIME)
    return (*states(dtype, kind.width), numbers, integers, Inputs(call.signals, model.callbacks))


@pytest.mark.parametrize("dtype", [float, complex])
@pytest.mark.parametrize("kind", [kind for kind in CONSTRAINED if kind.forces], ids=lambda kind: kind.name)
def test_formulas_of_constraint_forces_are_those_of_the_jacobian(kind: Kind, dtype: type) -> None:
    x, _, _, p, m, inputs = component(kind, dtype)
    by_formula, automatic = np.zeros((2, kind.width), dtype)
    kind.forces(x, p, m, by_formula)
    forces_of(kind.constraint, kind.coordinates, kind.multipliers)(x, p, m, inputs, automatic)
    np.testing.assert_allclose(by_formula.real, automatic.real, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(by_formula.imag, automatic.imag, rtol=1e-12, atol=1e-12 * STEP)
    assert np.abs(automatic).max() > 0.01


@pytest.mark.parametrize("kind", CONSTRAINED, ids=lambda kind: kind.name)
def test_rates_are_slopes_of_the_constraint_along_a_motion(kind: Kind) -> None:
    x, v, a, p, m, inputs = component(kind, float)
    rate, second = np.zeros((2, kind.multipliers))
    rates_of(kind.constraint, kind.multipliers)(x, v, a, p, m, inputs, rate, second)

    def along(t: float) -> np.ndarray:
        value, rates, seconds = inputs.signals.T
        signals = np.stack([value + rates * t + seconds * t * t / 2, rates, seconds], axis=1)
        g = np.zeros(kind.multipliers)
        kind.constraint(x + v * t + a * t * t / 2, p, m, Inputs(signals, inputs.callbacks), g)
        return g

    h = 1e-3
    middle = along(0.0)
    values = [along(k * h) for k in range(-2, 3)]
    values = [own - 2 * np.pi * np.round((own - middle) / (2 * np.pi)) for own in values]  # angles jump by whole turns
    slope = (values[0] - 8 * values[1] + 8 * values[3] - values[4]) / (12 * h)
    bend = (-values[0] + 16 * values[1] - 30 * values[2] + 16 * values[3] - values[4]) / (12 * h * h)
    np.testing.assert_allclose(rate, slope, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(second, bend, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("scene", [scene for scene in SCENES if scene not in ALIGNED])
def test_forces_do_what_energies_lose(scene: str) -> None:
    """Residual . v = d(T + V)/dt - power + multipliers . d(constraints)/dt, for any state, or any rigid one."""
    own = lowered(scene)
    n = own.structure.n
    for seed in range(2):
        noise = states(float, len(own.x), seed)
        x, v, a = own.x + 0.1 * noise[0], noise[1], noise[2]
        if scene in RIGID:
            for name, first in own.structure.first.items():
                if own.bodies[name].turns:
                    for node in range(first, first + own.bodies[name].size - 11, 12):
                        turned = Rotation.from_rotvec(0.5 * noise[0, node : node + 3]).as_matrix()
                        x[node + 3 : node + 12] = turned.T.ravel()
                        v[node + 3 : node + 12] = np.cross(noise[1, node : node + 3], turned.T).ravel()
        x[n:], v[n:], a[n:] = 20 * noise[0, n:], 0.0, 0.0
        x[-1] = 0.0
        moved = x + 0j
        moved[:n] += 1j * STEP * v[:n]
        times = np.array([TIME])
        complex_state = energies(own.complex_model, moved[None], (v + 1j * STEP * a)[None], times, times)[0]
        power = energies(own.real, x[None], v[None], times, times)[0, 2]
        rate, _ = constraint_rates(own, own.real, x, v, a, TIME)
        terms = residual(own, own.real, x, v, a, TIME)[:n] * v[:n]
        given = (complex_state[0] + complex_state[1]).imag / STEP - power + x[n:-1] @ rate
        assert np.sum(terms) == pytest.approx(given, abs=1e-12 * np.sum(np.abs(terms)))


@pytest.mark.slow
@pytest.mark.parametrize("reduces", [False, True])
@pytest.mark.parametrize("kind", [kind for kind in FOUND if kind.has("tangent")], ids=lambda kind: kind.name)
def test_tangents_by_duals_are_those_by_complex_steps(kind: Kind, reduces: bool) -> None:
    own = lowered(FOUND[kind])
    if (reduces and kind.chart is not None) or own.callbacks:
        return
    couplings, sizes = own.structure.full, (own.structure.n, own.structure.size)
    if reduces:
        couplings, sizes = own.structure.reduced, (own.structure.reduction.increments, own.structure.reduction.size)
    slots, rows, _ = couplings.separate
    x, v, a = states(float, len(own.x))
    x[-1] = v[-1] = a[-1] = 0.0
    number, answers = list(couplings.index).index(kind), np.zeros((2, len(rows)))
    for model, matrix in zip((own.model(float), own.model(complex)), answers, strict=True):
        block = model._words[2 if reduces else 1][number : number + 1].ctypes.data
        call = model.call().set(x=x, v=v, a=a, matrix=matrix, entries=len(matrix), slots=slots[number])
        call.set(by_x=0.7, by_v=1.3, by_a=0.4, motion=1.0, constraint=2.0, increments=sizes[0], last_row=sizes[1])
        model.evaluate(call, TIME, TIME)
        c_function(kind.kernel("tangent", model.dtype).address)(call.address, block)
    np.testing.assert_allclose(answers[0], answers[1], rtol=0, atol=1e-13 * np.abs(answers[1]).max())
    if kind.residual is not no_residual and kind is not ON_CABLE:  # whose force is dead
        assert np.abs(answers[1]).max() > 0.01
