"""The integrator that suits the mechanism."""

__all__ = ["Automatic"]

from dataclasses import dataclass, replace

from dalembert.arguments import limited
from dalembert.errors import SolveError
from dalembert.multibody.integrators.generalized_alpha.generalized_alpha import GeneralizedAlpha
from dalembert.multibody.integrators.index1.ode_solver import OdeSolver
from dalembert.multibody.integrators.index1.stabilisation import Partitioning
from dalembert.multibody.integrators.radau.radau_iia import RadauIIA
from dalembert.multibody.integrators.shared.batch import Batch
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.run import Run
from dalembert.multibody.model.lowered import Lowered, slip_scale
from dalembert.multibody.start.assemble import redundancy
from dalembert.multibody.start.singular_positions import SingularPositionError

_FIRST = 1e-3  # of the motion: the first step of an adaptive one
_STIFF = 1e-4  # 1/s: slip rate in parts of the extent; GeneralizedAlpha holds a beam at 1e-3, and at 1e-5 not always
_MOST_STEPS = 20_000  # of an explicit method past a singular position


@dataclass(frozen=True)
class Automatic(Integrator):
    """Chooses the integrator by the mechanism.

    Where all bodies are rigid nothing oscillates faster than the motion, and a high order takes long steps:
    :class:`RadauIIA`; with redundant constraints :class:`OdeSolver`, which finds multipliers for them. Beams and cables
    bring frequencies that nobody wants to follow: :class:`GeneralizedAlpha` damps them, and its step, adaptive here,
    costs little; for dry friction with a small slip rate, :class:`RadauIIA`. Where a singular position (a
    flat four-bar) stops :class:`RadauIIA`, :class:`OdeSolver` runs the motion again, if it can pass. The page "Which
    integrator" has the measurements behind this rule.

    Parameters
    ----------
    tolerance : float
        Of the estimated error of a step, relative to each coordinate's scale: the extent of the mechanism for
        positions, 1 for angles and gradients.

    Examples
    --------
    >>> from dalembert.multibody import RevoluteJoint, RigidBar, System, simulate
    >>> system = System(gravity=(0.0, -9.81))
    >>> bar = system.add(RigidBar("bar", length=1.0, mass=1.0))
    >>> pin = system.add(RevoluteJoint("pin", system.ground, bar.start))
    >>> simulate(system, end=1.0, solver="auto").solver
    RadauIIA(tolerance=1e-06, step=None, stages=5, newton_tolerance=1e-14, most_steps=1000000)
    """

    tolerance: float = limited(1e-6, unit="", above=0)

    def suiting(self, lowered: Lowered, end: float) -> Integrator:
        """The integrator for a mechanism's motion until ``end`` (s)."""
        flexible = not all(body.rigid for body in lowered.bodies.values())
        if flexible and slip_scale(lowered) >= _STIFF:
            return GeneralizedAlpha(step=_FIRST * end, adaptive=True, tolerance=self.tolerance)
        known = redundancy(lowered)
        if known.rank == known.count:
            return RadauIIA(tolerance=self.tolerance)
        if flexible:
            return GeneralizedAlpha(step=_FIRST * end, spectral_radius=0.0, adaptive=True, tolerance=self.tolerance)
        return self._redundant()

    def instead(self, reason: SolveError | None) -> Integrator | None:
        """The method for redundant constraints where a singular position stopped the run."""
        return replace(self._redundant(), most_steps=_MOST_STEPS) if isinstance(reason, SingularPositionError) else None

    def _redundant(self) -> OdeSolver:
        return OdeSolver("DOP853", self.tolerance, self.tolerance, Partitioning())

    def run(self, batch: Batch) -> list[Run]:
        """Runs by the integrator that suits the first sample; samples that it cannot finish run by another one."""
        runs = self.suiting(batch.samples[0], batch.end).run(batch)
        for number, run in enumerate(runs):
            if other := self.instead(run.reason):
                (second,) = other.run(batch.part([number]))
                runs[number] = run if second.reason else second
        return runs
