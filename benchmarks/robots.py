"""Torques, regressors and mass matrices of 10,000 samples of a robot with seven joints, beside Pinocchio."""

from pathlib import Path

import numpy as np
import pinocchio

from benchmarks import timing
from dalembert.multibody.spatial import Inertia, Orientation, Pose
from dalembert.multibody.trees.dynamics import inverse_dynamics, mass_matrix, regressor
from dalembert.multibody.trees.tree import Link, Tree, TreeJoint

SAMPLES = 10_000
ROBOT = "share/example-robot-data/robots/xarm_description/urdf/xarm7.urdf"


def main() -> list[dict[str, object]]:
    wheel = next(own for own in Path(pinocchio.__file__).parents if own.name == "cmeel.prefix")
    model = pinocchio.buildModelFromUrdf(str(wheel / ROBOT))
    data, pool = model.createData(), pinocchio.ModelPool(model, 1)
    tree = _tree(model)
    q, v, a = np.random.default_rng(0).normal(size=(3, SAMPLES, model.nv))
    by_columns = [np.asfortranarray(own.T) for own in (q, v, a)]
    room = np.zeros((model.nv, SAMPLES), order="F")

    def by_sample(function, *given):
        return lambda: [function(model, data, *own) for own in zip(*given, strict=True)]

    def in_its_loop():
        pinocchio.rneaInParallel(1, pool, *by_columns, room)
        return room.T

    cases = {
        "inverse dynamics": (lambda: inverse_dynamics(tree, q, v, a), by_sample(pinocchio.rnea, q, v, a), in_its_loop),
        "regressor": (
            lambda: regressor(tree, q, v, a), by_sample(pinocchio.computeJointTorqueRegressor, q, v, a), None,
        ),
        "mass matrix": (lambda: mass_matrix(tree, q), by_sample(pinocchio.crba, q), None),
    }  # fmt: skip
    rows: list[dict[str, object]] = []
    for name, (ours, theirs, inside) in cases.items():
        candidates = {"ours": ours, "theirs": theirs} | ({"inside": inside} if inside else {})
        times = {own: 1e6 * seconds / SAMPLES for own, seconds in timing.interleaved(candidates).items()}
        rows.append(
            {
                "computed": name,
                "dalembert, us a sample": times["ours"],
                "Pinocchio called for each sample": times["theirs"],
                "ratio": times["theirs"] / times["ours"],
                "Pinocchio's loop in C++": times.get("inside", ""),
                "ratio to it": times["inside"] / times["ours"] if inside else "",
            }
        )
    rows[0]["difference"] = float(np.abs(inverse_dynamics(tree, q, v, a) - in_its_loop()).max())
    rows[1]["difference"], rows[2]["difference"] = _difference(model, data, tree, q, v, a)
    timing.report("robots", f"{SAMPLES:,} samples of a robot with seven joints, one thread", rows)
    return rows


def _difference(model, data, tree: Tree, *motion: np.ndarray) -> tuple[float, float]:
    """Largest differences of regressors and of mass matrices, in some samples."""
    order = [0, 1, 2, 3, 4, 6, 9, 5, 7, 8]  # of Pinocchio's xx, xy, yy, xz, yz, zz
    few = [own[:20] for own in motion]
    ours, masses = regressor(tree, *few)[:, :, : 10 * model.nv], mass_matrix(tree, few[0])
    columns = [pinocchio.computeJointTorqueRegressor(model, data, *own).copy() for own in zip(*few, strict=True)]
    theirs = np.array(columns).reshape(20, model.nv, -1, 10)[..., order].reshape(ours.shape)
    upper = np.array([np.triu(pinocchio.crba(model, data, own)) for own in few[0]])
    return float(np.abs(ours - theirs).max()), float(np.abs(np.triu(masses) - upper).max())


def _tree(model) -> Tree:
    """The tree of a model whose joints all turn about z."""
    links = []
    for k in range(1, model.njoints):
        place, own = model.jointPlacements[k], model.inertias[k]
        pose = Pose(tuple(place.translation.tolist()), Orientation.of(place.rotation))
        inertia = Inertia.of(own.mass, own.inertia, own.lever)
        links.append(Link(f"link{k}", f"link{model.parents[k]}", TreeJoint(model.names[k], pose=pose), inertia))
    return Tree(model.name, "link0", tuple(links))


if __name__ == "__main__":
    main()
