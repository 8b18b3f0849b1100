"""Forces against energies: what a component's forces do is what its energies lose.

For any state and any multipliers: residual . v = d(T + V)/dt - power + multipliers . d(constraints)/dt. A wrong sign or
factor in a residual, in an energy, in a power or in a constraint rate shows here.
"""

import numpy as np
import pytest

import mechanisms
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.model.evaluate import constraint_rates, energies, residual
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower

TIME = 0.37


def state(lowered: Lowered, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Coordinates near the first ones, any multipliers, velocities and accelerations; the last entry is zero."""
    noise = np.random.default_rng(seed).normal(size=(3, len(lowered.x)))
    n = lowered.structure.n
    x, v, a = lowered.x + 0.1 * noise[0], noise[1], noise[2]
    x[n:], v[n:], a[n:] = 20 * noise[0, n:], 0.0, 0.0
    x[-1] = 0.0
    return x, v, a


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("piece", mechanisms.PIECES)
def test_forces_do_what_energies_lose(piece: str, seed: int) -> None:
    lowered = lower(mechanisms.mechanism(piece))
    n = lowered.structure.n
    x, v, a = state(lowered, seed)
    moved = x + 0j
    moved[:n] += 1j * STEP * v[:n]
    times = np.array([TIME])
    complex_state = energies(lowered.complex_model, moved[None], (v + 1j * STEP * a)[None], times, times)[0]
    power = energies(lowered.real, x[None], v[None], times, times)[0, 2]
    rate, _ = constraint_rates(lowered, lowered.real, x, v, a, TIME)
    terms = residual(lowered, lowered.real, x, v, a, TIME)[:n] * v[:n]
    given = (complex_state[0] + complex_state[1]).imag / STEP - power + x[n:-1] @ rate
    assert np.sum(terms) == pytest.approx(given, abs=1e-12 * np.sum(np.abs(terms)))


@pytest.mark.parametrize("piece", [name for name in mechanisms.DISSIPATIVE if "damped" in name or "friction" in name])
def test_dampers_and_friction_only_take_energy(piece: str) -> None:
    lowered = lower(mechanisms.mechanism(piece))
    times = np.array([TIME])
    for seed in range(5):
        x, v, _ = state(lowered, seed)
        assert energies(lowered.real, x[None], v[None], times, times)[0, 2] < 0
