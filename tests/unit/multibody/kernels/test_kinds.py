"""Kernels of component kinds: against plain Python, and formulas against automatic differentiation."""

from functools import cache

import numpy as np
import pytest

import mechanisms
from dalembert.kernels.kernel import inlined
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.constraints import forces_of, rates_of
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.records import Inputs
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower

TIME = 0.3


@cache
def everything() -> Lowered:
    return lower(mechanisms.mechanism(*mechanisms.PIECES))


KINDS = list(everything().data)
CONSTRAINED = [kind for kind in KINDS if kind.constraint is not None]
ROLES = [(kind, role) for kind in KINDS for role in ("residual", "rates", "energy", "outputs") if kind.has(role)]


def states(dtype: type, size: int) -> np.ndarray:
    """Unknowns, velocities and accelerations (3, size); in complex numbers with a direction."""
    chance = np.random.default_rng(1)
    values = chance.normal(size=(3, size)).astype(dtype)
    if dtype is complex:
        values += 1j * STEP * chance.normal(size=(3, size))
    values[:, -1] = 0.0
    return values


@pytest.mark.parametrize("dtype", [float, complex])
@pytest.mark.parametrize(("kind", "role"), ROLES, ids=lambda entry: getattr(entry, "name", entry))
def test_a_kernel_does_what_its_python_does(kind: Kind, role: str, dtype: type) -> None:
    model = everything().model(dtype).need(role)
    row = list(model.blocks.index).index(kind)
    x, v, a = states(dtype, model.size + 1)
    results = []
    for plain in (False, True):
        out = np.zeros((4, max(model.size + 1, len(model.blocks.index[kind]) * max(len(kind.outputs), 1))), dtype)
        fields = dict(zip(("r", "rate", "second", "totals"), out, strict=True))
        call = model.call().set(x=x, v=v, a=a, **fields)
        model.evaluate(call, TIME, TIME)
        kernel = kind.kernel(role, dtype)
        (kernel.function if plain else kernel)(call.address, model._words[1][row : row + 1].ctypes.data)
        results.append(out)
    compiled, expected = results
    np.testing.assert_allclose(compiled.real, expected.real, rtol=1e-13, atol=1e-13)
    size = np.abs(expected.imag).max()
    np.testing.assert_allclose(compiled.imag, expected.imag, rtol=1e-12, atol=1e-13 * size)


def component(model: BlockModel, kind: Kind, dtype: type) -> tuple:
    """Local states, numbers, integers and inputs of the first component of a kind."""
    numbers = model.blocks.numbers[kind].view(kind.number_record(dtype)).view(np.recarray).ravel()[0]
    integers = model.blocks.integers[kind].view(kind.integer_record).view(np.recarray).ravel()[0]
    call = model.call()
    model.evaluate(call, TIME, TIME)
    return (*states(dtype, kind.width + 1)[:, :-1], numbers, integers, Inputs(call.signals, model.callbacks))


@pytest.mark.parametrize("dtype", [float, complex])
@pytest.mark.parametrize("kind", [kind for kind in CONSTRAINED if kind.forces], ids=lambda kind: kind.name)
def test_formulas_of_constraint_forces_are_those_of_the_jacobian(kind: Kind, dtype: type) -> None:
    x, _, _, p, m, inputs = component(everything().model(dtype), kind, dtype)
    by_formula, automatic = np.zeros((2, kind.width), dtype)
    kind.forces(x, p, m, by_formula)
    forces_of(kind.constraint, kind.coordinates, kind.multipliers)(x, p, m, inputs, automatic)
    np.testing.assert_allclose(by_formula.real, automatic.real, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(by_formula.imag, automatic.imag, rtol=1e-12, atol=1e-13 * STEP)
    assert np.abs(automatic).max() > 0.01


@pytest.mark.parametrize("kind", CONSTRAINED, ids=lambda kind: kind.name)
def test_rates_are_slopes_of_the_constraint_along_a_motion(kind: Kind) -> None:
    x, v, a, p, m, inputs = component(everything().model(float), kind, float)
    rate, second = np.zeros((2, kind.multipliers))
    rates_of(kind.constraint, kind.multipliers)(x, v, a, p, m, inputs, rate, second)

    def along(t: float) -> np.ndarray:
        value, rates, seconds = inputs.signals.T
        signals = np.stack([value + rates * t + seconds * t * t / 2, rates, seconds], axis=1)
        g = np.zeros(kind.multipliers)
        kind.constraint(x + v * t + a * t * t / 2, p, m, Inputs(signals, inputs.callbacks), g)
        return g

    h = 1e-3
    values = [along(k * h) for k in range(-2, 3)]
    slope = (values[0] - 8 * values[1] + 8 * values[3] - values[4]) / (12 * h)
    bend = (-values[0] + 16 * values[1] - 30 * values[2] + 16 * values[3] - values[4]) / (12 * h * h)
    np.testing.assert_allclose(rate, slope, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(second, bend, rtol=1e-6, atol=1e-6)


def test_kinds_of_the_same_name_outside_the_package_have_different_kernels() -> None:
    """Such as two user's files, or a cell of a notebook that was changed: each runs its code."""

    def kind(factor: float) -> Kind:
        @inlined
        def weigh(x, v, a, p, m, inputs, r):
            r[0] = factor * p.mass * a[0]

        return Kind("weight", coordinates=1, numbers=("mass",), residual=weigh)

    symbols = {kind(factor).kernel(role, float).symbol for factor in (1.0, 2.0) for role in ("residual", "energy")}
    assert len(symbols) == 4
    assert kind(1.0).kernel("residual", float).symbol == kind(1.0).kernel("residual", float).symbol
    package = next(own for own in KINDS if own.module.startswith("dalembert."))
    assert package.kernel("residual", float).symbol == f"dal_kind_{package.name}_residual_float"
