"""Rigid dry friction of masses on the ground, from one change of stick and slip to the next: no steps, no harmonics.

Between the changes the motion is linear, and SciPy integrates it to rounding. A mass that slips does so until its
velocity is zero; a mass at rest stays while the force that would move it is within the friction limit.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

TOLERANCE = 1e-11


@dataclass(frozen=True)
class Rubbing:
    """M x'' + C x' + K x + friction = amplitudes cos ωt, with rigid contacts to the ground.

    Parameters
    ----------
    mass, damping, stiffness : array, shape (n, n)
        The mass diagonal.
    amplitudes : array, shape (n,)
    limits : mapping of int to float
        Friction limit of each mass that rubs.
    omega : float
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    amplitudes: np.ndarray
    limits: dict[int, float]
    omega: float

    def push(self, t: float, y: np.ndarray) -> np.ndarray:
        """Forces on the masses but for friction, (n,)."""
        n = len(self.mass)
        return self.amplitudes * np.cos(self.omega * t) - self.damping @ y[n:] - self.stiffness @ y[:n]

    def period(self, y: np.ndarray, watched: np.ndarray | None = None) -> tuple[np.ndarray, list[np.ndarray], float]:
        """State a period later, the motion at watched instants, and the part of the period in which the first rubbing
        mass sticks."""
        t, end, n = 0.0, 2 * np.pi / self.omega, len(self.mass)
        slip = {row: self._direction(row, t, y) for row in self.limits}
        seen: list[np.ndarray] = []
        stuck, first = 0.0, next(iter(self.limits))
        while t < end:
            rows, signs = list(slip), list(slip.values())
            solution = solve_ivp(
                self._rates(slip), (t, end), y, method="DOP853", rtol=TOLERANCE, atol=1e-13, dense_output=True,
                events=[self._change(row, sign) for row, sign in zip(rows, signs, strict=True)],
            )  # fmt: skip
            after = float(solution.t[-1])
            if watched is not None:
                last = after >= end
                inside = watched[(watched >= t) & ((watched <= after) if last else (watched < after))]
                seen += [solution.sol(instant)[:n] for instant in inside]
            stuck += (after - t) if slip[first] == 0 else 0.0
            t, y = after, solution.y[:, -1].copy()
            for row, sign, hits in zip(rows, signs, solution.t_events, strict=True):
                if len(hits):
                    y[n + row] = 0.0
                    slip[row] = self._direction(row, t, y) if sign else int(np.sign(self.push(t, y)[row]))
        return y, seen, stuck / end

    def steady(self, y: np.ndarray, most: int = 400) -> np.ndarray:
        """State at the start of a periodic motion, after as many periods as it takes."""
        for _ in range(most):
            before, y = y, self.period(y)[0]
            if np.abs(y - before).max() < 1e-10 * np.abs(y).max():
                return y
        raise AssertionError(f"not periodic after {most} periods")

    def _direction(self, row: int, t: float, y: np.ndarray) -> int:
        """-1 or 1 for slip, 0 for stick."""
        speed, push = y[len(self.mass) + row], self.push(t, y)[row]
        if abs(speed) > 1e-9:
            return int(np.sign(speed))
        return 0 if abs(push) <= self.limits[row] else int(np.sign(push))

    def _rates(self, slip: dict[int, int]):
        n, inertia = len(self.mass), np.diag(self.mass)
        held = [row for row, sign in slip.items() if sign == 0]

        def rates(t: float, y: np.ndarray) -> np.ndarray:
            force = self.push(t, y)
            for row, sign in slip.items():
                force[row] -= sign * self.limits[row]
            acceleration, velocity = force / inertia, y[n:].copy()
            acceleration[held], velocity[held] = 0.0, 0.0
            return np.concatenate([velocity, acceleration])

        return rates

    def _change(self, row: int, sign: int):
        """An event: the end of a slip, or of a stick."""
        n = len(self.mass)

        def slipping(t: float, y: np.ndarray) -> float:
            return y[n + row]

        def sticking(t: float, y: np.ndarray) -> float:
            return self.limits[row] - abs(self.push(t, y)[row])

        event = sticking if sign == 0 else slipping
        event.terminal = True  # type: ignore[attr-defined]
        event.direction = -1.0 if sign >= 0 else 1.0  # type: ignore[attr-defined]
        return event
