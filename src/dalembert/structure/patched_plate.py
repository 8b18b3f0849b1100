"""A clamped plate with arched strips on it, whose feet rub: a structure damped by dry friction."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dalembert.errors import InputError
from dalembert.structure.joining import Pairs, combine, pairs, tie
from dalembert.structure.material import Material
from dalembert.structure.solid import grid, solid
from dalembert.structure.structure import Structure

STEEL = Material(210e9, 0.3, 7800.0)
ALUMINIUM = Material(70e9, 0.3, 2700.0)
ROUNDING = 1e-9
"""Distance, m, within which nodes of two meshes that were made to meet do meet."""


@dataclass(frozen=True)
class Patch:
    """A strip that lies on a plate with its middle and its two feet, and arches over it between them.

    From its outer end inwards: foot, arch, middle, arch, foot; an arch rises as
    :math:`a (1 - \\cos 2 \\pi s / l) / 2` over its length l. The middle is joined to the plate; the feet rest on it.

    Parameters
    ----------
    width, thickness : float
        m.
    foot, arch, middle : float
        Lengths along the strip, m.
    height : float
        a, m.
    clearance : float
        From the edge of the plate to the outer foot, m.
    material : Material

    Notes
    -----
    The measures that a patch has unless others are given are chosen, not published: four of them of aluminium add 0.6 %
    to the mass of a steel plate of 405 mm × 405 mm × 2 mm and raise its fifth frequency to about 408.4 Hz when their
    feet stick, both as published for a plate whose patches are not described.

    References
    ----------
    Ma, Li, Fan, Wu: Friction damping analysis by an accelerated dynamic Lagrangian method, 2019.

    Examples
    --------
    >>> Patch().length
    0.064
    """

    width: float = 9e-3
    thickness: float = 2.47e-3
    foot: float = 4e-3
    arch: float = 16e-3
    middle: float = 24e-3
    height: float = 2e-3
    clearance: float = 3e-3
    material: Material = ALUMINIUM

    @property
    def length(self) -> float:
        """From the outer end to the inner one, along the plate, m."""
        return round(2 * self.foot + 2 * self.arch + self.middle, 12)

    @property
    def stations(self) -> np.ndarray:
        """Where foot, arch, middle, arch and foot begin and end, from the edge of the plate, shape (6,), m."""
        return self.clearance + np.cumsum([0.0, self.foot, self.arch, self.middle, self.arch, self.foot])

    def rise(self, x: np.ndarray) -> np.ndarray:
        """Height of the lower face above the plate, m, at distances from the edge of the plate."""
        starts = self.stations[[1, 3]]
        phases = [np.clip((x - start) / self.arch, 0.0, 1.0) for start in starts]
        return np.sum([self.height * (1 - np.cos(2 * np.pi * phase)) / 2 for phase in phases], axis=0)


def patched_plate(
    patch: Patch = Patch(),
    side: float = 0.405,
    thickness: float = 2e-3,
    material: Material = STEEL,
    elements: int = 6,
) -> Structure:
    """A square plate with a patch at the middle of each of its edges, of bricks of 20 nodes.

    Parts are called "plate" and "patch 1" (at the left edge, x = 0) to "patch 4", against the clock. The middles of the
    patches are joined to the plate. The feet's nodes "patch 1/outer foot" and "patch 1/inner foot" lie on nodes of
    "plate/top", which :func:`foot_pairs` finds. Nothing is held: ``.fixed("plate/edge")`` clamps the plate all round.

    Parameters
    ----------
    patch : Patch
    side, thickness : float
        Of the plate, m.
    material : Material
        Of the plate.
    elements : int
        Of the plate between a patch's inner end and the next one's side; all others follow from the patch.

    Raises
    ------
    InputError
        For patches that do not fit on the plate, or if scikit-fem is not installed.
    """
    stations = patch.stations
    centre = side / 2
    if stations[-1] + patch.width / 2 >= centre:
        raise InputError(
            f"patched_plate: patches of width {patch.width:g} m that reach {stations[-1]:g} m inwards meet on a plate "
            f"of {side:g} m; make them smaller"
        )
    across = centre + patch.width * np.array([-0.5, 0.0, 0.5])
    half = np.unique([0.0, *_divided(stations, (1, 2, 2, 2, 1)), *np.linspace(stations[-1], across[0], elements + 1)])
    lines = np.array([*half, centre, *(side - half[::-1])])
    parts = {"plate": solid(grid(lines, lines, np.array([0.0, thickness])), material)}
    strip = _strip(patch, across)
    x, y, z = strip.p
    z = z + thickness + patch.rise(x)
    for number in range(1, 5):
        parts[f"patch {number}"] = solid(replace(strip, doflocs=np.array([x, y, z])), patch.material)
        x, y = side - y, x
    full = combine(parts)
    for number in range(1, 5):
        joined = pairs(full, f"patch {number}/middle", "plate/top", ROUNDING)
        full = tie(full, [(plate, strip) for strip, plate in joined])
    return full


def foot_pairs(structure: Structure, every: bool = False) -> Pairs:
    """Pairs (node of a patch's foot, node of the plate below it) of a :func:`patched_plate`, foot by foot.

    Parameters
    ----------
    structure : Structure
    every : bool
        All 13 nodes of each foot, not only four that pass on its moments too: middles of edges of elements, since those
        and not the corners of a brick of 20 nodes carry a pressure.
    """
    foot_pairs_here = []
    for number in range(1, 5):
        for foot in ("outer", "inner"):
            below = pairs(structure, f"patch {number}/{foot} foot", "plate/top", ROUNDING)
            foot_pairs_here += below if every else _quarters(structure, below)
    return tuple(foot_pairs_here)


def _quarters(structure: Structure, foot: Pairs) -> list[tuple[str, str]]:
    """The pairs of a foot at its two ends, a quarter of the width from its sides: middles of edges of elements."""
    assert structure.nodes is not None
    places = structure.nodes.places[structure.nodes.rows([node for node, _ in foot]), :2]
    # From -1 to 1 along the foot and across it, in either order.
    local = 2 * (places - places.min(axis=0)) / np.ptp(places, axis=0) - 1
    return [pair for pair, (a, b) in zip(foot, np.abs(local), strict=True) if np.allclose(sorted((a, b)), (0.5, 1.0))]


def _strip(patch: Patch, across: np.ndarray) -> Any:
    """Mesh of a patch along x, flat, with the faces that lie on the plate named."""
    stations = patch.stations
    flat = grid(_divided(stations, (1, 8, 2, 8, 1)), across, np.array([0.0, patch.thickness]))

    def below(first: int) -> Callable[[np.ndarray], np.ndarray]:
        return lambda x: np.isclose(x[2], 0.0) & (stations[first] < x[0]) & (x[0] < stations[first + 1])

    return flat.with_boundaries({"outer foot": below(0), "middle": below(2), "inner foot": below(4)})


def _divided(stations: np.ndarray, counts: tuple[int, ...]) -> np.ndarray:
    """Stations and equal divisions between them."""
    spans = [
        np.linspace(first, last, count, endpoint=False)
        for first, last, count in zip(stations[:-1], stations[1:], counts, strict=True)
    ]
    return np.append(np.concatenate(spans), stations[-1])
