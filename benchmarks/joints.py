"""Joints: rates of constraints and constraint forces by automatic differentiation, beside formulas by hand."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

import dalembert as da
from benchmarks import timing
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.planar import pairs
from dalembert.multibody.components.planar.markers import direction, spin, spin_rate
from dalembert.multibody.components.planar.prismatic_joint import PRISMATIC
from dalembert.multibody.components.planar.revolute_joint import REVOLUTE
from dalembert.multibody.kernels.block_table import BlockModel, Blocks
from dalembert.multibody.kernels.elementary import sin_cos
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.reduction import reduction
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower

COUNT = 500  # joints that one call of a kernel loops over
CALLS = 200  # of the kernel, for one reading of the clock


@inlined
def _revolute_rates(x, v, a, p, m, inputs, rate, second):
    rate[0], rate[1] = pairs.separation_rate(x, v, p, m)
    second[0], second[1] = pairs.separation_second(x, v, a, p, m)


@inlined
def _prismatic_rates(x, v, a, p, m, inputs, rate, second):
    dx, dy = pairs.separation(x, p, m)
    ux, uy = pairs.separation_rate(x, v, p, m)
    wx, wy = pairs.separation_second(x, v, a, p, m)
    c, s = direction(m.a_kind, 0, x, p.a_angle + p.axis_angle)
    along, across, along_rate = c * dx + s * dy, c * dy - s * dx, c * ux + s * uy
    own, own_rate = spin(m.a_kind, 0, x, v), spin_rate(m.a_kind, 0, x, v, a)
    rate[0] = c * uy - s * ux - own * along
    second[0] = c * wy - s * wx - 2.0 * own * along_rate - own_rate * along - own * own * across
    sine, cosine = sin_cos(pairs.relative_angle(x, p, m) - p.rest_angle)
    turn = pairs.relative_spin(x, v, m)
    rate[1] = cosine * turn
    second[1] = cosine * pairs.relative_spin_rate(x, v, a, m) - sine * turn * turn


@dataclass(frozen=True, eq=False)
class _ByHand(Kind):
    """A kind with a formula for the rates of its constraints."""

    rates: Callable[..., Any] | None = None

    @cached_property
    def rates_function(self) -> Callable[..., Any]:
        assert self.rates is not None
        return self.rates


def _by_hand(kind: Kind, rates: Callable[..., Any]) -> Kind:
    given = {entry.name: getattr(kind, entry.name) for entry in fields(kind) if entry.init}
    return _ByHand(**given | {"name": f"{kind.name}_by_hand"}, rates=rates)


#: Joint, its kind, and a formula for its rates.
JOINTS = {
    "revolute": (da.RevoluteJoint, REVOLUTE, _revolute_rates),
    "prismatic": (da.PrismaticJoint, PRISMATIC, _prismatic_rates),
}


def main() -> list[dict[str, object]]:
    rows = []
    for place, bodies in {"rigid bodies": _rigid_bodies, "beams": _beams}.items():
        for name, (joint, kind, rates) in JOINTS.items():
            chain, by_hand = _chain(bodies, joint), _by_hand(kind, rates)
            automatic = replace(kind, name=f"{name}_automatic", forces=None)
            rows += [
                _row(
                    f"{name}, {place}: first and second rates", *(_Rates(chain, own, kind) for own in (by_hand, kind))
                ),
                _row(f"{name}, {place}: constraint forces", *(_Forces(chain, own, kind) for own in (kind, automatic))),
                _row(f"{name}, {place}: their tangent", *(_Tangent(chain, own, kind) for own in (kind, automatic))),
            ]
    timing.report("joints", "Joints by formulas and by automatic differentiation (nanoseconds a joint)", rows)
    return rows


def _chain(bodies: Callable[[da.System, np.ndarray], list[tuple[Any, Any]]], joint: type) -> Lowered:
    """Bodies anywhere, each joined to the next; the joints need not be closed."""
    system = da.System(gravity=(0.0, 0.0))
    points = bodies(system, np.random.default_rng(0).normal(size=(COUNT + 1, 3)))
    for k, ((_, end), (start, _)) in enumerate(pairwise(points)):
        system.add(joint(f"joint{k}", end, start))
    return lower(system)


def _rigid_bodies(system: da.System, places: np.ndarray) -> list[tuple[Any, Any]]:
    """Two points of each rigid body, off its centre."""
    ends = {"start": (0.3, 0.1), "end": (-0.2, 0.4)}
    bodies = [
        system.add(da.RigidBody(f"body{k}", 1.0, 0.1, position=(x, y), angle=angle, points=ends))
        for k, (x, y, angle) in enumerate(places)
    ]
    return [(body.point("start"), body.point("end")) for body in bodies]


def _beams(system: da.System, places: np.ndarray) -> list[tuple[Any, Any]]:
    """Both ends of beams of one element."""
    section = {"poisson_ratio": 0.3, "density": 900.0, "height": 0.1, "width": 0.05}
    bodies = [
        system.add(da.AncfBeam(f"beam{k}", 1.0, 1, 2e5, start=(x, y), angle=angle, **section))
        for k, (x, y, angle) in enumerate(places)
    ]
    return [(body.start, body.end) for body in bodies]


class _Kernel:
    """Calls of a kernel of ``kind``, for the joints of a chain that are of the kind ``place``."""

    role, dtype = "residual", float

    def __init__(self, chain: Lowered, kind: Kind, place: Kind) -> None:
        whole = chain.model(self.dtype)
        kept = whole.blocks.index, whole.blocks.integers, whole.blocks.numbers
        blocks = Blocks(*({kind: columns[place]} for columns in kept))
        rows = reduction(blocks.index, whole.coordinates, whole.size)
        self.model = BlockModel(blocks, whole.signals, whole.callbacks, whole.size, whole.coordinates, self.dtype, rows)
        self.state = np.random.default_rng(1).normal(size=(3, whole.size + 1))
        self.state[:, -1] = 0.0
        slots, entries, _ = chain.structure.full.separate
        self.slots = [slots[list(whole.blocks.index).index(place)]]
        self.out = np.zeros((2, max(whole.size + 1, len(entries))))
        self.call = self.model.call().set(**dict(zip("xva", self.state, strict=True)), **self.arguments())
        self.model.need(self.role)

    def __call__(self) -> None:
        for _ in range(CALLS):
            self.model.each(self.role, self.call, self.slots)

    def answer(self) -> np.ndarray:
        """What one call computes."""
        self.out.fill(0.0)
        self.model.each(self.role, self.call, self.slots)
        return self.out.copy()

    def arguments(self) -> dict[str, Any]:
        raise NotImplementedError


class _Rates(_Kernel):
    role = "rates"

    def arguments(self) -> dict[str, Any]:
        return {"rate": self.out[0], "second": self.out[1]}


class _Forces(_Kernel):
    def arguments(self) -> dict[str, Any]:
        return {"r": self.out[0]}


class _Tangent(_Kernel):
    """By dual numbers, with the formula of the forces or without."""

    role = "tangent"

    def arguments(self) -> dict[str, Any]:
        factors = {"by_x": 1.0, "by_v": 0.0, "by_a": 0.0, "motion": 1.0, "constraint": 1.0}
        return {"matrix": self.out[0], "entries": self.out.shape[1], **factors}


def _row(what: str, formula: _Kernel, automatic: _Kernel) -> dict[str, object]:
    """Nanoseconds a joint of both, and by how much their answers differ, relative to the largest."""
    first, second = formula.answer(), automatic.answer()
    times = timing.interleaved({"formula": formula, "automatic": automatic})
    a, b = (times[name] / (CALLS * COUNT) * 1e9 for name in ("formula", "automatic"))
    difference = float(np.abs(first - second).max() / np.abs(first).max())
    return {"what": what, "formula": a, "automatic": b, "automatic / formula": b / a, "difference": difference}


if __name__ == "__main__":
    main()
