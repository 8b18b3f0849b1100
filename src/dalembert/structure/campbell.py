"""Frequencies of a rotating system over its speed: the Campbell diagram."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from dalembert.contents import Contents
from dalembert.findings import Finding
from dalembert.results import Result
from dalembert.tables import Table, counted, labelled, shown

if TYPE_CHECKING:
    from xarray import Dataset

FIXED = "fixed"
_LINE = 0.02
"""Whirl up to which a mode counts as motion along a line."""
_GROWS = 1e-6
"""Growth rate, against the largest root, from which a motion counts as unstable."""


class SpeedModes(NamedTuple):
    """Modes at one ``speed``, rad/s: ``roots`` (modes,), ``shapes`` (coordinates, modes), ``growth`` 1/s."""

    speed: float
    roots: np.ndarray
    shapes: np.ndarray
    whirl: np.ndarray
    growth: float


class CriticalSpeed(NamedTuple):
    """A speed at which a mode has the frequency of the rotation. ``speed``: rad/s, interpolated between the speeds of
    the diagram; ``mode``: its number, from 1 on; ``direction``: ``"forward"``, ``"backward"`` or ``""``.
    """

    speed: float
    mode: int
    direction: str


@dataclass(frozen=True, eq=False)
class Campbell(Result):
    """Modes over the speed, as :func:`~dalembert.multibody.campbell` returns them.

    Parameters
    ----------
    parameter, unit : str
        What was varied.
    values : array, shape (speeds,)
        Its values.
    speeds : array, shape (speeds,)
        Angular velocity of the fastest body, rad/s.
    roots : complex array, shape (speeds, modes)
        1/s: decay rate and angular frequency; NaN where a mode does not oscillate.
    whirl : array, shape (speeds, modes)
        1 for a mode that whirls forward on circles, -1 for one that whirls backward, 0 along a line.
    growth : array, shape (speeds,)
        Largest growth rate of any motion, 1/s; 0 for stable motions.
    frame : {"fixed", "rotating"}
        Where the frequencies are observed.
    """

    FORMAT: ClassVar[str] = "dalembert Campbell diagram 1"
    TITLE: ClassVar[str] = "Campbell diagram"

    parameter: str
    unit: str
    values: np.ndarray
    speeds: np.ndarray
    roots: np.ndarray
    whirl: np.ndarray
    growth: np.ndarray
    frame: str

    @property
    def frequencies(self) -> np.ndarray:
        """Hz, (speeds, modes)."""
        return np.imag(self.roots) / (2.0 * np.pi)

    @property
    def damping_ratios(self) -> np.ndarray:
        """Relative to critical damping, (speeds, modes)."""
        return -np.real(self.roots) / np.abs(self.roots)

    def direction(self, mode: int, row: int | None = None) -> str:
        """Return how a mode, numbered from 0 on, whirls at one speed, or at most speeds."""
        whirl = self.whirl[:, mode] if row is None else self.whirl[[row], mode]
        return direction(float(np.nanmedian(whirl))) if np.isfinite(whirl).any() else ""

    @cached_property
    def critical_speeds(self) -> tuple[CriticalSpeed, ...]:
        """Speeds at which a mode has the frequency of the rotation, ascending.

        An unbalance excites modes that whirl forward there, and backward ones only if supports are anisotropic. In a
        rotating frame, frequencies are measured against the rotor, and there are none.
        """
        if self.frame != FIXED or len(self.speeds) < 2:
            return ()
        from scipy.interpolate import CubicSpline  # mechanisms that do not rotate start without it

        critical = []
        order = np.argsort(self.speeds)
        for mode in range(self.roots.shape[1]):
            gap = (np.imag(self.roots[:, mode]) - self.speeds)[order]
            known = np.isfinite(gap)
            speeds = self.speeds[order][known]
            if len(speeds) < 2 or np.any(np.diff(speeds) <= 0.0):
                continue
            for speed in CubicSpline(speeds, gap[known]).roots(extrapolate=False):
                if speed > 0.0:
                    row = int(np.nanargmin(np.abs(self.speeds - speed)))
                    critical.append(CriticalSpeed(float(speed), mode + 1, self.direction(mode, row)))
        return tuple(sorted(critical))

    @property
    def findings(self) -> tuple[Finding, ...]:  # type: ignore[override]
        """Speeds at which a motion grows."""
        largest = np.nanmax(np.abs(self.roots), axis=1, initial=1e-300)
        grows = np.flatnonzero(self.growth > _GROWS * largest)
        if not len(grows):
            return ()
        first = int(grows[np.argmin(self.speeds[grows])])
        worst = int(np.argmax(self.growth))
        values = {"speed": float(self.speeds[first]), "speeds": len(grows), "growth": float(self.growth[worst])}
        return (
            Finding(
                "unstable-rotation",
                "warning",
                values,
                f"The steady rotation is unstable at {len(grows)} of {len(self.speeds)} speeds, the lowest of them "
                f"{self.speeds[first]:.6g} rad/s: a motion grows by up to {self.growth[worst]:.3g} 1/s.",
                "Frequencies there are those of small motions that do not stay small. Add damping of the supports, or "
                "run at other speeds.",
            ),
        )

    @property
    def success(self) -> bool:
        """True: speeds without a steady rotation are an error."""
        return True

    @property
    def status(self) -> str:
        """What was computed, in a sentence."""
        count = self.roots.shape[1]
        return f"{count} modes at {len(self.speeds)} speeds, seen in the {self.frame} frame."

    def facts(self) -> dict[str, str]:
        facts = {
            "speeds": counted(len(self.speeds)),
            "highest speed": f"{shown(float(self.speeds.max()))} rad/s",
            "frame": self.frame,
        }
        critical = {f"critical speed of mode {x.mode}": f"{shown(x.speed)} rad/s" for x in self.critical_speeds[:3]}
        return facts | critical

    def tables(self) -> tuple[Table, ...]:
        """Return the critical speeds, if there are any, and the frequencies at each speed."""
        critical = self.critical_speeds
        caption = "Critical speeds: a mode has the frequency of the rotation."
        caption += " An unbalance excites those that whirl forward."
        columns = {
            "critical speed (rad/s)": [each.speed for each in critical],
            "frequency (Hz)": [each.speed / (2.0 * np.pi) for each in critical],
            "mode": [each.mode for each in critical],
            "whirl": [each.direction for each in critical],
        }
        speeds = [Table.of("critical-speeds", caption, columns)] if critical else []
        columns = {labelled(self.parameter, self.unit): self.values, "fastest body (rad/s)": self.speeds}
        for number, frequencies in enumerate(self.frequencies.T, start=1):
            columns[f"mode {number} (Hz)"] = frequencies
            columns[f"damping ratio {number}"] = self.damping_ratios[:, number - 1]
        columns["growth (1/s)"] = self.growth
        return (*speeds, Table.of("campbell", f"Frequencies in the {self.frame} frame", columns, detail=True))

    def contents(self) -> Contents:
        variables = {
            "values": (("speed",), self.values, {"units": self.unit}),
            "speeds": (("speed",), self.speeds, {"units": "rad/s"}),
            "real": (("speed", "mode"), np.real(self.roots), {"units": "1/s"}),
            "imaginary": (("speed", "mode"), np.imag(self.roots), {"units": "rad/s"}),
            "whirl": (("speed", "mode"), self.whirl),
            "growth": (("speed",), self.growth, {"units": "1/s"}),
        }
        attributes = {"format": self.FORMAT, "parameter": self.parameter, "unit": self.unit, "frame": self.frame}
        return Contents(variables, attributes=attributes)

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> "Campbell":
        """The diagram that :meth:`to_xarray` turned into a dataset."""
        arrays = {name: dataset[name].values for name in ("values", "speeds", "real", "imaginary", "whirl", "growth")}
        roots = arrays["real"] + 1j * arrays["imaginary"]
        facts = dataset.attrs
        fields = arrays["values"], arrays["speeds"], roots, arrays["whirl"], arrays["growth"]
        return cls(str(facts["parameter"]), str(facts["unit"]), *fields, str(facts["frame"]))


def direction(whirl: float) -> str:
    """Return the direction of a whirl in words; empty for a motion along a line."""
    return "" if abs(whirl) <= _LINE else "forward" if whirl > 0.0 else "backward"


def followed(modes: Sequence[SpeedModes], count: int | None) -> tuple[np.ndarray, np.ndarray]:
    """Return roots and whirl (speeds, modes) with each mode in one column, followed from the highest speed down. Modes
    of neighbouring speeds are paired by their shapes and their roots: 1 - MAC plus the relative distance of the roots.
    At the highest speed they are in the order of their frequencies.
    """
    from scipy.optimize import linear_sum_assignment  # mechanisms that do not rotate start without it

    order = np.argsort([-mode.speed for mode in modes], kind="stable")
    first = modes[order[0]]
    columns = list(range(len(first.roots)))[:count]
    width = len(columns)
    roots = np.full((len(modes), width), np.nan, dtype=complex)
    whirl = np.full((len(modes), width), np.nan)
    known_roots, known_shapes, known_whirl = (mode[..., columns] for mode in (first.roots, first.shapes, first.whirl))
    roots[order[0]], whirl[order[0]] = known_roots, known_whirl
    for row in order[1:]:
        mode = modes[row]
        # How unlike modes are, (known modes, modes).
        sizes = np.linalg.norm(known_shapes, axis=0)[:, None] * np.linalg.norm(mode.shapes, axis=0)
        alike = (np.abs(known_shapes.conj().T @ mode.shapes) / np.where(sizes > 0.0, sizes, 1.0)) ** 2
        apart = np.abs(known_roots[:, None] - mode.roots) / np.maximum(np.abs(known_roots)[:, None], np.abs(mode.roots))
        cost = (1.0 - alike) + apart + 0.5 * np.abs(known_whirl[:, None] - mode.whirl)
        for column, other in zip(*linear_sum_assignment(cost), strict=True):
            roots[row, column], whirl[row, column] = mode.roots[other], mode.whirl[other]
            known_roots[column], known_shapes[:, column] = mode.roots[other], mode.shapes[:, other]
            known_whirl[column] = mode.whirl[other]
    return roots, whirl
