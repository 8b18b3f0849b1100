"""What an integrator is to those who ask for a motion."""

__all__ = ["Integrator"]

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, cast

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import ModelError, SolveError
from dalembert.kernels.kernel import Compiled
from dalembert.multibody.integrators.shared.batch import Batch, make_batch, smooth_stretches
from dalembert.multibody.integrators.shared.problem import IntegrationProblem
from dalembert.multibody.integrators.shared.rotors import with_rotors, without_rotors
from dalembert.multibody.integrators.shared.run import Run, make_problem
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.structure import Structure
from dalembert.multibody.model.turns import CountedAngle


class Integrator(Checked, ABC):
    """A method that integrates the equations of motion, with its settings; a frozen dataclass.

    Every integrator serves :func:`~dalembert.multibody.simulate` and :class:`~dalembert.multibody.TimeResponse` alike:
    one motion, ensembles, and the derivatives of its own discrete solution.
    """

    takes_redundancy = False  #: whether constraints may follow from others
    constant_masses = False  #: whether masses must not change with the coordinates
    convergence: int | None = None  #: order of coordinates and velocities at fixed steps; None if not known

    @abstractmethod
    def run(self, batch: Batch) -> list[Run]:
        """Return the runs of a batch, one a sample; each sample fails for itself: its run has the reason."""

    def integrate(
        self,
        samples: Sequence[Lowered],
        perturbed: Sequence[Lowered],
        problem: IntegrationProblem,
        end: float,
        *,
        logged: bool = True,
        counted: Sequence[CountedAngle] = (),
    ) -> list[Run]:
        """Return runs of samples that share a structure, from 0 to ``end`` (s), with the states at ``problem.times``.

        Parameters
        ----------
        samples : sequence of Lowered
            Each sample fails for itself: its run has the reason.
        perturbed : sequence of Lowered
            The model along each direction of differentiation (its imaginary parts are the direction times the complex
            step); only with a single sample.
        problem : Problem
        end : float
        logged : bool
            Keep what happened at each step.
        counted : sequence of CountedAngle
            Angles whose turns are counted.

        Raises
        ------
        ModelError
            For masses that change with the coordinates, if the method needs constant ones.
        """
        if not (self.constant_masses and any(map(varying_masses, (*samples, *perturbed)))):
            return self._counted(make_batch(samples, perturbed, problem, end, logged, counted))
        if alone := next((kind.name for kind in samples[0].data if kind.varying_mass and kind.rotor is None), ""):
            raise ModelError(
                f"{type(self).__name__} needs masses that do not change with the coordinates, as those of {alone!r} "
                "do. Use RadauIIA, GeneralizedAlpha, RungeKutta4 or OdeSolver"
            )
        moved, kept = with_rotors([*samples, *perturbed])
        own = make_problem(moved[0], problem.times)
        batch = make_batch(moved[: len(samples)], moved[len(samples) :], own, end, logged, counted)
        return [without_rotors(run, kept) for run in self._counted(batch)]

    def _counted(self, batch: Batch) -> list[Run]:
        """Runs with the turns that they counted."""
        for counter in batch.counters:
            counter.follow(even=self.fixed_step is not None)
        runs = self.run(batch)
        return [replace(run, turns=own.turns) for run, own in zip(runs, batch.counters, strict=False)] or runs

    def __str__(self) -> str:
        """The settings that are not the usual ones: ``GeneralizedAlpha(step=0.001)``."""
        given = ((item, getattr(self, item.name)) for item in fields(cast(Any, self)))
        told = (f"{item.name}={value!r}" for item, value in given if value != item.default)
        return f"{type(self).__name__}({', '.join(told)})"

    def kernels(self, structure: Structure, derivatives: type | None = None) -> list[Compiled]:
        """Kernels of the method, without those of components; and those for derivatives in that arithmetic."""
        return []

    @property
    def takes_lanes(self) -> bool:
        """Whether samples may run side by side."""
        return False

    @property
    def takes_duals(self) -> bool:
        """Whether derivatives along many directions may be dual numbers."""
        return False

    def lane_kernels(self, sample: Lowered) -> list[Compiled]:
        """Kernels of the method and of the components for samples side by side."""
        return []

    def suiting(self, lowered: Lowered, end: float) -> "Integrator":
        """The integrator for a mechanism's motion until ``end`` (s): itself, but for one that chooses."""
        return self

    def refined(self) -> "tuple[Integrator, int | None] | None":
        """Return the same method at half the step, and its order; None where these are not known.

        Methods that choose their step: at a tolerance 100 times tighter, and None for the order.
        """
        own, tolerance = cast(Any, self), getattr(self, "tolerance", None)
        if self.fixed_step is None:
            return None if tolerance is None else (replace(own, tolerance=tolerance / 100), None)
        return None if self.convergence is None else (replace(own, step=self.fixed_step / 2), self.convergence)

    def instead(self, reason: SolveError | None) -> "Integrator | None":
        """The integrator to try where the suiting one stopped for a ``reason``; None but for one that chooses."""
        return None

    @property
    def fixed_step(self) -> float | None:
        """The step in s, None if the method chooses it."""
        return getattr(self, "step", None)

    def step_ends(self, end: float, jumps: tuple[float, ...] = ()) -> np.ndarray | None:
        """Ends of the fixed steps in s, 0 included, (samples,); each smooth stretch between jumps is cut evenly."""
        step = self.fixed_step
        if step is None:
            return None
        edges = smooth_stretches(jumps, end)
        lasting = np.diff(edges)
        counts = np.maximum(1, np.ceil(lasting / step - 1e-6)).astype(int)
        places = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts) + 1
        return np.append(0.0, np.repeat(edges[:-1], counts) + np.repeat(lasting / counts, counts) * places)


def varying_masses(lowered: Lowered) -> bool:
    """Whether masses change with the coordinates."""
    return any(kind.varies(data) for kind, data in lowered.data.items())
