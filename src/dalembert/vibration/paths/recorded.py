"""Stored solutions and curves: an interrupted curve continues without repeating Newton's method."""

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from time import perf_counter

import numpy as np

from dalembert.contents import Contents
from dalembert.forward import Checkpoint
from dalembert.vibration.balance.condensation import Point
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.newton import Plane, Solution
from dalembert.vibration.paths.curve import FrequencyCurve


@dataclass(frozen=True)
class RecordedEquations(Equations):
    """Equations that read solutions from a checkpoint, and add new ones to it.

    A path goes from one solution to the next, so it takes the same way again, bit for bit. Where a solution is known
    its forces and its Jacobian are evaluated once, in place of once an iteration.

    Parameters
    ----------
    checkpoint : Checkpoint
    """

    checkpoint: Checkpoint | None = None

    def solve(
        self,
        unknowns: np.ndarray,
        omega: float,
        samples: int,
        plane: Plane | None = None,
        point: Point | None = None,
    ) -> Solution:
        assert self.checkpoint is not None  # recorded() gives one
        key = self._key(unknowns, omega, samples, plane)
        known = self.checkpoint.recall(key)
        if known is not None:
            return self._restored(*known)
        began = perf_counter()
        found = super().solve(unknowns, omega, samples, plane, point)
        numbers = (found.omega, found.iterations, found.error, found.converged, found.samples, found.sampling_error)
        self.checkpoint.keep(key, (found.unknowns, np.array(numbers, dtype=float)), perf_counter() - began)
        return found

    def once(self, what: str, solution: Solution, compute: Callable[[], np.ndarray]) -> np.ndarray:
        assert self.checkpoint is not None
        key = what.encode() + self._key(solution.unknowns, solution.omega, solution.samples, None)
        return self.checkpoint.once(key, lambda: (compute(),))[0]

    def _restored(self, unknowns: np.ndarray, numbers: np.ndarray) -> Solution:
        """Return a solution from its stored values."""
        omega, iterations, error, converged, samples, sampling_error = numbers.tolist()
        point = self.condensation.at(omega)
        evaluation, tangent = self.balance(int(samples)).linearised(point, unknowns)
        return Solution(
            omega, unknowns, point, evaluation, tangent, int(iterations), error, bool(converged), int(samples),
            sampling_error,
        )  # fmt: skip

    def _key(self, unknowns: np.ndarray, omega: float, samples: int, plane: Plane | None) -> bytes:
        """Hash of all that a solution depends on."""
        asked = [np.array([omega, samples]), unknowns]
        if plane is not None:
            asked += [plane.direction, plane.unknowns, np.array([plane.omega, plane.size, plane.width])]
        return hashlib.sha256(self._system + b"".join(map(np.ndarray.tobytes, asked))).digest()

    @cached_property
    def _system(self) -> bytes:
        return b"harmonic balance" + self.lowered.fingerprint(self.method).encode()


def recorded(problem: Equations, checkpoint: Checkpoint | None) -> Equations:
    """Return the equations with their solutions in a checkpoint, or as they are without one."""
    return problem if checkpoint is None else RecordedEquations(problem.lowered, problem.method, checkpoint=checkpoint)


def keep_curve(checkpoint: Checkpoint, key: bytes, curve: FrequencyCurve, seconds: float) -> None:
    """Store a whole curve, with the seconds that it took."""
    contents = curve.contents()
    over = {name: dimensions for name, (dimensions, *_) in contents.variables.items()}
    text = np.frombuffer(json.dumps({"variables": over, "attributes": dict(contents.attributes)}).encode(), np.uint8)
    checkpoint.keep(key, (text, *(values for _, values, *_ in contents.variables.values())), seconds)


def kept_curve(checkpoint: Checkpoint, key: bytes) -> FrequencyCurve | None:
    """Return the stored curve, or None."""
    known = checkpoint.recall(key)
    if known is None:
        return None
    text, *arrays = known
    told = json.loads(text.tobytes())
    variables = dict(zip(told["variables"], zip(told["variables"].values(), arrays, strict=True), strict=True))
    return FrequencyCurve.from_xarray(Contents(variables, attributes=told["attributes"]).to_xarray())
