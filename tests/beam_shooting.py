"""An independent reference for beams in space: the equations of the line as an initial value problem, by shooting."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root


def shoot(length, stiffness, *, force=(0.0, 0.0, 0.0), load=(0.0, 0.0, 0.0), curvature=lambda s: np.zeros(3),
          steps=4):  # fmt: skip
    """Tip position of a clamped beam under a dead force (N) at its tip and a dead ``load`` per length (N/m).

    r' = D (1, 0, 0 + strains), D' = D [K0 + curvatures], m' = -r' x n, with n = force + load (L - s) and the strains
    from the whole matrix ``stiffness`` (6, 6). The moment at the clamp is such that it vanishes at the tip.
    """
    compliance, force, load = np.linalg.inv(stiffness), np.asarray(force, float), np.asarray(load, float)

    def tip(moment, factor):
        def rates(s, y):
            frame, m = y[3:12].reshape(3, 3), y[12:]
            n = factor * (force + load * (length - s))
            e = compliance @ np.concatenate([frame.T @ n, frame.T @ m])
            k = e[3:] + curvature(s)
            turn = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
            line = frame @ (np.array([1.0, 0, 0]) + e[:3])
            return np.concatenate([line, (frame @ turn).ravel(), -np.cross(line, n)])

        start = np.concatenate([np.zeros(3), np.eye(3).ravel(), moment])
        return solve_ivp(rates, (0, length), start, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]

    unit = np.abs(stiffness[3:, 3:]).max() / length
    moment = np.zeros(3)
    for k in range(1, steps + 1):
        found = root(lambda m, k=k: tip(m * unit, k / steps)[12:] / unit, moment / unit, tol=1e-13)
        moment = found.x * unit
    assert np.abs(tip(moment, 1.0)[12:]).max() < 1e-9 * unit
    return tip(moment, 1.0)[:3]
