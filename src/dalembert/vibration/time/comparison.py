"""Points of a curve by harmonic balance beside integration in time."""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.forward import Checkpoint, ensemble
from dalembert.tables import Table, cells, counted, labelled, noted, percent, unless
from dalembert.threads import single_thread
from dalembert.units import unit_of
from dalembert.vibration.balance.equations import require_one_period
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import require_full_load
from dalembert.vibration.paths.focus import foremost
from dalembert.vibration.storage import Over, VibrationResult
from dalembert.vibration.system.system import VibrationSystem
from dalembert.vibration.time.newmark import Newmark
from dalembert.vibration.time.reference import LONG_RUN, steady_state

SPREAD = 4
"""Points besides the largest response that are compared if none are asked for."""

Points = Annotated[np.ndarray, Over(("point",))]


@dataclass(frozen=True, eq=False)
class TimeComparison(VibrationResult):
    """Sizes of periodic motions by harmonic balance and in time, as :func:`compare_in_time` returns them.

    Parameters
    ----------
    dofs : tuple of str
    kind : str
        Of the sizes: ``"peak"``, ``"rms"`` or ``"harmonic 1"`` and so on.
    points : array of int, shape (k,)
        Of the curve.
    frequencies : array, shape (k,)
        Hz.
    balance, time : array, shape (k, dofs)
        m.
    periods : array of int, shape (k,)
        That were gone through in time.
    residuals : array, shape (k,)
        Change of the motion over the last of these, as part of its size.
    converged : array of bool, shape (k,)
        Whether that is within the tolerance.
    provenance : mapping
        Settings of the integration.
    """

    FORMAT: ClassVar[str] = "dalembert comparison in time 1"
    TITLE: ClassVar[str] = "Comparison with time integration"
    VERDICTS: ClassVar[tuple[str, str]] = ("compared", "incomplete")

    dofs: tuple[str, ...]
    kind: str
    points: Points
    frequencies: Annotated[np.ndarray, Over(("point",), "Hz")]
    balance: Annotated[np.ndarray, Over(("point", "dof"), "m")]
    time: Annotated[np.ndarray, Over(("point", "dof"), "m")]
    periods: Points
    residuals: Points
    converged: Points
    provenance: Mapping[str, Any]

    def __len__(self) -> int:
        return len(self.frequencies)

    @property
    def differences(self) -> np.ndarray:
        """Of harmonic balance from time, as part of the largest size of each degree of freedom in time, (k, dofs)."""
        return (self.balance - self.time) / self.time.max(axis=0, initial=np.finfo(float).tiny)

    @property
    def success(self) -> bool:
        """Whether all points are periodic in time."""
        return bool(self.converged.all())

    @property
    def status(self) -> str:
        """Whether all points are periodic in time, in a sentence."""
        return "All points are periodic in time." if self.success else "Some points are not periodic in time yet."

    def facts(self) -> dict[str, str]:
        most = float(np.nanmax(np.abs(self.differences[self.converged]), initial=0.0))
        return {
            "points": counted(len(self)),
            "largest difference": percent(most, 2),
            "steps a period": counted(int(self.provenance["method"]["steps_per_period"])),
            "periods": f"{self.periods.min()} to {self.periods.max()}",
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the sizes by harmonic balance and in time, of the degrees of freedom that move most."""
        dofs = self.movers()
        places, unit = [self.dofs.index(dof) for dof in dofs], unit_of(self.dofs[0])
        columns = {
            "frequency (Hz)": np.tile(self.frequencies, len(dofs)),
            "degree of freedom": np.repeat(dofs, len(self.frequencies)),
            labelled("harmonic balance", unit): self.balance[:, places].T.ravel(),
            labelled("in time", unit): self.time[:, places].T.ravel(),
            "difference (% of the largest)": cells(100 * self.differences[:, places].T.ravel(), 3),
            "periods": np.tile(self.periods, len(dofs)),
            "note": unless(np.tile(self.converged, len(dofs)), "not periodic yet"),
        }
        return (noted(Table.of("in-time", "Harmonic balance and time integration", columns)),)

    def movers(self, most: int = 4) -> tuple[str, ...]:
        """The degrees of freedom that move most in time, displacements before others."""
        sizes = dict(zip(self.dofs, np.nanmax(self.time, axis=0).tolist(), strict=True))
        return foremost({dof: size for dof, size in sizes.items() if unit_of(dof) == unit_of(self.dofs[0])}, most)


@takes_checked("points", "frequencies", "way", "kind")
@single_thread()
def compare_in_time(
    system: VibrationSystem,
    curve: FrequencyCurve,
    *,
    points: Sequence[int] | None = None,
    frequencies: Sequence[float] | None = None,
    method: Newmark | None = None,
    way: str = LONG_RUN,
    kind: str = "peak",
    checkpoint: Checkpoint | None = None,
) -> TimeComparison:
    """Some points of a curve beside integration in time, which starts from them; over all cores.

    A point that is no periodic motion in time is left by it, for another one or none.

    Parameters
    ----------
    system : VibrationSystem
        That of the curve.
    curve : FrequencyCurve
    points : sequence of int, optional
        Of the curve.
    frequencies : sequence of float, optional
        Hz; the nearest points of the curve are taken. If neither is given, the largest response of the first observed
        degree of freedom, and some points spread over the curve.
    method : Newmark, optional
    way : {"long run", "shooting"}
        As in :func:`steady_state`.
    kind : str
        Of the sizes: ``"peak"``, ``"rms"`` or ``"harmonic 1"`` and so on.
    checkpoint : Checkpoint, optional
        Where the sizes of each motion are kept when it is found; begun again with the same file only the missing ones
        are integrated.

    Raises
    ------
    InputError
        For points that the curve does not have or that were not found, and for both points and frequencies.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import HarmonicForce, VibrationSystem, frequency_response
    >>> system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.1)]))
    >>> force = system.add(HarmonicForce("m", 1.0))
    >>> curve = frequency_response(system, np.array([0.1, 0.15, 0.2]))
    >>> comparison = compare_in_time(system, curve, frequencies=[0.15])
    >>> comparison.dofs, comparison.balance.round(3).tolist(), comparison.time.round(3).tolist()
    (('m.x',), [[6.841]], [[6.842]])
    """
    require_full_load(curve, "compare_in_time")
    require_one_period(HarmonicBalance(**curve.provenance["method"]), "compare_in_time")
    method, chosen = method or Newmark(), _chosen(curve, points, frequencies, kind)
    known = ""
    if checkpoint is not None:
        balance = HarmonicBalance(**curve.provenance["method"])
        known = lower(system).real.fingerprint(balance, method, way, kind, curve.dofs)

    def run(point: int) -> tuple[np.ndarray, np.ndarray]:
        motion = steady_state(
            system, float(curve.frequencies[point]), method, way=way, start=(curve, point), observe=curve.dofs
        )
        sizes = np.array([motion.amplitude(dof, kind) for dof in curve.dofs])
        return sizes, np.array([motion.periods, motion.residual, motion.converged], dtype=float)

    def once(point: int) -> Sequence[np.ndarray]:
        if checkpoint is None:
            return run(point)
        start = b"".join(array[point].tobytes() for array in (curve.unknowns, curve.frequencies, curve.samples))
        return checkpoint.once(hashlib.sha256(b"in time" + known.encode() + start).digest(), lambda: run(point))

    sizes, how = zip(*ensemble(once, chosen.tolist()), strict=True)
    periods, residuals, converged = np.array(how).T
    return TimeComparison(
        dofs=curve.dofs,
        kind=kind,
        points=chosen,
        frequencies=curve.frequencies[chosen],
        balance=np.stack([curve.amplitude(dof, kind)[chosen] for dof in curve.dofs], axis=1),
        time=np.array(sizes),
        periods=periods.astype(int),
        residuals=residuals,
        converged=converged.astype(bool),
        provenance={"method": asdict(method), "way": way},
    )


def _chosen(
    curve: FrequencyCurve, points: Sequence[int] | None, frequencies: Sequence[float] | None, kind: str
) -> np.ndarray:
    converged = np.flatnonzero(curve.converged)
    if not len(converged):
        raise InputError("compare_in_time: no point of the curve was found; see its residuals")
    if points is not None and frequencies is not None:
        raise InputError("compare_in_time: both points and frequencies were given; expected one of them")
    if frequencies is not None:
        targets = np.asarray(frequencies, dtype=float).reshape(-1, 1)
        return converged[np.abs(curve.frequencies[converged] - targets).argmin(axis=1)]
    if points is None:
        largest = converged[curve.amplitude(curve.dofs[0], kind)[converged].argmax()]
        return np.unique(np.append(largest, converged[np.linspace(0, len(converged) - 1, SPREAD).round().astype(int)]))
    for point in points:
        if point not in converged:
            raise InputError(
                f"compare_in_time: there is no point {point} that was found; expected numbers among the "
                f"{len(converged)} found ones, {converged[0]} to {converged[-1]}"
            )
    return np.asarray(points, dtype=int)
