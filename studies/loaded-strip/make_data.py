"""Write load1.csv to load6.csv: two points at the end of a bent and twisted strip (mm), with noise.

The line of the strip follows from r' = D (1, 0, 0 + strains), D' = D [curvatures], m' = -r' x n,
with strains and curvatures from force and moment in the axes of the section. SciPy integrates it from the clamp, with
the moment there such that the moment at the end is that of the weight, which hangs beside the line. No part of the
package is used.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

FOLDER = Path(__file__).parent
LENGTH = 0.5  # m
STIFFNESS = np.array([2.5e6, 8e5, 8e5, 2.1, 2.0, 32.0])  # stretch, shears in N, twist, bending about y and z in N m²
TAG = np.array([0.0, 0.04, 0.0])  # where the weight hangs, in the axes of the last section, m
CASES = [(4.0, 0.0), (8.0, 30.0), (8.0, 60.0), (12.0, 60.0), (20.0, 80.0), (6.0, 15.0)]  # N, degrees
NOISE = 0.1  # mm


def end(load: float, angle: float) -> np.ndarray:
    """Positions of the end of the line and of the tag, m, (2, 3)."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    clamp, force = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]), np.array([0.0, 0.0, -load])

    def rates(place: float, state: np.ndarray) -> np.ndarray:
        axes, moment = state[3:12].reshape(3, 3), state[12:]
        strains = np.concatenate([axes.T @ force, axes.T @ moment]) / STIFFNESS
        k1, k2, k3 = strains[3:]
        line = axes @ (np.array([1.0, 0.0, 0.0]) + strains[:3])
        turn = axes @ np.array([[0, -k3, k2], [k3, 0, -k1], [-k2, k1, 0]])
        return np.concatenate([line, turn.ravel(), -np.cross(line, force)])

    def last(moment: np.ndarray) -> np.ndarray:
        start = np.concatenate([np.zeros(3), clamp.ravel(), moment])
        return solve_ivp(rates, (0.0, LENGTH), start, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]

    def missed(moment: np.ndarray) -> np.ndarray:
        state = last(moment)
        return state[12:] - np.cross(state[3:12].reshape(3, 3) @ TAG, force)

    state = last(root(missed, np.cross([LENGTH, 0.0, 0.0] + clamp @ TAG, force), tol=1e-12).x)
    return np.array([state[:3], state[:3] + state[3:12].reshape(3, 3) @ TAG])


def main() -> None:
    noise = np.random.default_rng(11)
    for number, (load, angle) in enumerate(CASES, start=1):
        points = 1e3 * end(load, angle)
        rows = ["t,x1,y1,z1,x2,y2,z2"]
        for time in (0.0, 0.001):  # two readings of the strip at rest
            values = points + noise.normal(scale=NOISE, size=points.shape)
            rows.append(f"{time:g}," + ",".join(f"{value:.2f}" for value in values.ravel()))
        (FOLDER / f"load{number}.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
        if number == 4:
            print("without noise, fourth load:", (points / 1e3).tolist())


if __name__ == "__main__":
    main()
