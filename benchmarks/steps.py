"""Time a step: flexible pendulum of cables, and rigid two-link arm, beside Exudyn."""

from dataclasses import replace
from functools import partial

import numpy as np

import dalembert as da
from benchmarks import ours, timing
from benchmarks.cases import ARM, PENDULUM, FlexiblePendulum, Integration, TwoLinkArm
from benchmarks.peers import exudyn_models as peers


def main() -> list[dict[str, object]]:
    fine = replace(ARM, integration=Integration(end=20.0, step=1e-3, every=10))
    rows = [
        _cables(PENDULUM),
        _arm("rigid two-link arm, h = 0.01 s", ARM),
        _arm("rigid two-link arm, h = 0.001 s", fine),
        *_beams(PENDULUM),
    ]
    timing.report("steps", "Time a step (microseconds); ratio = Exudyn tuned / dalembert", rows)
    return rows


def _cables(case: FlexiblePendulum) -> dict[str, object]:
    return _row(
        "flexible pendulum, 2 + 4 cables",
        case.integration,
        ours.response(ours.cable_pendulum, case.integration),
        peers.flexible_pendulum(case),
        peers.flexible_pendulum(case, contractivity=peers.AS_IT_COMES),
    )


def _arm(name: str, case: TwoLinkArm) -> dict[str, object]:
    return _row(
        name,
        case.integration,
        ours.response(lambda: ours.two_link_arm(case), case.integration),
        peers.two_link_arm(case),
        peers.two_link_arm(case, contractivity=peers.AS_IT_COMES),
    )


def _beams(case: FlexiblePendulum) -> list[dict[str, object]]:
    """Exudyn has no such planar element; the rows stand for themselves, with twice the coordinates of the cables."""
    systems = {kind: partial(ours.beam_pendulum, formulation=kind) for kind in ("structural", "continuum")}
    times = timing.interleaved({kind: ours.response(build, case.integration) for kind, build in systems.items()})
    rows = []
    for kind, build in systems.items():
        trajectory = da.simulate(build(), case.integration.end, solver=ours.solver(case.integration))
        rows.append(
            {
                "model": f"flexible pendulum, 2 + 4 fully parametrised beams, {kind}",
                "dalembert": times[kind] / case.integration.steps * 1e6,
                "Exudyn tuned": "no such element",
                "Exudyn as it comes": "",
                "ratio": "",
                "iterations a step": float(np.mean(trajectory.newton_iterations)),
                "theirs": "",
                "difference": "",
            }
        )
    return rows


def _row(name: str, integration: Integration, run, tuned: peers.Peer, plain: peers.Peer) -> dict[str, object]:
    times = timing.interleaved({"ours": run, "tuned": tuned.run, "plain": plain.run})
    each = {key: value / integration.steps * 1e6 for key, value in times.items()}
    # Chaotic motion forgets its start, so the two are compared over the first two seconds only.
    early = integration.times <= 2.0
    return {
        "model": name,
        "dalembert": each["ours"],
        "Exudyn tuned": each["tuned"],
        "Exudyn as it comes": each["plain"],
        "ratio": each["tuned"] / each["ours"],
        "iterations a step": "",
        "theirs": tuned.newton_iterations() / integration.steps,
        "difference": float(np.max(np.abs(run()[early] - tuned.run()[early]))),
    }


if __name__ == "__main__":
    main()
