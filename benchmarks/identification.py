"""Young's moduli of both cables from the motion of joint and tip (41 samples), beside Exudyn with SciPy.

The peer is what its user would write: SciPy's least squares over repeated simulations, differences for the Jacobian,
one start; once in the moduli themselves, once in their logarithms, which was measured to serve it better.
Both sides may move within 1/50 and 50 times the truth.
"""

import time
from collections.abc import Callable

import numpy as np
from scipy.optimize import least_squares

import dalembert as da
from benchmarks import ours, timing
from benchmarks.cases import PENDULUM
from benchmarks.peers import exudyn_models as peers

TRUTH = np.array([PENDULUM.oa.youngs_modulus, PENDULUM.ab.youngs_modulus])
REACH = 50.0
NOISE = 0.01  # m
STARTS = {"(2, 0.5) x truth": (2.0, 0.5), "(5, 0.2) x truth": (5.0, 0.2)}


def main() -> list[dict[str, object]]:
    peer = peers.flexible_pendulum(PENDULUM)
    exact = peer.run()
    noisy = exact + np.random.default_rng(0).normal(0.0, NOISE, exact.shape)
    tasks = [(name, factors, exact, 0.0) for name, factors in STARTS.items()]
    tasks += [(f"{name}, 10 mm noise", factors, noisy, NOISE) for name, factors in STARTS.items()]
    _ours((2.0, 0.5), exact, 0.0)  # compiles, or loads what was compiled
    rows = [row for task in tasks for row in _beside(peer, *task)]
    timing.report(
        "identification", "Identify E_OA and E_AB; a false minimum is a fit worse than that of the truth", rows
    )
    return rows


def _beside(peer: peers.Peer, name: str, factors, data: np.ndarray, noise: float) -> list[dict[str, object]]:
    methods: dict[str, Callable[[], tuple[np.ndarray, int]]] = {
        "dalembert": lambda: _ours(factors, data, noise),
        "Exudyn + SciPy, log E": lambda: _theirs(peer, factors, data, np.log, np.exp),
        "Exudyn + SciPy, E": lambda: _theirs(peer, factors, data, np.asarray, np.asarray),
    }
    rows = []
    for method, run in methods.items():
        before = time.perf_counter()
        found, simulations = run()
        seconds = time.perf_counter() - before
        rows.append(
            {
                "start": name,
                "method": method,
                "seconds": seconds,
                "simulations": simulations,
                "E_OA / truth": float(found[0]),
                "E_AB / truth": float(found[1]),
                "minimum": _judge(peer, found, data),
            }
        )
    return [row | {"ratio": row["seconds"] / rows[0]["seconds"]} for row in rows]


def _ours(factors, data: np.ndarray, noise: float) -> tuple[np.ndarray, int]:
    names = ("youngs_oa", "youngs_ab")
    model = da.TimeResponse(
        lambda youngs_oa, youngs_ab: ours.cable_pendulum(youngs_oa=youngs_oa, youngs_ab=youngs_ab),
        parameters=[
            da.Parameter(name, truth / REACH, truth * REACH, unit="Pa", scale=truth * factor, start=truth * factor)
            for name, truth, factor in zip(names, TRUTH, factors, strict=True)
        ],
        channels=ours.JOINT_AND_TIP,
        times=PENDULUM.integration.times,
        solver=ours.solver(PENDULUM.integration),
    )
    deviations = np.full(data.shape[1], noise) if noise else None
    columns = dict(zip(ours.JOINT_AND_TIP, data.T, strict=True))
    measured = da.Measurements.of(PENDULUM.integration.times, columns, deviations)
    fit = da.identify(model, measured, seed=0)
    return fit.values / TRUTH, fit.simulations


def _theirs(peer: peers.Peer, factors, data: np.ndarray, there, back) -> tuple[np.ndarray, int]:
    runs = 0

    def residuals(unknowns: np.ndarray) -> np.ndarray:
        nonlocal runs
        runs += 1
        return (_simulated(peer, back(unknowns)) - data).ravel()

    bounds = (there(np.full(2, 1 / REACH)), there(np.full(2, REACH)))
    result = least_squares(residuals, there(np.array(factors)), bounds=bounds, diff_step=1e-6)
    return back(result.x), runs


def _simulated(peer: peers.Peer, multiples: np.ndarray) -> np.ndarray:
    for bar, youngs_modulus in enumerate(TRUTH * multiples):
        peer.stiffness(bar, youngs_modulus)
    return peer.run()


def _judge(peer: peers.Peer, found: np.ndarray, data: np.ndarray) -> str:
    cost, least = (np.sum((_simulated(peer, point) - data) ** 2) for point in (found, np.ones(2)))
    return "right" if cost <= 1.001 * least + 1e-10 else "false"


if __name__ == "__main__":
    main()
