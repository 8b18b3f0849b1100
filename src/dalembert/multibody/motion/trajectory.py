"""A simulated motion: channels, energies, constraint violations, reactions and what is needed to draw it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from dalembert.argument_readers import names_of
from dalembert.contents import Contents
from dalembert.errors import require_known
from dalembert.files import write_contents
from dalembert.findings import Finding
from dalembert.kernels.preparation import prepare
from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.run import Run
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.drawing import Drawing, draw
from dalembert.multibody.model.evaluate import energies, energy_kernels, violations
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.observe import beside, channel_names, observer
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.model.turns import CountedAngle, counted_angles
from dalembert.multibody.motion.bushing_rotations import half_turns, turning_bushings
from dalembert.multibody.motion.skipped_samples import skipped_samples
from dalembert.multibody.motion.slip_rates import rubbing, slip_findings
from dalembert.multibody.motion.work import works_of_steps
from dalembert.multibody.start.lost_freedom import no_freedom
from dalembert.multibody.start.start_findings import redundant_constraints, start_findings
from dalembert.results import Summarised
from dalembert.tables import Table, cells, counted, percent, shown

if TYPE_CHECKING:
    from xarray import Dataset


@dataclass(frozen=True, eq=False)
class Trajectory(Summarised):
    """The motion of a system, as :func:`simulate` returns it.

    Parameters
    ----------
    system : BaseSystem
        The mechanism.
    lowered : Lowered
        Its arrays, which kernels take.
    solver : Integrator
        The integrator with its settings.
    run : Run
        States at the output times and, if they fit into memory, at every step.
    rows : array of int, shape (samples,)
        Indices of the output times among the times of the run.
    """

    TITLE: ClassVar[str] = "Simulated motion"
    VERDICTS: ClassVar[tuple[str, str]] = ("simulated", "")

    system: BaseSystem
    lowered: Lowered
    solver: Integrator
    run: Run
    rows: np.ndarray

    INSTEAD = "give its system"

    @property
    def times(self) -> np.ndarray:
        """Output times, s, (samples,)."""
        return self.run.times[self.rows]

    @property
    def states(self) -> MotionState:
        """Unknowns, velocities and accelerations at the output times, (samples, N + 1) each."""
        return MotionState(*(array[self.rows] for array in self.run.states))

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """Those of the system and of its motion.

        Skipped samples, redundant constraints, no freedom, stretched or folded beams, unsuited friction, bushings that
        pass half a turn.
        """
        joints = rubbing(self.system)
        begin = float(np.real(self.lowered.signal_data[0]))
        skipped = skipped_samples(self.system, self.solver.fixed_step, begin, float(self.run.times[-1]))
        held = no_freedom(self.lowered)
        if self.solver.takes_redundancy and not held:
            held = redundant_constraints(self.lowered)
        bushings = turning_bushings(self.system)
        states, first = self.run.states, self.lowered.structure.first
        of_motion = [*start_findings(self.system, self.lowered, states.x[0]), *skipped, *held]
        for body in self.system.bodies:
            if body.has_motion_findings:
                slots = slice(first[body.name], first[body.name] + body.size)
                of_motion += body.motion_findings(self.run.times, states.x[:, slots], states.v[:, slots])
        if not (joints or bushings):
            return (*self.system.findings, *of_motion)
        names = [f"{name}.{own.channel}" for name, own in joints.items()]
        names += [f"{name}.{axis}" for name, axes in bushings.items() for axis in axes]
        readers = observer(self.system, self.lowered, names)
        prepare(readers.kernels(self.lowered, False))
        values = readers.read(self.lowered, self.lowered.real, self.run.states, self.run.times, self._turns)
        unsuited = (
            slip_findings(name, own, self.run.times, column, self.solver.fixed_step)
            for (name, own), column in zip(joints.items(), values.T, strict=False)
        )
        vectors = np.split(values[:, len(joints) :], len(bushings), axis=1) if bushings else []
        turned = half_turns(self.run.times, dict(zip(bushings, vectors, strict=True)))
        return (*self.system.findings, *of_motion, *chain.from_iterable(unsuited), *turned)

    @cached_property
    def _turns(self) -> dict[CountedAngle, np.ndarray]:
        """Whole turns of angles at all times of the run."""
        return dict(zip(counted_angles(self.lowered), self.run.turns.T, strict=True))

    @property
    def channel_names(self) -> tuple[str, ...]:
        """All channels that the system offers."""
        return channel_names(self.system)

    def channels(self, names: Sequence[str]) -> np.ndarray:
        """Values of channels in SI units, (samples, channels).

        Raises
        ------
        InputError
            For an unknown name, with the nearest ones.
        """
        own = observer(self.system, self.lowered, names_of(names, "Trajectory", "channels"))
        prepare(own.kernels(self.lowered, False))
        turns = {angle: counted[self.rows] for angle, counted in self._turns.items()}
        return own.read(self.lowered, self.lowered.real, self.states, self.times, turns)

    def reactions(self, joint: str) -> np.ndarray:
        """Force (N) and torque (N m) of a joint on its second side at its point, in the fixed axes.

        In the plane the force along x and y and the torque, (samples, 3); in space three components of each,
        (samples, 6). Those of a coupling in space act on side b of its second joint, along or about the axis of that
        joint.

        Raises
        ------
        InputError
            For an unknown joint.
        """
        joints = {own.name: own for own in self.system.joints}
        require_known("joint", joint, joints, "Trajectory.reactions")
        axes = self.system.AXES
        if joints[joint].coupled is not None:
            return self._coupling_reactions(joint, *joints[joint].coupled)
        torques = ["torque"] if len(axes) == 2 else [f"torque_{axis}" for axis in axes]
        return self.channels([f"{joint}.{name}" for name in (*(f"force_{axis}" for axis in axes), *torques)])

    def _coupling_reactions(self, coupling: str, joint: BaseJoint, output: str) -> np.ndarray:
        """Force and torque (samples, 6) of a coupling on side b of a joint, at its point."""
        kind, row = self.lowered.structure.rows[joint.name]
        index, integers = self.lowered.structure.index[kind][row], self.lowered.structure.meta[kind][row]
        numbers = np.real(self.lowered.data[kind][row])
        directions = joint.axis_directions(numbers, integers, np.real(self.states.x[:, index]))
        own = self.channels([f"{coupling}.{output}"]) * directions
        still = np.zeros_like(own)
        return np.hstack([still, own] if output.startswith("torque") else [own, still])

    @property
    def energies(self) -> dict[str, np.ndarray]:
        """Energies in J, each (samples,): kinetic, potential, total, work of loads and losses, and their balance.

        The work is the integral of the power over the steps, with an error of fourth order. balance = total - work -
        first total; an exact motion keeps it at zero.
        """
        return {name: values[self.rows] for name, values in self._energies.items()}

    @cached_property
    def _energies(self) -> dict[str, np.ndarray]:
        """Energies at all times of the run."""
        prepare(energy_kernels(self.lowered, False))
        states, times = self.run.states, self.run.times
        kinetic, potential, _ = energies(self.lowered.real, states.x, states.v, times, beside(times, -1)).T
        work = np.concatenate([[0.0], np.cumsum(works_of_steps(self.lowered, times, states))])
        total = kinetic + potential
        balance = total - work - total[0]
        return {"kinetic": kinetic, "potential": potential, "total": total, "work": work, "balance": balance}

    @cached_property
    def violations(self) -> dict[str, np.ndarray]:
        """Largest constraint violations (m or rad, and per s and s^2), each (samples,)."""
        states, times = self.states, self.times
        levels = violations(self.lowered, states.x, states.v, states.a, times, beside(self.run.times, -1)[self.rows]).T
        return dict(zip(("position", "velocity", "acceleration"), levels, strict=True))

    @property
    def newton_iterations(self) -> np.ndarray:
        """Newton iterations of each step, (steps,)."""
        return self.run.iterations

    def drawing(self, points: int = 8) -> Drawing:
        """Lines of the bodies and places of the joints over time; ``points`` a beam element."""
        return draw(self.system, self.lowered, self.times, self.states.x, points)

    def contents(self, names: Sequence[str] | None = None) -> Contents:
        """Channels (all if not named), energies and violations, labelled with units."""
        names = tuple(names or self.channel_names)
        channels = observer(self.system, self.lowered, names).channels
        values = self.channels(names)
        variables: dict = {
            channel.name: ("time", values[:, column], {"units": channel.unit})
            for column, channel in enumerate(channels)
        }
        variables |= {f"energy.{name}": ("time", value, {"units": "J"}) for name, value in self.energies.items()}
        variables |= {f"violation.{name}": ("time", value) for name, value in self.violations.items()}
        coordinates = {"time": ("time", self.times, {"units": "s"})}
        return Contents(variables, coordinates, {"solver": repr(self.solver), "steps": int(self.run.counts[0])})

    def to_xarray(self, names: Sequence[str] | None = None) -> "Dataset":
        """Return :meth:`contents` as an :class:`xarray.Dataset`."""
        return self.contents(names).to_xarray()

    def save(self, path: str | Path, names: Sequence[str] | None = None) -> None:
        """Write :meth:`contents` as NetCDF-4, whole or not at all."""
        write_contents(path, self.contents(names))

    @property
    def status(self) -> str:
        """How well energy is balanced, in a sentence."""
        energies, balance = self.energies, _largest(self.energies, "balance")
        swing = max((float(np.ptp(values)) for key, values in energies.items() if key != "balance"), default=0.0)
        if not (swing > 0 and np.isfinite(balance)):
            return "The motion was simulated to its end."
        kept = f"The energy balance is kept to {percent(balance / swing, 2)} of the energy that moves"
        return f"{kept}; a smaller step lowers it."

    def facts(self) -> dict[str, str]:
        steps, iterations, _, rejected = self.run.counts
        return {
            "simulated": f"{shown(float(self.times[-1] - self.times[0]))} s",
            "steps": f"{counted(int(steps))}, {counted(int(rejected))} rejected" if rejected else counted(int(steps)),
            "Newton iterations a step": shown(iterations / max(steps, 1), digits=3),
            "largest energy error": f"{shown(_largest(self.energies, 'balance'), digits=3)} J",
            "largest constraint violation": f"{shown(_largest(self.violations, 'position'), digits=3)} m",
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the largest energy imbalance and constraint violations, and the iterations."""
        counts = np.asarray(self.newton_iterations)
        rows = [
            ("largest energy balance", _largest(self.energies, "balance"), "J"),
            *(
                (f"largest violation, {level}", _largest(self.violations, level), unit)
                for level, unit in {"position": "m", "velocity": "m/s", "acceleration": "m/s²"}.items()
            ),
            ("steps", len(counts), ""),
            ("Newton iterations a step, mean", float(counts.mean()) if len(counts) else float("nan"), ""),
            ("Newton iterations a step, most", int(counts.max(initial=0)), ""),
        ]
        names = ("quantity", "value", "unit")
        return (Table.of_rows("diagnostics", "Diagnostics", names, [cells(row, 3) for row in rows]),)


def _largest(series: Mapping[str, np.ndarray], key: str) -> float:
    """Return the largest magnitude of one of several series; NaN if it is missing."""
    return float(np.nanmax(np.abs(series[key]), initial=0.0)) if key in series else float("nan")
