"""Rigid mechanisms in space beside Exudyn: time a step, errors, cost against length, and price of sensitivities."""

from dataclasses import replace
from itertools import pairwise

import numba
import numpy as np

import dalembert as da
from benchmarks import ours, spatial_cases, timing
from benchmarks.peers import exudyn_models as peers
from benchmarks.sensitivities import differences
from benchmarks.spatial_cases import Mechanism

NODES = {"Euler parameters": "RotationEulerParameters", "rotation vectors": "RotationRotationVector"}
SHORT = 5  # steps of the run whose time is taken off, which has the start and the lowering of the model


def main() -> list[dict[str, object]]:
    top, fine = spatial_cases.heavy_top(), spatial_cases.heavy_top(1e-4)
    small = top, fine, spatial_cases.double_pendulum(), spatial_cases.bricard(), *map(spatial_cases.chain, (6, 20))
    rows = [_row(case, repeats=9) for case in small]
    long = [spatial_cases.chain(links, end=0.1, compared=0.1) for links in (100, 1000)]
    rows += [_row(case, repeats=3, exact=False) for case in long]
    for before, row in pairwise(rows[-3:]):
        ratio = np.log(row["bodies"] / before["bodies"])
        names = {"slope": "dalembert", "slope, Exudyn": "Euler parameters"}
        row |= {slope: float(np.log(row[cost] / before[cost]) / ratio) for slope, cost in names.items()}
    title = (
        "Rigid mechanisms in space, microseconds a step; ratios to Exudyn with Euler parameters and rotation vectors"
    )
    timing.report("spatial", title, rows)
    numba.set_num_threads(1)  # so that a run and its sensitivities have the same means
    prices = [_price(count) for count in (1, 2, 4, 8)]
    timing.report("spatial-sensitivities", "Double pendulum in space: p exact sensitivities, in forward runs", prices)
    return rows


def _row(case: Mechanism, repeats: int, exact: bool = True) -> dict[str, object]:
    solver = peers.DENSE if len(case.bodies) < 6 else peers.SPARSE
    started = replace(case, integration=replace(case.integration, end=SHORT * case.integration.step, every=SHORT))
    runs, built = {}, []
    for name, own in (("", case), (" started", started)):
        runs[f"ours{name}"] = ours.response(lambda own=own: ours.mechanism(own), own.integration, ours.tip(own))
        for node, parameters in NODES.items():
            built.append(peers.mechanism(own, solver, node=parameters))
            runs[f"{node}{name}"] = built[-1].run
    times = timing.interleaved(runs, repeats)
    steps = case.integration.steps - SHORT
    each = {name: (times[name] - times[f"{name} started"]) / steps * 1e6 for name in ("ours", *NODES)}
    compared = case.integration.times <= case.compared
    motions = {name: runs[name]()[compared] for name in each}
    row: dict[str, object] = {"model": case.name, "bodies": len(case.bodies), "dalembert": each["ours"]}
    row |= {node: each[node] for node in NODES}
    row |= {f"ratio {k + 1}": each[node] / each["ours"] for k, node in enumerate(NODES)}
    row["start, ms"] = times["ours started"] * 1e3
    if exact:
        solution = _solution(case)
        errors = {name: float(np.max(np.abs(motion - solution))) for name, motion in motions.items()}
        row |= {"error": errors["ours"]} | {f"error {k + 1}": errors[node] for k, node in enumerate(NODES)}
    else:
        row |= {"error": "", "error 1": "", "error 2": ""}
    row["difference"] = float(np.max(np.abs(motions["ours"] - motions["Euler parameters"])))
    return row | {"slope": "", "slope, Exudyn": ""}


def _solution(case: Mechanism) -> np.ndarray:
    """The tip by Radau IIA at a fine tolerance."""
    times = case.integration.times[case.integration.times <= case.compared]
    solver = da.RadauIIA(tolerance=1e-11)
    return da.simulate(ours.mechanism(case), times[-1], solver, times=times).channels(ours.tip(case))


def _price(count: int) -> dict[str, object]:
    case = spatial_cases.double_pendulum()
    names = ("mass", "moment", "centre", "spin", "gravity", "lower_mass", "lower_moment", "lower_centre")[:count]
    vector = np.ones(count)
    model = da.TimeResponse(
        lambda **factors: ours.mechanism(spatial_cases.scaled(case, factors)),
        parameters=dict.fromkeys(names, (0.9, 1.1)),
        channels=ours.tip(case),
        times=case.integration.times,
        solver=ours.solver(case.integration),
    )
    times = timing.interleaved(
        {"run": lambda: model.evaluate(vector[None]).only(), "both": lambda: model.linearise(vector)}, repeats=9
    )
    exact = model.jacobian(vector)
    gap = np.max(np.abs(exact - differences(model, vector))) / np.max(np.abs(exact))
    runs = times["both"] / times["run"]
    return {
        "parameters": count,
        "run, ms": times["run"] * 1e3,
        "run and sensitivities, ms": times["both"] * 1e3,
        "forward runs": runs,
        "runs a parameter": runs / count,
        "without the run itself": (runs - 1) / count,
        "differs from differences by": float(gap),
    }


if __name__ == "__main__":
    main()
