"""Price of a gradient by the adjoint, in forward runs, beside that of all direct sensitivities.

The flexible double pendulum, whose tip is pushed by an unknown force: a B-spline whose coefficients are the parameters.
"""

import numba
import numpy as np

import dalembert as da
from benchmarks import ours, timing
from benchmarks.cases import PENDULUM
from dalembert.forward import pullback

COUNTS = (8, 64, 512)


def main() -> list[dict[str, object]]:
    numba.set_num_threads(1)  # so that a run and its gradient have the same means
    rows = [_row(count) for count in COUNTS]
    times = np.array([row["forward runs, adjoint"] for row in rows], dtype=float)
    slope = np.polyfit(COUNTS, times, 1)[0]
    for row in rows:
        row["forward runs a hundred parameters"] = 100 * slope
    timing.report("adjoint", "Response and gradient by p coefficients of a load, in forward runs (one core)", rows)
    return rows


def model_of(count: int) -> da.TimeResponse:
    """The pendulum as a function of the coefficients of the force at its tip, N."""

    def builder(**coefficients: complex) -> da.System:
        system = ours.beam_pendulum()
        force = da.signals.BSpline(np.array(list(coefficients.values())), 0.0, PENDULUM.integration.end)
        system.add(da.Force("push", system.bodies[-1].end, x=force))
        return system

    return da.TimeResponse(
        builder,
        parameters={f"c{k}": (-1e4, 1e4) for k in range(count)},
        channels=ours.JOINT_AND_TIP,
        times=PENDULUM.integration.times,
        solver=ours.solver(PENDULUM.integration),
        workers=1,
    )


def _row(count: int) -> dict[str, object]:
    model = model_of(count)
    vector = 1e3 * np.random.default_rng(0).normal(size=count)
    response = model.evaluate(vector[None]).only()[0]

    def gradient() -> np.ndarray:
        return pullback(model, vector, "adjoint")[1](response)

    times = timing.interleaved({"run": lambda: model.evaluate(vector[None]).only(), "adjoint": gradient}, repeats=25)
    jacobian = model.jacobian(vector)  # the first time with the comparison of the complex step
    direct = timing.seconds(lambda: model.linearise(vector))
    exact = np.einsum("sc,scp->p", response, jacobian)
    return {
        "parameters": count,
        "run, ms": times["run"] * 1e3,
        "run and gradient, ms": times["adjoint"] * 1e3,
        "forward runs, adjoint": times["adjoint"] / times["run"],
        "forward runs, all sensitivities": direct / times["run"],
        "times cheaper": direct / times["adjoint"],
        "differs from these by": float(np.max(np.abs(gradient() - exact)) / np.max(np.abs(exact))),
    }


if __name__ == "__main__":
    main()
