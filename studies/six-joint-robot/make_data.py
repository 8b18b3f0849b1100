"""Write the records of the study: exciting.csv, unseen.csv, exact.csv, and the robot that they are of, true.urdf.

The true robot differs from robot.urdf: each pseudo-inertia by a random factor near 1, friction and armature by up to
30 %. The torques of exciting.csv and unseen.csv have normal noise of 2 % of their rms along the exciting motion.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from dalembert.inverse.inertial import exciting_trajectory, inertial_parameters, pseudo_inertia
from dalembert.inverse.inertial.fourier_motion import JointLimits, largest_motion
from dalembert.multibody.trees import (
    Tree,
    inverse_dynamics,
    parameter_names,
    parameters_of,
    read_urdf,
    regressor,
    with_parameters,
    write_urdf,
)

HERE = Path(__file__).parent
SLIP, PERIOD, RATE, NOISE, SEED = 0.05, 10.0, 100.0, 0.02, 7


def true_robot(prior: Tree) -> Tree:
    """The robot that is measured."""
    rng, values = np.random.default_rng(SEED), parameters_of(prior)
    links = pseudo_inertia(values[:60].reshape(6, 10))
    factors = np.eye(4) + 0.2 * rng.uniform(-1.0, 1.0, (6, 4, 4)) * np.array([[1, 0.1, 0.1, 0.1], *3 * [[0, 1, 1, 1]]])
    links = factors @ links @ np.swapaxes(factors, 1, 2)
    others = values[60:] * rng.uniform(0.7, 1.3, 18)
    return with_parameters(prior, np.concatenate([inertial_parameters(links).ravel(), others]))


def limits(tree: Tree) -> JointLimits:
    """Those of the file; accelerations as in excite.toml."""
    own = {key: np.array([getattr(joint, key) for joint in tree.moving]) for key in ("lower", "upper", "velocity")}
    return JointLimits(**own, acceleration=np.array([6.0, 6.0, 8.0, 12.0, 12.0, 15.0]))


def motions(prior: Tree) -> dict[str, object]:
    """The exciting motion, as excite.toml finds it, and a random one."""
    found = exciting_trajectory(
        lambda q, v, a: regressor(prior, q, v, a, slip=SLIP), parameter_names(prior), limits(prior), period=PERIOD,
        evaluations=400,
    )  # fmt: skip
    shape = np.random.default_rng(SEED + 1).uniform(-1.0, 1.0, (6, 11))
    return {"exciting": found.motion, "unseen": largest_motion(shape, PERIOD, limits(prior))}


def write(name: str, times: np.ndarray, columns: dict[str, np.ndarray]) -> None:
    """A table of numbers."""
    table = np.column_stack([times, *columns.values()])
    rows = [",".join(["t", *columns]), *(",".join(f"{x:.7g}" for x in row) for row in table)]
    (HERE / name).write_text("\n".join(rows) + "\n")


def main() -> None:
    """Write all files."""
    prior = read_urdf(HERE / "robot.urdf")
    true = true_robot(prior)
    write_urdf(replace(true, name="six-joint-robot-true"), HERE / "true.urdf")
    size, times, rng = np.zeros(6), np.arange(int(PERIOD * RATE) + 1) / RATE, np.random.default_rng(SEED + 2)
    for name, motion in motions(prior).items():
        q, v, a = motion.motion(times)
        torques = inverse_dynamics(true, q, v, a, slip=SLIP)
        if name == "exciting":
            size = NOISE * np.sqrt(np.mean(torques**2, axis=0))
            short = times <= 1.0
            write("exact.csv", times[short], {f"tau{k + 1}": torques[short, k] for k in range(6)})
            print(
                "for simulate.toml:", q[0].round(9), v[0].round(9), "and what is expected after 1 s:", q[100].round(9)
            )
        torques = torques + size * rng.standard_normal(torques.shape)
        columns = {f"q{k + 1}": q[:, k] for k in range(6)} | {f"tau{k + 1}": torques[:, k] for k in range(6)}
        write(f"{name}.csv", times, columns)


if __name__ == "__main__":
    main()
