"""Periodic motions with sliders, stops and cubic springs in time: shooting between the instants of changes."""

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import brentq

STEPS = 500
"""Steps of the fourth-order Runge-Kutta method in a period, beside those that end at a change of state."""
SAME = 1e-11


@dataclass(frozen=True)
class Sliders:
    """ω² M x'' + ω C x' + K x + contacts = force cos τ, with τ = ωt; the state is (x, x', positions of the sliders).

    Parameters
    ----------
    mass, damping, stiffness : array, shape (n, n)
    force : array, shape (n,)
    sliders : sequence of (direction, stiffness, limit)
    stops : sequence of (direction, stiffness, gap)
    cubic : sequence of (direction, stiffness)
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    force: np.ndarray
    sliders: tuple[tuple[np.ndarray, float, float], ...] = ()
    stops: tuple[tuple[np.ndarray, float, float], ...] = ()
    cubic: tuple[tuple[np.ndarray, float], ...] = ()
    steps: int = field(default=STEPS, kw_only=True)

    def _rates(self, tau: float, state: np.ndarray, modes: tuple[int, ...], omega: float) -> np.ndarray:
        """Rates of the state and of its derivatives by the first state and ω, (states, 1 + states + 1).

        A slider's mode is 0 where it sticks and else the direction of its slip; a stop's is 1 where it is closed.
        """
        n, count = len(self.mass), len(self.sliders)
        x, v, z = state[:n], state[n : 2 * n], state[2 * n :]
        unit = np.zeros(state.shape[1])
        unit[0] = 1.0
        force = np.outer(self.force * np.cos(tau), unit) - omega * self.damping @ v - self.stiffness @ x
        moved = np.zeros_like(z)
        for number, (way, stiff, limit) in enumerate(self.sliders):
            slips = modes[number]
            force -= np.outer(way, limit * slips * unit if slips else stiff * (way @ x - z[number]))
            moved[number] = way @ v if slips else 0.0
        for closed, (way, stiff, gap) in zip(modes[count:], self.stops, strict=True):
            force -= closed * stiff * np.outer(way, way @ x - gap * unit)
        for way, stiff in self.cubic:
            u = way @ x
            force -= stiff * np.outer(way, np.append(u[0] ** 3, 3 * u[0] ** 2 * u[1:]))
        force[:, -1] -= self.damping @ v[:, 0]
        change = np.linalg.solve(self.mass, force) / omega**2
        change[:, -1] -= 2 / omega * change[:, 0]
        return np.concatenate([v, change, moved])

    def _step(self, tau: float, state: np.ndarray, h: float, modes: tuple[int, ...], omega: float) -> np.ndarray:
        k1 = self._rates(tau, state, modes, omega)
        k2 = self._rates(tau + h / 2, state + h / 2 * k1, modes, omega)
        k3 = self._rates(tau + h / 2, state + h / 2 * k2, modes, omega)
        k4 = self._rates(tau + h, state + h * k3, modes, omega)
        return state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)

    def _excess(self, state: np.ndarray, modes: tuple[int, ...]) -> np.ndarray:
        """By how much the conditions of the modes are violated, where positive."""
        n = len(self.mass)
        x, v, z = state[:n, 0], state[n : 2 * n, 0], state[2 * n :, 0]
        result = [
            -slips * (way @ v) if slips else abs(stiff * (way @ x - place)) - limit
            for slips, (way, stiff, limit), place in zip(modes, self.sliders, z, strict=False)
        ]
        for closed, (way, _, gap) in zip(modes[len(z) :], self.stops, strict=True):
            result.append((1 - 2 * closed) * (way @ x - gap))
        return np.array(result)

    def _changed(self, number: int, state: np.ndarray, modes: tuple[int, ...]) -> tuple[int, ...]:
        """Modes after one of them changes; a slider that begins to slip follows the motion, in derivatives too."""
        n, new = len(self.mass), list(modes)
        if number >= len(self.sliders):
            new[number] = 1 - modes[number]
        elif modes[number]:
            new[number] = 0
        else:
            way, stiff, limit = self.sliders[number]
            new[number] = int(np.sign(way @ state[:n, 0] - state[2 * n + number, 0]))
            state[2 * n + number] = way @ state[:n]
            state[2 * n + number, 0] -= new[number] * limit / stiff
        return tuple(new)

    def period(self, begin: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray]:
        """State after a period, and its derivatives by the one before and by ω, (states, states + 1)."""
        size, n = len(begin), len(self.mass)
        state = np.concatenate([begin[:, None], np.eye(size), np.zeros((size, 1))], axis=1)
        modes = (0,) * len(self.sliders) + tuple(int(way @ begin[:n] > gap) for way, _, gap in self.stops)
        for number, (way, stiff, limit) in enumerate(self.sliders):
            trial = stiff * (way @ begin[:n] - begin[2 * n + number])
            if abs(trial) > limit - 1e-9 and trial * (way @ begin[n : 2 * n]) > 0:
                modes = self._changed(number, state, modes)
        tau, end, longest = 0.0, 2 * np.pi, 2 * np.pi / self.steps
        while end - tau > 1e-14:
            h = min(longest, end - tau)
            after = self._step(tau, state, h, modes, omega)
            first, changes = h, -1
            for number in np.flatnonzero(self._excess(after, modes) > SAME):

                def excess(part: float, number=number, state=state, tau=tau, modes=modes) -> float:
                    return self._excess(self._step(tau, state, part, modes, omega), modes)[number]

                root = brentq(excess, 0.0, h, xtol=1e-15) if excess(0.0) < 0 else 0.0
                if root < first or changes < 0:
                    first, changes = root, int(number)
            if changes < 0:
                tau, state = tau + h, after
                continue
            state = self._step(tau, state, first, modes, omega)
            tau, modes = tau + first, self._changed(changes, state, modes)
        return state[:, 0], state[:, 1:]

    def periodic(self, guess: np.ndarray, omega: float, direction: np.ndarray | None = None) -> "Periodic | None":
        """The periodic motion near a guess, by shooting, at a frequency or on the plane across a direction of
        (state, ω); None if it is not found."""
        place = np.append(guess, omega)
        if direction is None:
            direction = np.append(np.zeros(len(guess)), 1.0)
        y = place
        for _ in range(15):
            after, slopes = self.period(y[:-1], y[-1])
            error = np.append(after - y[:-1], direction @ (y - place))
            slopes = slopes.copy()
            slopes[:, :-1] -= np.eye(len(guess))
            if np.linalg.norm(error) < 1e-10 * (1 + np.linalg.norm(y)):
                return Periodic(y[:-1], float(y[-1]), slopes)
            y = y - np.linalg.lstsq(np.vstack([slopes, direction]), error, rcond=1e-12)[0]
        return None

    def fold(self, guess: np.ndarray, omega: float, reach: float) -> "Periodic | None":
        """The periodic motion near a guess where the frequency turns back, within a reach along the path."""
        first = self._between(guess, omega)
        if first is None:
            return None
        direction = first.tangent

        def at(length: float) -> Periodic:
            place = np.append(first.state, first.omega) + length * direction
            found = self.periodic(place[:-1], place[-1], direction)
            assert found is not None
            return found

        def turning(length: float) -> float:
            tangent = at(length).tangent
            return tangent[-1] * np.sign(tangent @ direction)

        return at(float(brentq(turning, -reach, reach, xtol=1e-7 * reach)))

    def _between(self, guess: np.ndarray, omega: float) -> "Periodic | None":
        """A periodic motion near a guess, not necessarily at its frequency."""
        _, slopes = self.period(guess, omega)
        slopes[:, :-1] -= np.eye(len(guess))
        return self.periodic(guess, omega, Periodic(guess, omega, slopes).tangent)


@dataclass(frozen=True)
class Periodic:
    """A periodic motion.

    Parameters
    ----------
    state : array, shape (states,)
        Where the force is largest.
    omega : float
    slopes : array, shape (states, states + 1)
        Of what the state changes in a period, by the state and by ω.
    """

    state: np.ndarray
    omega: float
    slopes: np.ndarray

    @property
    def moving(self) -> np.ndarray:
        """States that change: not the position of a slider that sticks all period, which nothing determines."""
        return np.flatnonzero(np.any(self.slopes, axis=1))

    @property
    def multipliers(self) -> np.ndarray:
        """Floquet multipliers of the states that change."""
        moving = self.moving
        return np.linalg.eigvals(self.slopes[np.ix_(moving, moving)] + np.eye(len(moving)))

    @property
    def tangent(self) -> np.ndarray:
        """Direction of the path of (state, ω), where sliders that stick keep their position."""
        columns = np.append(self.moving, len(self.state))
        result = np.zeros(len(self.state) + 1)
        result[columns] = np.linalg.svd(self.slopes[np.ix_(self.moving, columns)])[2][-1]
        return result
