"""Linearised laws of the elements at each sample of a motion: forces and internal numbers after a step in time."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.lowering import ELASTIC, Lowered
from dalembert.vibration.laws.friction_law import TANGENTIAL
from dalembert.vibration.laws.marched_sums import MarchedSums


class Laws(NamedTuple):
    """Linearised laws on q coordinates and z internal numbers, at some samples. Internal numbers are the places of
    slipping sliders, and, of other laws with a memory, their states and forces at the end of the step before.

    ``reaction`` (samples, q, q): forces at the end of a step by displacements there; ``memory`` (samples, q, z): the
    same by internal numbers at its begin; ``following`` (samples, z, q), ``keeping`` (samples, z, z): internal numbers
    at the end by the same two; ``stiffness`` (samples, q, q), ``release`` (samples, q, z): the same forces by
    displacements and internal numbers at the end, from which the next step begins; ``damping``, ``ended``
    (samples, q, q), ``turning`` (samples, z, q): forces at the end of a step, forces from which the next one begins,
    and internal numbers, by velocities there.
    """

    reaction: np.ndarray
    memory: np.ndarray
    following: np.ndarray
    keeping: np.ndarray
    stiffness: np.ndarray
    release: np.ndarray
    damping: np.ndarray
    ended: np.ndarray
    turning: np.ndarray

    def combined(self, combination: np.ndarray) -> "Laws":
        """Return the same on coordinates of which the rows (rows, q) are combinations."""
        across = {name: getattr(self, name) @ combination for name in BY_ROWS}
        return self._replace(**{name: combination.T @ across.get(name, getattr(self, name)) for name in OF_ROWS} | {
            name: across[name] for name in BY_ROWS if name not in OF_ROWS
        })  # fmt: skip


OF_ROWS = ("reaction", "memory", "stiffness", "release", "damping", "ended")
"""Parts that are forces on rows."""
BY_ROWS = ("reaction", "following", "stiffness", "damping", "ended", "turning")
"""Parts by motions of rows."""


@dataclass(frozen=True)
class ElementSlopes:
    """The linearised laws of one element at all samples. ``rows`` (columns,): that it sees; ``laws``: on these."""

    rows: np.ndarray
    laws: Laws


def element_slopes(lowered: Lowered, series: Fourier, motion: np.ndarray, omega: float) -> Iterator[ElementSlopes]:
    """Yield the linearised laws of all elements but rigid contacts, over a motion of the rows (rows, coefficients)."""
    for rows, element in lowered.functions:
        yield ElementSlopes(rows, _laws(np.moveaxis(element.law(motion[rows] @ series.synthesis.T)[1], 2, 0)))
    for block in lowered.laws:
        slopes, columns = (
            MarchedSums(block, series, events=False).derivatives(motion[block.rows], omega),
            block.rows.shape[1],
        )
        for of_element, rows in zip(slopes, block.rows, strict=True):
            laws = _laws(of_element[:, :columns, :columns], of_element[:, :columns, columns : 2 * columns])
            yield ElementSlopes(rows, _remembered(laws, of_element) if block.states else laws)
    for block in (friction_block for friction_block in lowered.blocks if friction_block.kind == ELASTIC):
        columns, tangents = block.rows.shape[1], block.tangents
        slopes = MarchedSums(block.ruled, series, events=False).derivatives(motion[block.rows], omega)
        for of_element, rows, numbers in zip(slopes, block.rows, block.numbers, strict=True):
            laws = _laws(of_element[:, :columns, :columns])
            spring = laws.reaction.copy()  # its force, whatever the slider did: k (u - z)
            spring[:, :tangents] = np.eye(tangents, columns) * numbers[TANGENTIAL]
            laws = laws._replace(stiffness=spring)
            # A slider that sticks at all samples keeps its place: a multiplier of 1 that says nothing, and is left out.
            sticks = np.allclose(of_element[:, columns:, 2 * columns :], np.eye(tangents))
            yield ElementSlopes(rows, laws if sticks else _slid(laws, of_element, numbers[TANGENTIAL]))


def gathered(parts: Sequence[ElementSlopes], rows: int, steps: np.ndarray) -> Laws:
    """Return the laws of all elements at some samples, on all rows."""
    internal = sum(part.laws.keeping.shape[1] for part in parts)
    sizes = {"rows": rows, "internal": internal}
    shapes = {
        name: (
            len(steps),
            sizes["rows" if name in OF_ROWS else "internal"],
            sizes["rows" if name in BY_ROWS else "internal"],
        )
        for name in Laws._fields
    }
    result, begin = Laws(**{name: np.zeros(shape) for name, shape in shapes.items()}), 0
    for part in parts:
        end = begin + part.laws.keeping.shape[1]
        numbers = np.arange(begin, end)
        for name, whole, local in zip(Laws._fields, result, part.laws, strict=True):
            places = part.rows if name in OF_ROWS else numbers
            whole[:, places[:, None], part.rows if name in BY_ROWS else numbers] += local[steps]
        begin = end
    return result


def changes(parts: Sequence[ElementSlopes], samples: int) -> np.ndarray:
    """Return at which samples a step is another than the one before, (samples,)."""
    begun = np.zeros(samples, dtype=bool)
    begun[0] = True
    for laws in (part.laws for part in parts):
        # A step ends with the laws of its sample, and begins with where the step before ended.
        ended = (np.roll(values, 1, axis=0) for values in (laws.stiffness, laws.release, laws.ended))
        steps = laws.reaction, laws.memory, laws.following, laws.keeping, laws.damping, laws.turning
        for values in (*steps, *ended):
            begun |= np.any((values != np.roll(values, 1, axis=0)).reshape(samples, -1), axis=1)
    return begun


def _laws(by_place: np.ndarray, by_speed: np.ndarray | None = None) -> Laws:
    """Of an element without a memory, (samples, columns, columns) both."""
    by_speed = np.zeros_like(by_place) if by_speed is None else by_speed
    samples, columns, _ = by_place.shape
    none, of_none = np.zeros((samples, columns, 0)), np.zeros((samples, 0, columns))
    return Laws(by_place, none, of_none, np.zeros((samples, 0, 0)), by_place, none, by_speed, by_speed, of_none)


def _slid(laws: Laws, slopes: np.ndarray, spring: float) -> Laws:
    """With the place of a slider, which with the displacement says the force of its spring."""
    columns = laws.reaction.shape[1]
    following = slopes[:, columns:, :columns]
    release = np.broadcast_to(-spring * np.eye(columns, following.shape[1]), (len(slopes), columns, following.shape[1]))
    return laws._replace(
        memory=slopes[:, :columns, 2 * columns :], following=following, keeping=slopes[:, columns:, 2 * columns :],
        release=release, turning=np.zeros_like(following),
    )  # fmt: skip


def _remembered(laws: Laws, slopes: np.ndarray) -> Laws:
    """With the states of a law and its forces, from which the next step begins; no states that nothing changes."""
    columns = laws.reaction.shape[1]
    unmoved = np.eye(slopes.shape[1] - columns, slopes.shape[2], k=2 * columns)
    moving = columns + np.flatnonzero(np.any(slopes[:, columns:] != unmoved, axis=(0, 2)))
    kept = np.concatenate([np.arange(columns), moving])
    slopes = slopes[:, kept][:, :, np.concatenate([np.arange(2 * columns), columns + moving])]
    states = len(moving)
    keeping = np.zeros((len(slopes), states + columns, states + columns))
    after = np.roll(slopes, -columns, axis=1)  # states, then forces
    keeping[:, :, :states] = after[:, :, 2 * columns :]
    memory = np.zeros((len(slopes), columns, states + columns))
    memory[:, :, :states] = slopes[:, :columns, 2 * columns :]
    release = np.broadcast_to(np.eye(columns, states + columns, k=states), memory.shape)
    return laws._replace(
        memory=memory, following=after[:, :, :columns], keeping=keeping, stiffness=0 * laws.stiffness, release=release,
        ended=0 * laws.ended, turning=after[:, :, columns : 2 * columns],
    )  # fmt: skip
