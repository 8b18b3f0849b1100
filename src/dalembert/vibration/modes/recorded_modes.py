"""Stored motions of a nonlinear mode: an interrupted backbone continues without repeating Newton's method."""

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.forward import Checkpoint
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.modes.mode_equations import FreeMotion, ModeEquations, Plane
from dalembert.vibration.system.fingerprint import fingerprint


@dataclass(frozen=True)
class RecordedModes(ModeEquations):
    """Equations of a mode that read motions and directions from a checkpoint, and add new ones to it.

    A path goes from one motion to the next, so it takes the same way again, bit for bit.

    Parameters
    ----------
    checkpoint : Checkpoint
    """

    checkpoint: Checkpoint

    def solve(self, guess: FreeMotion, plane: Plane, samples: int) -> FreeMotion:
        solve = super().solve

        def compute() -> tuple[np.ndarray, ...]:
            found = solve(guess, plane, samples)
            return _place(found), np.array([found.iterations, found.error, found.converged, found.samples], dtype=float)

        asked = _place(guess), plane.direction, _place(plane.at), np.array([plane.scale, samples])
        place, how = self.checkpoint.once(self._key(*asked), compute)
        iterations, error, converged, own = how.tolist()
        omega, growth, size = place[-3:].tolist()
        harmonics = place[:-3].reshape(guess.harmonics.shape)
        return FreeMotion(harmonics, omega, growth, size, int(iterations), error, bool(converged), int(own))

    def direction(self, motion: FreeMotion, before: np.ndarray) -> np.ndarray:
        direction = super().direction
        key = self._key(_place(motion), before, np.array([motion.samples]))
        return self.checkpoint.once(key, lambda: (direction(motion, before),))[0]

    def _key(self, *asked: np.ndarray) -> bytes:
        """Hash of all that an answer depends on."""
        return hashlib.sha256(self._system + b"".join(map(np.ndarray.tobytes, asked))).digest()

    @cached_property
    def _system(self) -> bytes:
        return b"nonlinear mode" + fingerprint(self.problem.lowered, self.problem.method, self.row).encode()


def _place(motion: FreeMotion) -> np.ndarray:
    """Harmonics, ω, ξ and amplitude of a motion."""
    return np.append(motion.harmonics, [motion.omega, motion.growth, motion.size])


def recorded_modes(problem: Equations, row: int, checkpoint: Checkpoint | None) -> ModeEquations:
    """Return the equations of a mode with its motions in a checkpoint, or as they are without one."""
    return ModeEquations(problem, row) if checkpoint is None else RecordedModes(problem, row, checkpoint)
