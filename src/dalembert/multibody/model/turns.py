"""Whole turns of angles that coordinates leave undetermined, counted in the integration.

An angle a with the rate w at the time t follows the angle a_0 with the rate w_0 at the last end of a step, t_0: of
a + 2 pi k it is the one nearest to a_0 + (t - t_0) (w + w_0)/2. So output times may be turns apart, and within a step
the error of the trapezoidal rule may be almost half a turn. While the angles change slowly, each sixteenth end of
even steps is enough; steps that a method chooses are all visited, as they may be short after an impact. The count is no
unknown: the motion keeps its bits.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.kernels.kernel import BlockKernel, Compiled, inlined
from dalembert.kernels.views import address_of, call, integers, integers2, reals, reals2, record
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.records import BLOCK, BLOCK_SIZE, block_at, call_at
from dalembert.multibody.model.lowered import Lowered

#: ``blocks``: of components with angles, with a kernel in place of ``outputs`` whose values stand at ``offsets``
#: among ``values``. ``columns`` (angles, 2): where angle and rate stand there, -1 for no rate. ``memory`` (angles, 3):
#: angle, rate and whole turns at the last end of a step that was visited, at ``time``; ``begun``: whether one was;
#: ``even``: whether steps are even; ``skip``: how many of their ends need no visit. ``out`` (outputs, angles): turns at
#: output times. ``work``: a call.
#: ``x v now due``: the state to visit, its time, and its number among the outputs, -1 for the end of a step.
TURNS = np.dtype(
    [(name, "i8") for name in "count blocks block_count offsets values width columns memory begun even skip".split()]
    + [(name, "i8") for name in "out outputs work visit x v due".split()]
    + [(name, "f8") for name in ("time", "now")]
)
turns_at = record(TURNS)
_SLOW, _SKIPPED = 0.2, 15  # rad since the last visit below which the next ends of steps are not visited, and how many


def _visit(address, _):
    """Count the turns at a state; the end of a step is the next reference."""
    own = turns_at(address)
    work, offsets = call_at(own.work), integers(own.offsets, own.block_count)
    values, columns = reals(own.values, own.width), integers2(own.columns, own.count, 2)
    memory, out = reals2(own.memory, own.count, 3), reals2(own.out, own.outputs, own.count)
    work.x, work.v, work.a = own.x, own.v, own.v
    for k in range(own.block_count):
        block = own.blocks + k * BLOCK_SIZE
        work.r = own.values + 8 * offsets[k]
        call(block_at(block).outputs, own.work, block)
    span, moved = own.now - own.time, 0.0
    for j in range(own.count):
        angle = values[columns[j, 0]]
        known = columns[j, 1] >= 0
        rate = values[columns[j, 1]] if known else 0.0
        turns = 0.0
        if own.begun == 1:
            moved = max(moved, span * max(abs(rate), abs(memory[j, 1])) if known else _SLOW)
            gap = 0.5 * span * (rate + memory[j, 1]) - (angle - memory[j, 0])
            turns = memory[j, 2] + np.floor(gap / (2.0 * np.pi) + 0.5)
        if own.due >= 0:
            out[own.due, j] = turns
        if own.due < 0 or own.begun == 0:
            memory[j, 0], memory[j, 1], memory[j, 2] = angle, rate, turns
    if own.due < 0 or own.begun == 0:
        own.skip = _SKIPPED if own.even == 1 and own.begun == 1 and moved < _SLOW else 0
        own.time, own.begun = own.now, 1


VISIT = BlockKernel(_visit, "dal_visit_turns")
STEP_END = -1  # in place of the number of an output


@inlined
def count_turns(turns, t, state, due):
    """Count the turns at a state in the integration: an output by its number, or the end of a step."""
    if turns != 0:
        own = turns_at(turns)
        if due == STEP_END and own.skip > 0:
            own.skip -= 1
        else:
            own.x, own.v, own.now, own.due = address_of(state.x), address_of(state.v), t, due
            call(own.visit, turns, turns)


@dataclass(frozen=True)
class CountedAngle:
    """An output of a component that is an angle known up to whole turns.

    ``source`` (body, point): row of the component, or the body and point whose sensor is read.
    """

    kind: Kind
    source: int | tuple[str, str]
    output: int

    @property
    def columns(self) -> tuple[int, int]:
        """Where angle and rate stand in what the kernel of the kind fills; -1 for no rate."""
        names = [name for name, _ in self.kind.outputs]
        if "turn" in self.kind.roles:
            place = 2 * self.kind.angles.index(names[self.output])
            return place, place + 1
        rate = names[self.output].replace("angle", "rate")
        return self.output, names.index(rate) if rate in names else -1

    def component(self, lowered: Lowered) -> tuple[Sequence[int], Sequence[int], np.ndarray]:
        """Unknowns, integers and numbers of the component."""
        structure = lowered.structure
        if isinstance(self.source, tuple):
            name, point = self.source
            body = lowered.bodies[name]
            index, whole = body.point_index(point, structure.first[name], structure.size)
            return index, whole, np.array(body.point_numbers(point))
        own = (table[self.kind][self.source] for table in (structure.index, structure.meta, lowered.data))
        return tuple(own)  # type: ignore[return-value] - three of them


def counted_angles(lowered: Lowered) -> tuple[CountedAngle, ...]:
    """Return all outputs of components and of points of bodies that are angles known up to whole turns."""
    return tuple(_counted(lowered))


def _counted(lowered: Lowered) -> Iterator[CountedAngle]:
    structure = lowered.structure
    for kind, row in structure.rows.values():
        for output in kind.turning(structure.meta[kind][row]):
            yield CountedAngle(kind, row, output)
    for name, body in lowered.bodies.items():
        for point in body.point_names if body.sensor.turns else ():
            _, whole = body.point_index(point, structure.first[name], structure.size)
            for output in body.sensor.turning(whole):
                yield CountedAngle(body.sensor, (name, point), output)


def turn_kernels(angles: Sequence[CountedAngle]) -> list[Compiled]:
    """Kernels that count the turns of angles."""
    kinds = dict.fromkeys(angle.kind for angle in angles)
    return [VISIT, *map(_kernel, kinds)] if kinds else []


def _kernel(kind: Kind) -> Compiled:
    """The kernel that fills angles and rates, or all outputs of a kind without one."""
    return kind.kernel("turn" if "turn" in kind.roles else "outputs", float)


class TurnCounter:
    """The turns of angles along a motion, (outputs, angles) in ``turns``."""

    def __init__(self, lowered: Lowered, angles: Sequence[CountedAngle], outputs: int) -> None:
        kinds = list(dict.fromkeys(angle.kind for angle in angles))
        self.turns = np.zeros((outputs, len(angles)))
        self._blocks, self._offsets = np.zeros(len(kinds), BLOCK), np.zeros(len(kinds), np.int64)
        self._columns, self._kept, width = np.zeros((len(angles), 2), np.int64), [], 0
        for k, kind in enumerate(kinds):
            chosen = [j for j, angle in enumerate(angles) if angle.kind is kind]
            parts = zip(*(angles[j].component(lowered) for j in chosen), strict=True)
            index, whole, numbers = (np.array(part) for part in parts)
            arrays = (
                np.ascontiguousarray(index, np.int64),
                np.ascontiguousarray(whole.reshape(len(chosen), -1), np.int64),
                np.ascontiguousarray(np.real(numbers), float),
            )
            kernel, wide = _kernel(kind), 2 * len(kind.angles) if "turn" in kind.roles else len(kind.outputs)
            block = self._blocks[k]
            block["count"], block["outputs"] = len(chosen), kernel.address
            block["index"], block["integers"], block["numbers"] = (array.ctypes.data for array in arrays)
            self._kept += [arrays, kernel]
            self._offsets[k] = width
            for place, j in enumerate(chosen):
                first, (angle, rate) = width + place * wide, angles[j].columns
                self._columns[j] = first + angle, first + rate if rate >= 0 else -1
            width += len(chosen) * wide
        self._values, self._memory = np.zeros(width), np.zeros((len(angles), 3))
        self._call = lowered.real.call()
        own = self._words = np.zeros(1, TURNS)
        own["count"], own["block_count"], own["width"], own["outputs"] = len(angles), len(kinds), width, outputs
        own["work"], own["visit"] = self._call.address, VISIT.address
        own["out"] = self.turns.ctypes.data
        for name in ("blocks", "offsets", "values", "columns", "memory"):
            own[name] = getattr(self, f"_{name}").ctypes.data

    @property
    def address(self) -> int:
        """Address of the record, for `count_turns`."""
        return self._words.ctypes.data

    def follow(self, even: bool) -> None:
        """Say whether the steps to come are even."""
        self._words["even"] = even

    def begin(self) -> "TurnCounter":
        """Forget what was counted, and return the counter."""
        self._words["begun"] = self._words["skip"] = 0
        return self
