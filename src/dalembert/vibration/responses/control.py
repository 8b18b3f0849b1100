"""Responses whose amplitude is held: the force that keeps it, at each frequency."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError
from dalembert.vibration.balance.arc_length import along
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.first_guesses import Loading
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.held_response import AmplitudeHeld, ResponseRow
from dalembert.vibration.balance.newton import Constraint, Solution
from dalembert.vibration.interface.condensed_structure import norm

LEAST_LOAD = 1e-3
"""Part of the forces from which a path over them begins."""
MOST_STEPS = 200


@dataclass(frozen=True)
class HeldAmplitude(Checked):
    """A response that a controller holds: the amplitude of the first harmonic of a degree of freedom.

    All forces but static ones are scaled by one factor, which is an unknown of each frequency. Curves of held
    displacements often have no folds where those of held forces have some.

    Parameters
    ----------
    dof : str
        Such as ``"tip.x"``.
    amplitude : float
        m, or rad of a rotation.

    Examples
    --------
    >>> import numpy as np
    >>> import dalembert as da
    >>> system = da.VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.1)]))
    >>> force, spring = system.add(da.HarmonicForce("m", 1.0)), system.add(da.CubicSpring("k3", "m", stiffness=0.1))
    >>> frequencies = np.array([0.15, 0.2])
    >>> curve = da.frequency_response(system, frequencies, da.HarmonicBalance(5), control=HeldAmplitude("m", 2.0))
    >>> curve.amplitude("m", "harmonic 1").round(6).tolist(), curve.load_factors.round(2).tolist()
    ([2.0, 2.0], [0.85, 0.61])
    """

    dof: str
    amplitude: float = field(metadata={"unit": "m"})

    def __post_init__(self) -> None:
        if not (np.isfinite(self.amplitude) and self.amplitude > 0):
            raise InputError(f"HeldAmplitude: the amplitude is {self.amplitude}; expected a positive number")


class Controlled:
    """Equations with a held amplitude, whose further unknown is the part of the varying forces.

    The last part is where the search at the next frequency starts.
    """

    def __init__(self, problem: Equations, held: HeldAmplitude) -> None:
        self.problem, self._load = problem, 1.0
        series = problem.balance(problem.method.first_samples).series
        self._amplitude, self._response = held.amplitude, ResponseRow(series, problem.measured)
        if not np.any(problem.lowered.loads(series).patterns[:, series.orders.index(1)]):
            raise InputError(
                "HeldAmplitude: no force acts in the first harmonic, so none holds its amplitude. Add a HarmonicForce"
            )
        signs = [[(-1.0) ** order] * (1 if order == 0 else 2) for order in series.orders]
        self._later = np.concatenate(signs)

    @property
    def method(self) -> HarmonicBalance:
        """The method of the equations."""
        return self.problem.method

    def solve(self, unknowns: np.ndarray, omega: float, samples: int, plane: Constraint | None = None) -> Solution:
        """Solve for the motion and the load at ω, from a guess and the last load."""
        solution = self._solved(unknowns, omega, samples, self._load)
        if solution.converged and solution.omega < 0:
            # Where forces have odd harmonics alone, a negative load is the motion half a period later.
            later = solution.unknowns * self._later
            solution = self._solved(later, omega, solution.samples, -solution.omega)
            solution = replace(solution, converged=solution.converged and solution.omega > 0)
        if solution.converged:
            self._load = solution.omega
        # The load was the parameter of this solution. Guesses at other frequencies are the motion itself, which the
        # control keeps.
        still = replace(solution.tangent, slope=np.zeros_like(solution.tangent.slope))
        return replace(solution, omega=omega, load=solution.omega, tangent=still)

    def _solved(self, unknowns: np.ndarray, omega: float, samples: int, load: float) -> Solution:
        """Solve from a guess of the motion and of the load, which is the ``omega`` of the solution."""
        whole = self.problem.at(omega)
        constraint = AmplitudeHeld(self._response, self._amplitude, omega, norm(unknowns) or 1.0, load)
        return self.problem.solve(unknowns, load, samples, constraint, at=whole.loaded)

    def placed(self, unknowns: np.ndarray, omega: float, samples: int) -> Solution:
        """Return the balance at a place, with the last load."""
        return self.problem.placed(unknowns, omega, samples)

    def first(self, omega: float) -> Solution:
        """Return a solution from nearby amplitudes of a path over the load."""
        best: Solution | None = None
        for guess in self._guesses(omega):
            self._load = guess.omega
            solution = self.solve(guess.unknowns, omega, guess.samples)
            if solution.converged:
                return solution
            best = solution if best is None or solution.error < best.error else best
        if best is None:
            self._load, samples = 1.0, self.method.first_samples
            best = self.solve(np.zeros(self.problem.balance(samples).shape), omega, samples)
        return best

    def _guesses(self, omega: float) -> Iterator[Solution]:
        """Yield motions at loads whose amplitudes are next to the held one."""
        whole, samples = self.problem.at(omega), self.method.first_samples
        loading = Loading(self.problem.balance(samples), self.method, whole)
        known = loading.first(LEAST_LOAD)
        if not known.converged:
            return
        # Where the motion is linear the load follows from the first one.
        reach = self._size(known)
        last = LEAST_LOAD * self._amplitude / (reach or self._amplitude)
        yield replace(known, unknowns=known.unknowns * (last / LEAST_LOAD), omega=last)
        below: Solution | None = None
        for point in islice(along(loading, LEAST_LOAD, max(100 * last, 1.0), known), MOST_STEPS):
            solution = point.solution
            if not solution.converged:
                return
            above = self._size(solution) > self._amplitude
            if above:
                if below is not None:
                    yield below
                yield solution
                return
            below = solution

    def _size(self, solution: Solution) -> float:
        return abs(self._response.phasor(solution.unknowns))
