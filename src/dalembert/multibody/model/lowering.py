"""From a system of components to the arrays of the kernels.

What depends only on the kinds and connections of components is a `Structure`, found once and shared by all samples of
an ensemble; what depends on numbers is in `Lowered`.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence, ValuesView
from dataclasses import is_dataclass
from importlib import import_module
from typing import Any

import numpy as np

from dalembert.errors import InputError, ModelError, shown
from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.points import Ground, Point
from dalembert.multibody.components.signals import Course, Custom, Signal, as_signal
from dalembert.multibody.kernels import signal_values as signal_kinds
from dalembert.multibody.kernels.callbacks import Callback, Failures, Sizes, force_callback, signal_callback
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.model.carried_rates import carried_rates
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.structure import Structure
from dalembert.multibody.model.system import BaseSystem

_ABSENT = -1
_ROUNDING = 1e-14  # relative, of differences of times


class MechanismLowering(ABC):
    """Collects the rows of the kernels while the components write them."""

    def __init__(self, system: BaseSystem, begin: float = 0.0) -> None:
        self.gravity, self.loads = system.gravity, system.loads
        self.kinks: list[tuple[float, str]] = []
        self._system = system
        self._written: dict[Kind, list[tuple]] = {}  # index, integers, numbers and component of each row
        self._rows: dict[str, tuple[Kind, int]] = {}
        self._signals: list[tuple[int, int, int, int]] = [(signal_kinds.TIME, 0, 0, 0)]
        self._begin = float(begin)
        self._signal_data = [np.array([self._begin])]  # parts of an array
        self._knots = [np.zeros(1)]
        self._callbacks: list[Callback] = []
        self._jumps: set[float] = set()
        self._changes: set[float] = set()
        self._owners: list[str] = []
        self._component = ""  # that writes its rows
        self._failures = Failures()
        self._bodies: dict[str, BaseBody] = {}
        self._frames: dict[str, np.ndarray] = {}
        self._coordinates: dict[str, np.ndarray] = {}
        self._first: dict[str, int] = {}

    # -- what components call ------------------------------------------------------------------------------------

    def add(
        self,
        kind: Kind,
        index: Sequence[int | None],
        numbers: Sequence[Number],
        integers: Sequence[int] = (),
        name: str = "",
    ) -> None:
        """One component of a kind; a ``name`` gives it channels."""
        if (len(index), len(numbers), len(integers)) != (kind.width, len(kind.numbers), len(kind.integers)):
            raise ModelError(
                f"kind {kind.name!r}: a component has {len(index)} unknowns, {len(numbers)} numbers and "
                f"{len(integers)} integers; the kind declares {kind.width}, {len(kind.numbers)} and "
                f"{len(kind.integers)}. Correct its 'lower'"
            )
        rows = self._written.setdefault(kind, [])
        if name:
            self._rows[name] = (kind, len(rows))
        rows.append(([_ABSENT if entry is None else entry for entry in index], integers, numbers, self._component))

    def add_many(self, kind: Kind, index: np.ndarray, numbers: Sequence[Number]) -> None:
        """Components of a kind, index (count, width), that share their numbers."""
        rows = self._written.setdefault(kind, [])
        rows.extend((entry, (), numbers, self._component) for entry in index.tolist())

    def multipliers(self, owner: str, count: int) -> list[int | None]:
        """Unknowns of ``count`` constraints of a joint."""
        first = len(self._owners)
        self._owners += [owner] * count
        return list(range(first, first + count))

    def signal(self, course: Course) -> int:
        """Number of a function of time."""
        signal = as_signal(course)
        kind, data, knots = signal.lower()
        first = len(self._callbacks) if kind == signal_kinds.CUSTOM else sum(map(len, self._signal_data))
        if isinstance(signal, Custom):
            functions = signal.function, signal.rate, signal.second
            self._callbacks.append(signal_callback(*functions, self._component, self._failures))
        self._signals.append((kind, first, len(data), sum(map(len, self._knots))))
        self._signal_data.append(np.asarray(data))
        self._knots.append(np.asarray(knots))
        (self._changes if signal.steps else self._jumps).update(signal.jumps)
        return len(self._signals) - 1

    def callback(self, function: Callable[..., Any], owner: str, sizes: Sizes) -> int:
        """Number of a force function of the user's."""
        self._callbacks.append(force_callback(function, owner, self._failures, sizes))
        return len(self._callbacks) - 1

    def coordinate(self, body: BaseBody) -> tuple[int, Number]:
        """Number of the coordinate that a component needs, and its value as the bodies are placed."""
        return self._first[body.name], self._coordinates[body.name][0]

    # -- placing --------------------------------------------------------------------------------------------------

    @abstractmethod
    def frame(self, body: BaseBody) -> np.ndarray:
        """Initial frame of a body; those that it is placed at are known already."""

    def _ends(self, a: Any, b: Any, owner: str) -> list[tuple[Any, Any]]:
        """Both sides, each with the marker of a point as its body numbers it, or with None."""
        if not isinstance(a, Point) and not isinstance(b, Point):
            raise ModelError(f"{owner!r}: it acts on the ground only; give it a point of a body")
        if isinstance(a, Point) and isinstance(b, Point) and a.body is b.body and a.body.rigid:
            raise ModelError(
                f"{owner!r}: both its points, {a} and {b}, belong to the same rigid body, so it does nothing; "
                "give it points of two bodies, or of a body and the ground"
            )
        return [(side, self._known(side, owner) if isinstance(side, Point) else None) for side in (a, b or Ground())]

    def _known(self, point: Point, owner: str) -> Any:
        if self._bodies.get(point.body.name) is not point.body:
            raise ModelError(
                f"{owner!r}: its point {point} belongs to a body that is not in the system (or not yet); "
                f"add {point.body.name!r} first"
            )
        return point.body.marker(point.name)

    def _refuse_infinite(self) -> None:
        """Raise for the first number of a component that is not finite."""
        system = self._system
        components = (*system.bodies, *system.joints, *system.loads)
        parts = [("system", system), *((f"{type(part).__name__} {part.name!r}", part) for part in components)]
        for owner, part in parts:
            for name, value in vars(part).items():
                numbers = value.lower()[1] if isinstance(value, Signal) else value
                if not _finite(
                    list(vars(value).values()) if is_dataclass(value) and not isinstance(value, Signal) else numbers
                ):
                    raise ModelError(f"{owner}: {name} is {value}; expected finite numbers")

    def _refuse_unnamed_rows(self) -> None:
        """Raise for a joint without the row by which its forces and its place are known."""
        for joint in self._system.joints:
            if joint.name not in self._rows:
                raise ModelError(
                    f"joint {joint.name!r}: its 'lower' adds no row of the joint's name. Call lowering.add with "
                    "name=self.name"
                )

    def _since(self, time: float) -> float:
        """Time from the start of the motion; zero where the two differ by rounding alone."""
        since = time - self._begin
        return since if abs(since) > _ROUNDING * abs(self._begin) else 0.0

    def run(self) -> Lowered:
        """Place the bodies, let every component write its rows, and pack them."""
        system = self._system
        bodies = system.carriers
        kinds, motions, modes = [], [], []
        for body in bodies:
            frame = self._frames[body.name] = self.frame(body)
            motions.append(body.motion)
            self._bodies[body.name] = body
            self._first[body.name] = len(self._owners)
            coordinate_kinds = body.coordinate_kinds
            self._owners += [body.name] * len(coordinate_kinds)
            place = self._coordinates[body.name] = body.placed(frame)
            modes.append(body.rigid_modes(place, frame))
            kinds += coordinate_kinds
        n = len(self._owners)
        if n == 0:
            raise ModelError("the system has no body; add one")
        for body in bodies:
            self._component = body.name
            body.lower(self, self._first[body.name])
        for component in (*system.joints, *system.loads):
            self._component = component.name
            component.lower(self)
        self._refuse_unnamed_rows()
        size = len(self._owners)
        tail = np.zeros(size + 1 - n)
        frames, places = list(self._frames.values()), list(self._coordinates.values())
        x = np.concatenate([*places, tail])
        chosen = np.array([[0.0 if value is None else value for value in motion] for motion in motions])
        rates = carried_rates(bodies, places, modes, chosen[:, :, None])[:, :, 0]
        velocities = [own @ rate for own, rate in zip(modes, rates, strict=True)]
        columns = {kind: [*zip(*rows, strict=True)] for kind, rows in self._written.items()}
        structure = Structure(
            n=n,
            size=size,
            owners=tuple(self._owners),
            first=dict(self._first),
            kinds=tuple(kinds),
            index={kind: _integers(own[0], kind.width, size) for kind, own in columns.items()},
            meta={kind: _integers(own[1], max(len(kind.integers), 1), 0) for kind, own in columns.items()},
            rows=dict(self._rows),
            signals=np.array(self._signals, dtype=np.int64),
        )
        lowered = Lowered(
            structure=structure,
            bodies=dict(self._bodies),
            data={kind: np.array(own[2]).reshape(len(own[2]), len(kind.numbers)) for kind, own in columns.items()},
            signal_data=np.concatenate(self._signal_data),
            knots=np.concatenate(self._knots),
            callbacks=tuple(self._callbacks),
            frames=np.array(frames),
            rates=chosen,
            stated=np.array([[value is not None for value in motion] for motion in motions]),
            x=x,
            v=np.concatenate([*velocities, tail]),
            jumps=tuple(sorted(self._since(time) for time in self._jumps | self._changes if np.isfinite(time))),
            changes=frozenset(self._since(time) for time in self._changes - self._jumps),
            kinks=tuple((self._since(time), name) for time, name in self.kinks),
            failures=self._failures,
            parts={kind: own[3] for kind, own in columns.items()},
        )
        if not all(np.all(np.isfinite(array)) for array in (x, lowered.v, lowered.signal_data, *lowered.data.values())):
            self._refuse_infinite()
        return lowered


def lower(system: BaseSystem, begin: float = 0.0) -> Lowered:
    """Arrays of a system, with its bodies as placed; its motion starts at the time ``begin`` (s) of its signals."""
    if not isinstance(system, BaseSystem):
        advice = f": {system.INSTEAD}" if hasattr(system, "INSTEAD") else ""
        raise InputError(f"{shown(system)} was given as the mechanism; expected a System{advice}")
    module, _, name = system.LOWERING.rpartition(".")
    return getattr(import_module(module), name)(system, begin).run()


def _finite(value: object) -> bool:
    """Whether all numbers of a field are finite."""
    if isinstance(value, Mapping):
        value = value.values()
    if isinstance(value, tuple | list | np.ndarray | ValuesView):
        return all(map(_finite, value))
    return not isinstance(value, float | complex) or bool(np.isfinite(value))


def _integers(rows: Sequence, width: int, absent: int) -> np.ndarray:
    array = np.zeros((len(rows), width), dtype=np.int64)
    array[:, : len(rows[0])] = rows
    array[array == _ABSENT] = absent
    return array
