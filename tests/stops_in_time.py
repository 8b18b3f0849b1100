"""Periodic motions of linear structures with stops in time: exact flows between the instants at which stops change."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

STEPS = 4000
"""Parts of a period in which the sign of a stop's distance is looked at."""


@dataclass(frozen=True)
class Stops:
    """M x'' + C x' + K x + sum of stops = mean + force cos(ωt); a stop is k (w·x - gap) where that is positive.

    Parameters
    ----------
    mass, damping, stiffness : array, shape (n, n)
    force : array, shape (n,)
    stops : sequence of (direction, stiffness, gap)
    mean : array, shape (n,), optional
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    force: np.ndarray
    stops: tuple[tuple[np.ndarray, float, float], ...]
    mean: np.ndarray | None = None

    @cached_property
    def _flows(self) -> dict:
        return {}

    def _flow(self, closed: tuple[bool, ...], omega: float) -> tuple:
        """Eigenvalues and vectors of the state's rates, the static and the forced motion between changes."""
        if (closed, omega) not in self._flows:
            n, stiffness, static = len(self.mass), self.stiffness.copy(), np.zeros(len(self.mass))
            static += 0.0 if self.mean is None else self.mean
            for shut, (way, stiff, gap) in zip(closed, self.stops, strict=True):
                stiffness += shut * stiff * np.outer(way, way)
                static += shut * stiff * gap * way
            rates = np.block([
                [np.zeros((n, n)), np.eye(n)],
                [-np.linalg.solve(self.mass, stiffness), -np.linalg.solve(self.mass, self.damping)],
            ])  # fmt: skip
            values, vectors = np.linalg.eig(rates)
            still = np.append(np.linalg.solve(stiffness, static), np.zeros(n))
            moving = np.linalg.solve(stiffness - omega**2 * self.mass + 1j * omega * self.damping, self.force)
            self._flows[closed, omega] = (
                values, vectors, np.linalg.inv(vectors), still, np.append(moving, 1j * omega * moving),
            )  # fmt: skip
        return self._flows[closed, omega]

    def period(self, begin: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray]:
        """State after a period, and its derivative by the one before."""
        t, end, state, monodromy = 0.0, 2 * np.pi / omega, begin, np.eye(len(begin))
        n, closed = len(self.mass), tuple(bool(way @ begin[: len(self.mass)] > gap) for way, _, gap in self.stops)
        while t < end:
            values, vectors, inverse, still, moving = self._flow(closed, omega)
            forced = still + np.real(moving * np.exp(1j * omega * t))
            parts = inverse @ (state - forced)

            def at(times, t=t, parts=parts, values=values, vectors=vectors, still=still, moving=moving):
                free = (vectors * parts) @ np.exp(np.outer(values, times - t))
                return np.real(free + np.outer(moving, np.exp(1j * omega * times))) + still[:, None]

            times = np.linspace(t, end, STEPS)
            places, after, changes = at(times)[:n], end, -1
            for number, (way, _, gap) in enumerate(self.stops):
                side = 1.0 if closed[number] else -1.0  # positive while the stop stays as it is
                distance = side * (way @ places - gap)
                left = np.flatnonzero((distance[1:] < 0) & (distance[:-1] >= 0))
                left = left[left > 0] if t > 0 else left  # the instant at which it changed
                if len(left):
                    first = left[0]
                    root = brentq(
                        lambda s, way=way, gap=gap, at=at: float(way @ at(np.array([s]))[:n, 0] - gap),
                        times[first], times[first + 1], xtol=1e-15, rtol=1e-15,
                    )  # fmt: skip
                    if root < after:
                        after, changes = root, number
            state = at(np.array([after]))[:, 0]
            monodromy = np.real((vectors * np.exp(values * (after - t))) @ inverse) @ monodromy
            t = after
            if changes >= 0:
                closed = tuple(shut != (number == changes) for number, shut in enumerate(closed))
        return state, monodromy

    def periodic(self, guess: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray] | None:
        """State of the periodic motion near a guess and the derivative of the map, by shooting; None if not found."""
        state = guess
        for _ in range(20):
            after, monodromy = self.period(state, omega)
            error = after - state
            if np.linalg.norm(error) < 1e-11 * (1 + np.linalg.norm(state)):
                return state, monodromy
            step = np.linalg.solve(np.eye(len(state)) - monodromy, error)
            state = state + step
        return None
