"""From a system of components to the arrays of the kernels.

What depends only on the kinds and connections of components is a `Structure`, found once and shared by all samples of
an ensemble; what depends on numbers is in `Lowered`.
"""

from collections.abc import Callable, Mapping, Sequence, ValuesView
from typing import Any

import numpy as np

from dalembert.errors import InputError, ModelError, shown
from dalembert.multibody.callbacks import Callback, Failures, force_callback, signal_callback
from dalembert.multibody.carried_rates import carried_rates
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.lowering import Pair
from dalembert.multibody.components.planar import markers
from dalembert.multibody.components.planar.body import Body, Marker
from dalembert.multibody.components.points import Ground, GroundPoint, Place, Point, Side
from dalembert.multibody.components.signals import Course, Custom, Signal, as_signal
from dalembert.multibody.kernels import signals as signal_kinds
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.lowered import Lowered
from dalembert.multibody.structure import Structure
from dalembert.multibody.system import System

_ABSENT = -1
_ROUNDING = 1e-14  # relative, of differences of times


class SystemLowering:
    """Collects the rows of the kernels while the components write them."""

    def __init__(self, system: System, begin: float = 0.0) -> None:
        self.gravity = system.gravity
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
        self._bodies: dict[str, Body] = {}
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

    def callback(self, function: Callable[..., Any], owner: str) -> int:
        """Number of a force function of the user's."""
        self._callbacks.append(force_callback(function, owner, self._failures))
        return len(self._callbacks) - 1

    def pair(self, a: Side, b: Side | None, owner: str) -> Pair:
        """The markers of two sides; a bare ground stands where the other side is."""
        if not isinstance(a, Point) and not isinstance(b, Point):
            raise ModelError(f"{owner!r}: it acts on the ground only; give it a point of a body")
        if isinstance(a, Point) and isinstance(b, Point) and a.body is b.body and a.body.rigid:
            raise ModelError(
                f"{owner!r}: both its points, {a} and {b}, belong to the same rigid body, so it does nothing; "
                "give it points of two bodies, or of a body and the ground"
            )
        first = self._stand(b if isinstance(a, Ground) and b is not None else a, owner)
        second = self._stand(a if b is None or isinstance(b, Ground) else b, owner)
        sides = self._marker(a, owner, first), self._marker(b or Ground(), owner, second)
        dx, dy = second[0] - first[0], second[1] - first[1]
        square = dx * dx + dy * dy
        c, s = np.cos(first[2]), np.sin(first[2])
        return Pair(
            slots=[*sides[0].slots, *sides[1].slots],
            data=[*sides[0].data, *sides[1].data],
            integers=[sides[0].kind, sides[1].kind, int(markers.NODE in (sides[0].kind, sides[1].kind))],
            distance=np.sqrt(square) if np.real(square) > 0 else 0.0,
            rest_angle=second[2] - first[2],
            angles=(first[2], second[2]),
            relative=(c * dx + s * dy, c * dy - s * dx),
        )

    # -- placing --------------------------------------------------------------------------------------------------

    def _stand(self, side: Side | Place, owner: str) -> tuple[Number, Number, Number]:
        """Position and angle of a side at first."""
        if isinstance(side, GroundPoint):
            return side.x, side.y, side.angle
        if isinstance(side, Ground):
            return 0.0, 0.0, 0.0
        if isinstance(side, Point):
            marker = self._known(side, owner)
            return _stand(marker, self._coordinates[side.body.name])
        return side[0], side[1], 0.0

    def _known(self, point: Point, owner: str) -> Marker:
        if self._bodies.get(point.body.name) is not point.body:
            raise ModelError(
                f"{owner!r}: its point {point} belongs to a body that is not in the system (or not yet); "
                f"add {point.body.name!r} first"
            )
        return point.body.marker(point.name)

    def _marker(self, side: Side, owner: str, stand: tuple[Number, Number, Number]) -> Marker:
        if isinstance(side, Point):
            marker = self._known(side, owner)
            first = self._first[side.body.name]
            return marker._replace(slots=tuple(None if k is None else first + k for k in marker.slots))
        place = (*stand[:2], 0.0) if isinstance(side, Ground) else (side.x, side.y, side.angle)
        return Marker(markers.GROUND, (None,) * 4, place)

    def _refuse_infinite(self) -> None:
        """Raise for the first number of a component that is not finite."""
        system = self._system
        components = (*system.bodies, *system.joints, *system.loads)
        parts = [("system", system), *((f"{type(part).__name__} {part.name!r}", part) for part in components)]
        for owner, part in parts:
            for name, value in vars(part).items():
                numbers = value.lower()[1] if isinstance(value, Signal) else value
                if not _finite(list(vars(value).values()) if isinstance(value, GroundPoint) else numbers):
                    raise ModelError(f"{owner}: {name} is {value}; expected finite numbers")

    def _since(self, time: float) -> float:
        """Time from the start of the motion; zero where the two differ by rounding alone."""
        since = time - self._begin
        return since if abs(since) > _ROUNDING * abs(self._begin) else 0.0

    def run(self) -> Lowered:
        """Place the bodies, let every component write its rows, and pack them."""
        system = self._system
        frames, kinds = [], []
        for body in system.bodies:
            x, y, _ = self._stand(body.place, body.name)
            self._bodies[body.name] = body
            self._first[body.name] = len(self._owners)
            self._owners += [body.name] * body.size
            own = body.coordinates(x, y, body.turn)
            self._coordinates[body.name] = own
            frames.append(np.array([x, y, body.turn]))
            kinds += body.coordinate_kinds
        n = len(self._owners)
        if n == 0:
            raise ModelError("the system has no body; add one")
        for body in system.bodies:
            self._component = body.name
            body.lower(self, self._first[body.name])
        for component in (*system.joints, *system.loads):
            self._component = component.name
            component.lower(self)
        size = len(self._owners)
        tail = np.zeros(size + 1 - n)
        places = list(self._coordinates.values())
        x = np.concatenate([*places, tail])
        modes = [body.rigid_modes(*place) for body, *place in zip(system.bodies, places, frames, strict=True)]
        chosen = np.array([[0.0 if value is None else value for value in body.motion] for body in system.bodies])
        rates = carried_rates(system.bodies, places, modes, chosen[:, :, None])[:, :, 0]
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
            stated=np.array([[value is not None for value in body.motion] for body in system.bodies]),
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


def lower(system: System, begin: float = 0.0) -> Lowered:
    """Arrays of a system, with its bodies as placed; its motion starts at the time ``begin`` (s) of its signals.

    Raises
    ------
    InputError
        For what is no System.
    """
    if not isinstance(system, System):
        own = "; give its system, in which the bodies are placed as they begin" if hasattr(system, "system") else ""
        raise InputError(f"{shown(system)} was given as the mechanism; expected a System{own}")
    return SystemLowering(system, begin).run()


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


def _stand(marker: Marker, coordinates: np.ndarray) -> tuple[Number, Number, Number]:
    """Position and angle of a marker of undeformed coordinates."""
    own = [coordinates[k] if k is not None else 0.0 for k in marker.slots]
    sx, sy, phi = marker.data
    if marker.kind == markers.RIGID:
        c, s = np.cos(own[2]), np.sin(own[2])
        return own[0] + c * sx - s * sy, own[1] + s * sx + c * sy, own[2]
    if marker.kind == markers.NODE:
        real = np.arctan2(np.real(own[3]), np.real(own[2]))
        # First-order imaginary part: the gradient has length one here.
        turn = np.imag(own[3]) * np.real(own[2]) - np.imag(own[2]) * np.real(own[3])
        return own[0], own[1], (real + 1j * turn if np.iscomplexobj(coordinates) else real) + phi
    return own[0], own[1], 0.0
