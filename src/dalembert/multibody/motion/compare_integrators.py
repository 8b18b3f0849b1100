"""Integrators compared on one motion: error against run time."""

import hashlib
import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.argument_readers import names_of
from dalembert.arguments import takes_checked
from dalembert.errors import DalembertError, InputError
from dalembert.forward import Checkpoint
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.run import make_problem
from dalembert.multibody.kernels.callbacks import in_complex_numbers
from dalembert.multibody.model.fingerprint import fingerprint
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.motion.simulation import prepared, simulate
from dalembert.multibody.motion.trajectory import Trajectory
from dalembert.results import Result
from dalembert.stored_fields import Source, Store
from dalembert.tables import Table, cells, counted, marks, noted, shown

OnRow = Callable[["IntegratorRun"], None]
ERRORS = (1e-4, 1e-8)
"""Errors that the fastest integrator is named for."""


@dataclass(frozen=True)
class IntegratorRun:
    """One run of one integrator. ``method``: name of the integrator's series; ``settings``: the integrator with its
    settings; ``error``: largest distance of any channel from the reference at any output time, relative to the
    channel's range; ``seconds``: run time of the integration alone, the smallest of the repetitions; ``position``,
    ``velocity``, ``acceleration``: largest constraint violations (m or rad, and per s and s^2); ``energy``: largest
    energy imbalance relative to the range of the kinetic energy, NaN where nothing moves; ``failure``: why the run
    ended early, empty if it did not.
    """

    method: str
    settings: str
    error: float = np.nan
    seconds: float = np.nan
    steps: int = 0
    position: float = np.nan
    velocity: float = np.nan
    acceleration: float = np.nan
    energy: float = np.nan
    failure: str = ""


class _Rows:
    """Rows as variables over the dimension ``run``."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Sequence[IntegratorRun]) -> None:
        for part in IntegratorRun.__dataclass_fields__:
            to.variables[part] = ("run", [getattr(row, part) for row in value])

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> tuple[IntegratorRun, ...]:
        columns = (source.arrays[part].tolist() for part in IntegratorRun.__dataclass_fields__)
        return tuple(map(IntegratorRun, *columns))


@dataclass(frozen=True, eq=False)
class WorkPrecision(Result):
    """Errors and run times of integrators on one motion, as :func:`work_precision` returns them.

    Parameters
    ----------
    channels : tuple of str
    end : float
        s.
    reference : str
        The integrator that the errors are measured against, with its settings.
    apart : float
        Distance of the reference from a run of the reference with other settings, in the same measure as the errors:
        an error near it says nothing.
    rows : tuple of Row
    """

    FORMAT: ClassVar[str] = "dalembert work and precision 1"
    TITLE: ClassVar[str] = "Work and precision"
    VERDICTS: ClassVar[tuple[str, str]] = ("compared", "not compared")

    channels: tuple[str, ...]
    end: float
    reference: str
    apart: float
    rows: Annotated[tuple[IntegratorRun, ...], _Rows()]

    @property
    def methods(self) -> tuple[str, ...]:
        """Names of the series, in their order."""
        return tuple(dict.fromkeys(row.method for row in self.rows))

    @property
    def success(self) -> bool:
        """Whether any integrator came to the end of the motion."""
        return any(not row.failure for row in self.rows)

    @property
    def status(self) -> str:
        """What is compared and how far it can be trusted, in sentences."""
        failed = sum(bool(row.failure) for row in self.rows)
        known = f"to about {self.apart:.1e}" if np.isfinite(self.apart) and self.apart > 0 else "to rounding"
        early = f" {failed} of {len(self.rows)} runs ended early; the table has the reasons." if failed else ""
        return f"The reference is {self.reference}; by a second one it is known {known}.{early}"

    def fastest(self, error: float) -> IntegratorRun | None:
        """The fastest run whose error is at most ``error``; None if there is none."""
        good = [row for row in self.rows if row.error <= error]
        return min(good, key=lambda row: row.seconds, default=None)

    def facts(self) -> dict[str, str]:
        return {
            "simulated": f"{shown(self.end)} s",
            "integrators": counted(len(self.methods)),
            "runs": counted(len(self.rows)),
            **{f"fastest to {error:.0e}": row.method for error in ERRORS if (row := self.fastest(error))},
        }

    def tables(self) -> tuple[Table, ...]:
        """Return error, run time and constraint violations of each run."""
        columns = {
            "integrator": [row.method for row in self.rows],
            "settings": [row.settings for row in self.rows],
            "error": cells([row.error for row in self.rows], 3),
            "run time (s)": cells([row.seconds for row in self.rows], 3),
            "steps": [row.steps for row in self.rows],
            "|Φ|": cells([row.position for row in self.rows], 2),
            "|Φ̇|": cells([row.velocity for row in self.rows], 2),
            "|Φ̈|": cells([row.acceleration for row in self.rows], 2),
            "energy": cells([row.energy for row in self.rows], 2),
            "note": marks(row.failure for row in self.rows),
        }
        caption = (
            "Errors relative to the channels' ranges, constraint violations, energy relative to the kinetic energy's"
        )
        return (noted(Table.of("integrators", caption, columns)),)


@takes_checked()
def work_precision(
    system: BaseSystem,
    end: float,
    channels: Sequence[str],
    solvers: Mapping[str, Sequence[Integrator]],
    *,
    reference: Sequence[Integrator],
    samples: int = 41,
    repeats: int = 3,
    checkpoint: Checkpoint | None = None,
    on_row: OnRow | None = None,
) -> WorkPrecision:
    """Errors and run times of integrators on one motion.

    Parameters
    ----------
    system : Mechanism
    end : float
        s.
    channels : sequence of str
        What the errors are measured on.
    solvers : mapping of str to sequence of Integrator
        Series of integrators by name, such as one method at several steps or tolerances.
    reference : two integrators
        The first gives the motion that errors are measured from, the second says how well it is known; choose two
        different methods, or settings, that are both finer than what is compared.
    samples : int
        Output times, evenly from 0 to ``end``.
    repeats : int
        Runs of each, after one that is not timed (it may compile); the fastest counts, because other load on the
        machine only ever adds.
    checkpoint : Checkpoint, optional
        Where the references and the rows are kept as they are found, with their times; begun again with the same file
        the comparison continues with those that are missing.
    on_row : callable, optional
        Is called with each `IntegratorRun` when it is there.

    Returns
    -------
    WorkPrecision

    Raises
    ------
    InputError
        For a reference that is not two integrators, or no series.
    SolveError
        Where a reference ends early. An integrator that is compared and ends early has a row that says why.

    Examples
    --------
    >>> from dalembert.multibody import DistanceJoint, GeneralizedAlpha, PointMass, System, work_precision
    >>> system = System()
    >>> bob = system.add(PointMass("bob", mass=1.0, position=(-1.0, 0.0)))
    >>> rod = system.add(DistanceJoint("rod", system.ground.point(0.0, 0.0), bob.centre))
    >>> fine = [GeneralizedAlpha(step=1e-4), GeneralizedAlpha(step=2e-4)]
    >>> series = {"generalized-alpha": [GeneralizedAlpha(step=1e-2), GeneralizedAlpha(step=1e-3)]}
    >>> found = work_precision(system, 0.5, ["bob.centre.x"], series, reference=fine)
    >>> errors = [row.error for row in found.rows]
    >>> errors[1] < 0.02 * errors[0]  # second order
    True
    """
    channels = names_of(channels, "work_precision", "channels")
    if not channels:
        raise InputError("work_precision: no channels were given; name at least one, such as 'AB.end.x'")
    if len(reference) != 2:
        given = "1 reference was" if len(reference) == 1 else f"{len(reference)} references were"
        raise InputError(
            f"work_precision: {given} given; expected two, the second of which says how well the first is known"
        )
    if not any(solvers.values()):
        raise InputError("work_precision: no integrators were given; expected at least one series of them")
    times = np.linspace(0.0, end, samples)
    compared = _Comparison(system, end, times, channels, reference[0], repeats, checkpoint)
    known, beside = map(compared.motion, reference)
    rows = []
    for method, series in solvers.items():
        for solver in series:
            rows.append(compared.row(method, solver, known))
            if on_row:
                on_row(rows[-1])
    return WorkPrecision(channels, float(end), str(reference[0]), _distance(beside, known), tuple(rows))


@dataclass(frozen=True)
class _Comparison:
    """A motion whose runs are kept where there is a checkpoint."""

    system: BaseSystem
    end: float
    times: np.ndarray
    channels: tuple[str, ...]
    reference: Integrator
    repeats: int
    checkpoint: Checkpoint | None

    def motion(self, solver: Integrator) -> np.ndarray:
        """Channels of a run, (samples, channels)."""
        return self._once(lambda: self._simulated(solver).channels(self.channels), "motion", solver)

    def row(self, method: str, solver: Integrator, known: np.ndarray) -> IntegratorRun:
        """An integrator beside the channels of the reference."""

        def compute() -> np.ndarray:
            return np.frombuffer(json.dumps(asdict(self._row(method, solver, known))).encode(), np.uint8)

        return IntegratorRun(**json.loads(self._once(compute, "row", method, solver, self.repeats).tobytes()))

    def _simulated(self, solver: Integrator) -> Trajectory:
        return simulate(self.system, self.end, solver, self.times)

    def _row(self, method: str, solver: Integrator, known: np.ndarray) -> IntegratorRun:
        try:
            motion = self._simulated(solver)
            # Shortest time of the integration alone, to the output times and no others.
            lowered, chosen = prepared(self.system, self.end, solver)
            problem = make_problem(lowered, self.times)
            seconds = np.inf
            with in_complex_numbers(strict=False):
                for _ in range(self.repeats):
                    began = time.perf_counter()
                    chosen.integrate([lowered], (), problem, self.end, logged=False)
                    seconds = min(seconds, time.perf_counter() - began)
        except DalembertError as error:  # it ended early, or is not made for this mechanism
            return IntegratorRun(method, str(solver), failure=str(error))
        worst: Any = {level: float(np.max(values)) for level, values in motion.violations.items()}
        error, steps = _distance(motion.channels(self.channels), known), int(motion.run.counts[0])
        kinetic = float(np.ptp(motion.energies["kinetic"]))
        imbalance = float(np.max(np.abs(motion.energies["balance"]))) / kinetic if kinetic > 0 else np.nan
        return IntegratorRun(method, str(solver), error, seconds, steps, **worst, energy=imbalance)

    def _once(self, compute: Callable[[], np.ndarray], *what: object) -> np.ndarray:
        """What the checkpoint holds of this, or what is computed now."""
        if self.checkpoint is None:
            return compute()
        key = hashlib.sha256(repr((self._mechanism, *what)).encode()).digest()
        return self.checkpoint.once(key, lambda: (compute(),))[0]

    @cached_property
    def _mechanism(self) -> str:
        with in_complex_numbers(strict=False):
            return fingerprint(lower(self.system), self.times, self.end, self.channels, self.reference)


def _distance(values: np.ndarray, known: np.ndarray) -> float:
    """Largest distance of any channel, relative to its range; 1 is taken where a channel does not move."""
    span = np.ptp(known, axis=0)
    return float(np.max(np.abs(values - known) / np.where(span > 0, span, 1.0)))
