"""Paths of equilibria as results: critical points, findings, tables and files."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from dalembert.argument_readers import names_of
from dalembert.contents import Contents
from dalembert.errors import InputError, require_known
from dalembert.findings import Finding
from dalembert.multibody.model.drawing import Drawing, draw
from dalembert.multibody.model.lowering import lower
from dalembert.multibody.model.observe import observer
from dalembert.multibody.model.system import BaseSystem
from dalembert.results import Result
from dalembert.tables import Table, counted, labelled, shown

if TYPE_CHECKING:
    from xarray import Dataset

Build = Callable[[float], BaseSystem]
LIMIT, BRANCH, SYMMETRIC_PART = "limit", "branch", "symmetric part"
END, POINTS, AWAY, LOST = "end", "points", "away", "lost"
MOST_FACTS = 3
"""Critical loads among the facts."""


@dataclass(frozen=True, eq=False)
class CriticalPoint:
    """An equilibrium at which the stiffness against a motion vanishes.

    Parameters
    ----------
    load : float
    kind : {"limit", "branch", "symmetric part"}
        At a limit point the load turns; at a branch point other equilibria begin: the structure buckles. Where the
        stiffness is not symmetric, as under follower loads, the eigenvalue is that of its symmetric part, and the point
        need be neither.
    x : array, shape (N + 1,)
        As of an :class:`Equilibrium`.
    shape : array, shape (N + 1,)
        The motion without stiffness; its entry of largest magnitude is 1. Rows of multipliers are zero.
    gap : float
        Distance of the two loads between which the point lies, where the search for it failed; else 0.
    after : int
        Number of the point of the path before it, from 0 on.
    """

    load: float
    kind: str
    x: np.ndarray
    shape: np.ndarray
    gap: float = 0.0
    after: int = 0

    @property
    def name(self) -> str:
        """The kind in words."""
        return "symmetric-part point" if self.kind == SYMMETRIC_PART else f"{self.kind} point"


class PathLine(NamedTuple):
    """A path with its critical points among the others, in its order.

    ``loads`` (nodes,), ``x`` (nodes, N + 1), ``values`` (nodes, channels); ``stable`` (nodes - 1,): whether the
    equilibria from a node to the next one are; ``critical`` (critical points,): their numbers among the nodes.
    """

    loads: np.ndarray
    x: np.ndarray
    values: np.ndarray
    stable: np.ndarray
    critical: np.ndarray


@dataclass(frozen=True, eq=False)
class EquilibriumPath(Result):
    """Equilibria along a load, as :func:`equilibrium_path` returns them.

    Parameters
    ----------
    loads : array, shape (points,)
    stable : array of bool, shape (points,)
        Whether every motion that the joints leave free has a positive stiffness.
    critical : tuple of CriticalPoint
        In the order of the path.
    x : array, shape (points, N + 1)
        States, as of an :class:`Equilibrium`.
    ended : {"end", "points", "away", "lost"}
        Why the path ends: the load reached ``end``; there are ``most_points``; the load went away from ``end`` by more
        than twice the range; no equilibrium was found beyond the last one.
    end : float
        The load that the path was to reach.
    parameter, unit : str
        Name and unit of the load.
    names, units : tuple of str
        Channels that the result keeps, and their units.
    values : array, shape (points, channels)
        Their values.
    critical_values : array, shape (critical points, channels)
        Their values at the critical points.
    build : callable, optional
        From the load to the system; a path that was read from a file has none.
    """

    FORMAT: ClassVar[str] = "dalembert path of equilibria 1"
    TITLE: ClassVar[str] = "Path of equilibria"

    loads: np.ndarray
    stable: np.ndarray
    critical: tuple[CriticalPoint, ...]
    x: np.ndarray
    ended: str
    end: float
    parameter: str
    unit: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    values: np.ndarray
    critical_values: np.ndarray
    build: Build | None = None

    def channels(self, names: Sequence[str]) -> np.ndarray:
        """Values of channels along the path, (points, channels).

        Raises
        ------
        InputError
            For an unknown channel, and for one that a path from a file does not keep.
        """
        names = names_of(names, "EquilibriumPath", "channels")
        if self.build is not None:
            return observed(self.build, names, self.loads, self.x)
        for name in names:
            require_known("channel", name, self.names, "EquilibriumPath")
        return self.values[:, [self.names.index(name) for name in names]]

    @cached_property
    def line(self) -> PathLine:
        """The path with its critical points among the others."""
        after = np.array([point.after for point in self.critical], dtype=int)
        at = after + 1
        loads = np.insert(self.loads, at, [point.load for point in self.critical])
        x, values = self.x, self.values
        if len(at):
            x = np.insert(x, at, [point.x for point in self.critical], axis=0)
            values = np.insert(values, at, self.critical_values, axis=0)
        stable: list[bool] = []
        for first, (here, following) in enumerate(zip(self.stable[:-1], self.stable[1:], strict=True)):
            inner = int(np.count_nonzero(after == first))
            # The stability changes at the first critical point on the way to unstable equilibria, at the last one back.
            unstable = [bool(here and following)] * (inner - 1)
            stable += [bool(here), *unstable, bool(following)] if inner else [bool(here and following)]
        return PathLine(loads, x, values, np.array(stable, dtype=bool), at + np.arange(len(at)))

    def drawing(self, rows: Sequence[int] | np.ndarray, points: int = 8) -> Drawing:
        """Lines of the bodies and places of the joints at some nodes of the :attr:`line`, one frame each.

        Parameters
        ----------
        rows : sequence of int
            Numbers of the nodes.
        points : int
            Of a line, or of each element of a flexible body.

        Returns
        -------
        Drawing
            Its times are the numbers of the nodes.

        Raises
        ------
        InputError
            For a path without a function ``build``.
        """
        if self.build is None:
            raise InputError(
                "EquilibriumPath: a path that was read from a file has no model to draw. Give it its function: "
                "dataclasses.replace(path, build=build)"
            )
        frames = []
        for row in rows:
            system = self.build(float(self.line.loads[row]))
            frames.append(draw(system, lower(system), np.array([float(row)]), self.line.x[row][None], points))
        return _joined(frames)

    @property
    def findings(self) -> tuple[Finding, ...]:  # type: ignore[override]
        """Where the path ends early, unstable equilibria, and critical points that are not exact."""
        return (*self._end_findings(), *self._unstable_findings(), *self._point_findings())

    def _end_findings(self) -> list[Finding]:
        last = float(self.loads[-1])
        values = {"load": last, "end": self.end, "points": len(self.loads), "ended": self.ended}
        if self.ended == POINTS:
            sentence = f"The path ends after {counted(len(self.loads))} points at {self._of(last)}, before "
            advice = "Increase most_points, or take fewer steps."
        elif self.ended == AWAY:
            sentence = f"The load went away from its end: the path stops at {self._of(last)} and does not reach "
            advice = "Choose an end below the critical load, or begin at a load from which the path leads there."
        elif self.ended == LOST:
            sentence = f"No equilibrium was found beyond {self._of(last)}: the path stops before "
            advice = "Another path may cross it there. Take a wider range or more steps, or add an imperfection."
        else:
            return []
        return [Finding("path-incomplete", "warning", values, f"{sentence}{self._of(self.end)}.", advice)]

    def _unstable_findings(self) -> list[Finding]:
        unstable = np.flatnonzero(~self.stable)
        if not len(unstable):
            return []
        row = int(unstable[0])
        first = next((point.load for point in self.critical if point.after == row - 1), float(self.loads[row]))
        return [
            Finding(
                "unstable-equilibria",
                "note",
                {"points": len(unstable), "load": float(first)},
                f"{counted(len(unstable))} of {counted(len(self.stable))} equilibria are unstable, the first of them "
                f"from {self._of(float(first))} on.",
                "A mechanism does not stay there: the smallest push moves it to another equilibrium.",
            )
        ]

    def _point_findings(self) -> list[Finding]:
        findings = []
        if rough := [point for point in self.critical if point.gap > 0.0]:
            worst = max(rough, key=lambda point: point.gap)
            findings.append(
                Finding(
                    "critical-point-gap",
                    "warning",
                    {"points": len(rough), "load": worst.load, "gap": worst.gap},
                    f"The critical point near {self._of(worst.load)} is known only to {self._of(worst.gap)}.",
                    "Take more steps, or add an imperfection if paths cross there.",
                )
            )
        if any(point.kind == SYMMETRIC_PART for point in self.critical):
            first = next(point.load for point in self.critical if point.kind == SYMMETRIC_PART)
            findings.append(
                Finding(
                    "follower-loads",
                    "warning",
                    {"load": first},
                    "Loads follow the motion, so the stiffness is not symmetric. Stability is judged by its symmetric "
                    "part: the mechanism may be stable beyond a critical point, and flutter is not seen.",
                    "Compute the modes about an equilibrium to see whether a motion grows.",
                )
            )
        return findings

    @property
    def success(self) -> bool:
        """Whether the path reached its end."""
        return self.ended == END

    @property
    def status(self) -> str:
        """What was computed, in a sentence."""
        ends = f"{self._of(float(self.loads[0]))} to {self._of(float(self.loads[-1]))}"
        kinds = [point.name for point in self.critical]
        counts = [
            f"{counted(kinds.count(kind))} {kind}{'s' * (kinds.count(kind) > 1)}" for kind in dict.fromkeys(kinds)
        ]
        critical = ", with " + " and ".join(counts) if counts else ", without critical points"
        return f"{counted(len(self.loads))} equilibria along {self.parameter}, from {ends}{critical}."

    def facts(self) -> dict[str, str]:
        few = self.critical[:MOST_FACTS]
        critical = {f"{point.name} {number}": self._of(point.load) for number, point in enumerate(few, start=1)}
        return {
            "equilibria": counted(len(self.loads)),
            "largest load": self._of(float(max(self.line.loads, key=abs))),
            **critical,
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the critical points, if there are any, and all equilibria."""
        load = labelled(self.parameter, self.unit)
        names = [labelled(name, unit) for name, unit in zip(self.names, self.units, strict=True)]
        critical = []
        if self.critical:
            caption = "Critical points: a motion has no stiffness. At a limit point the load turns. At a branch point "
            columns = {load: [point.load for point in self.critical], "kind": [point.name for point in self.critical]}
            columns |= zip(names, self.critical_values.T, strict=True)
            critical = [Table.of("critical-points", f"{caption}other equilibria begin.", columns)]
        columns = {load: self.loads, "stable": ["yes" if stable else "no" for stable in self.stable]}
        columns |= zip(names, self.values.T, strict=True)
        return (*critical, Table.of("equilibria", "Equilibria along the path", columns, detail=True))

    def contents(self) -> Contents:
        over, at = ("point", "critical"), self.critical
        width = self.x.shape[1]
        variables = {
            "loads": (over[:1], self.loads, {"units": self.unit}),
            "stable": (over[:1], self.stable),
            "x": (("point", "unknown"), self.x),
            "values": (("point", "channel"), self.values),
            "critical_loads": (over[1:], np.array([point.load for point in at]), {"units": self.unit}),
            "critical_kinds": (over[1:], np.array([point.kind for point in at], dtype=str)),
            "critical_gaps": (over[1:], np.array([point.gap for point in at]), {"units": self.unit}),
            "critical_after": (over[1:], np.array([point.after for point in at], dtype=int)),
            "critical_x": (("critical", "unknown"), np.array([point.x for point in at]).reshape(-1, width)),
            "critical_shapes": (("critical", "unknown"), np.array([point.shape for point in at]).reshape(-1, width)),
            "critical_values": (("critical", "channel"), self.critical_values),
        }
        coordinates = {"channel": ("channel", list(self.names)), "channel_unit": ("channel", list(self.units))}
        attributes = {"format": self.FORMAT, "parameter": self.parameter, "unit": self.unit}
        return Contents(variables, coordinates, attributes | {"ended": self.ended, "end": self.end})

    @classmethod
    def from_xarray(cls, dataset: "Dataset") -> "EquilibriumPath":
        """The path that :meth:`to_xarray` turned into a dataset, without its function ``build``."""
        facts, arrays = dataset.attrs, {str(name): variable.values for name, variable in dataset.variables.items()}
        columns = [arrays[f"critical_{name}"] for name in ("loads", "kinds", "x", "shapes", "gaps", "after")]
        critical = tuple(
            CriticalPoint(float(load), str(kind), x, shape, float(gap), int(after))
            for load, kind, x, shape, gap, after in zip(*columns, strict=True)
        )
        names, units = (tuple(map(str, arrays[name])) for name in ("channel", "channel_unit"))
        return cls(
            arrays["loads"], arrays["stable"].astype(bool), critical, arrays["x"], str(facts["ended"]),
            float(facts["end"]), str(facts["parameter"]), str(facts["unit"]), names, units, arrays["values"],
            arrays["critical_values"],
        )  # fmt: skip

    def _of(self, load: float) -> str:
        """A load with its unit."""
        return f"{shown(load)} {self.unit}".rstrip()


def observed(
    build: Build, names: Sequence[str], loads: np.ndarray, x: np.ndarray, near: np.ndarray | None = None
) -> np.ndarray:
    """Return values of channels at equilibria (points, N + 1), each of the system at its load, (points, channels).

    Angles have the whole turns that bring them next to those of the point before, or next to ``near`` (points,
    channels).
    """
    values = np.zeros((len(loads), len(names)))
    angles: list[int] = []
    for row, load in enumerate(loads if names else ()):
        system, still = build(float(load)), np.zeros((1, x.shape[1]))
        lowered = lower(system)
        readers = observer(system, lowered, names)
        angles = [column for column, own in enumerate(readers.rows) if own.angle is not None]
        values[row] = readers.read(lowered, lowered.real, (x[row][None], still, still), np.zeros(1))[0]
    if near is None:
        values[:, angles] = np.unwrap(values[:, angles], axis=0)
    else:
        turn = 2.0 * np.pi
        values[:, angles] += turn * np.round((near[:, angles] - values[:, angles]) / turn)
    return values


def _joined(drawings: Sequence[Drawing]) -> Drawing:
    """Drawings of one frame each as the frames of one; what does not deform is that of the first."""

    def frames(field: str) -> dict[str, np.ndarray]:
        parts = [getattr(drawing, field) for drawing in drawings]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    surfaces = {}
    for name, surface in drawings[0].surfaces.items():
        if surface.corners.ndim == 3:
            parts = [drawing.surfaces[name] for drawing in drawings]
            strains = None if surface.strains is None else np.concatenate([part.strains for part in parts])
            surface = surface._replace(corners=np.concatenate([part.corners for part in parts]), strains=strains)
        surfaces[name] = surface
    times = np.concatenate([drawing.times for drawing in drawings])
    return Drawing(times, frames("lines"), frames("joints"), frames("axes"), surfaces, drawings[0].ground)
