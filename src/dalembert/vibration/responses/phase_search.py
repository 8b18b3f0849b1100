"""Search of the point of a path at which a response has a phase relative to the force."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from dalembert.errors import InputError
from dalembert.vibration.balance.arc_length import PathTangent, direction_at
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.held_response import PhaseHeld, ResponseRow
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.paths.amplitudes import Amplitude
from dalembert.vibration.responses.peak_search import FIRST, LONGEST, MOST_STEPS, WIDTH, Peak, upwards


@dataclass(frozen=True)
class PhaseSearch:
    """Search of the point at which a row of the structure has a phase relative to the force."""

    row: int
    size: Amplitude
    phase: float

    def search(self, problem: Equations, solution: Solution, bend: float) -> tuple[Peak | None, int]:
        """Return the point of that phase next to a solution, and the number of solutions."""
        solves, constraint = 0, self._constraint(problem, solution)
        for near, spent in self._starts(problem, solution, constraint):
            solves += spent + 1
            locked = problem.solve(near.unknowns, near.omega, near.samples, constraint)
            # The opposite phase has the same condition.
            opposite = constraint.leads(locked.unknowns, locked.omega)
            if locked.converged and locked.omega > 0 and not opposite:
                amplitude = float(self.size.of(problem.measured @ locked.unknowns))
                return Peak(np.nan, problem, locked, amplitude), solves
        return None, solves

    def _starts(self, problem: Equations, solution: Solution, constraint: PhaseHeld) -> Iterator[tuple[Solution, int]]:
        """Yield the solution itself, then one behind which the phase passes the asked one; with the solutions to it."""

        def off(at: Solution) -> float:
            return constraint.distance(at.unknowns, at.omega, at.point)

        yield solution, 0
        width = WIDTH * solution.omega
        direction, value = direction_at(solution, upwards(solution), width), off(solution)
        length, turned = FIRST, False
        for count in range(1, MOST_STEPS + 1):
            ahead, heading = PathTangent(solution, direction, width).step(problem, length)
            if heading is None:
                length /= 4
                continue
            beyond = off(ahead)
            if beyond * value <= 0:
                yield (ahead if abs(beyond) < abs(value) else solution), count
                return
            # The phase falls along a path over a resonance: from the first step on, to the side where it comes nearer.
            if not turned and abs(beyond) > abs(value):
                direction, turned = -direction, True
                continue
            turned = True
            solution, direction, value = ahead, direction_at(ahead, heading, width), beyond
            length = min(LONGEST, 2 * length)

    def _constraint(self, problem: Equations, solution: Solution) -> PhaseHeld:
        series = problem.balance(solution.samples).series
        response = ResponseRow(series, problem.measured)
        size = float(np.linalg.norm(solution.unknowns)) or 1.0
        return PhaseHeld(response, self._force(problem, series), self.phase, size, WIDTH * solution.omega)

    def _force(self, problem: Equations, series: Fourier) -> Callable[[float], tuple[complex, complex]]:
        """Return the first harmonic of the force on the row, else of the largest one, over ω."""
        loads, place = problem.lowered.loads(series), series.orders.index(1)
        sizes = np.abs(loads.patterns[:, place]).max(axis=0)
        row = self.row if sizes[self.row] else int(sizes.argmax())
        if not sizes[row]:
            raise InputError("track_resonance: no force acts in the first harmonic, so the response has no phase to it")

        def force(omega: float) -> tuple[complex, complex]:
            values, slopes = (weights @ loads.patterns[:, place, row] for weights in loads.weights(omega))
            return complex(values), complex(slopes)

        return force
