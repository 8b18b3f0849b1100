"""Price of p exact sensitivities, in forward runs, beside central differences (2 p runs, and inexact)."""

import numba
import numpy as np

import dalembert as da
import dalembert.multibody as mb
from benchmarks import ours, timing
from benchmarks.cases import PENDULUM

BEAM = {
    "youngs_ab": 2e7,
    "theta1": np.pi / 4,
    "theta2": np.pi / 6,
    "youngs_oa": 2e8,
    "length_oa": 1.0,
    "length_ab": 2.0,
    "height": 0.4,
    "density": 5540.0,
}
CABLE = {name: BEAM[name] for name in ("youngs_ab", "theta1", "theta2", "youngs_oa")}


def main() -> list[dict[str, object]]:
    numba.set_num_threads(1)  # so that a run and its sensitivities have the same means
    rows = [_row("2 + 4 beams", ours.beam_pendulum, BEAM, count) for count in (1, 2, 4, 8)]
    rows += [_row("2 + 4 cables", ours.cable_pendulum, CABLE, count) for count in (1, 2, 4)]
    step = PENDULUM.integration.step
    for solver in (mb.Variational(step), mb.EnergyMomentum(step), mb.RadauIIA(1e-6)):
        name = f"2 + 4 beams, {type(solver).__name__}"
        rows += [_row(name, ours.beam_pendulum, BEAM, count, solver) for count in (1, 3, 8)]
    timing.report("sensitivities", "Response and p exact sensitivities, in forward runs (one core)", rows)
    return rows


def _row(name: str, builder, values: dict[str, float], count: int, solver=None) -> dict[str, object]:
    chosen = dict(list(values.items())[:count])
    model = da.TimeResponse(
        builder,
        parameters={key: (0.9 * value, 1.1 * value) for key, value in chosen.items()},
        channels=ours.JOINT_AND_TIP,
        times=PENDULUM.integration.times,
        solver=solver or ours.solver(PENDULUM.integration),
    )
    vector = np.array(list(chosen.values()))
    times = timing.interleaved(
        {"run": lambda: model.evaluate(vector[None]).only(), "both": lambda: model.linearise(vector)}, repeats=7
    )
    exact, inexact = model.jacobian(vector), differences(model, vector)
    return {
        "model": name,
        "parameters": count,
        "run, ms": times["run"] * 1e3,
        "run and sensitivities, ms": times["both"] * 1e3,
        "forward runs": times["both"] / times["run"],
        "runs a parameter": times["both"] / times["run"] / count,
        "without the run itself": (times["both"] / times["run"] - 1) / count,
        "differs from differences by": float(np.max(np.abs(exact - inexact)) / np.max(np.abs(exact))),
    }


def differences(model: da.TimeResponse, vector: np.ndarray) -> np.ndarray:
    """Central differences, shape (samples, channels, parameters), scaled as the exact ones."""
    steps = np.diag(vector * 1e-5)
    ahead, behind = model.evaluate(vector + steps).only(), model.evaluate(vector - steps).only()
    return np.moveaxis((ahead - behind) / (2e-5 * vector)[:, None, None], 0, 2)


if __name__ == "__main__":
    main()
