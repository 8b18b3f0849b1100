"""Reduction of a structure to some of its degrees of freedom and the modes between them."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from scipy.sparse import csc_array

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.results import Summarised
from dalembert.structure.dofs import Dofs
from dalembert.structure.eigenmodes import DENSE, all_modes, dense, eigenmodes, lanczos, real_part, similarity
from dalembert.structure.factorise import factorise
from dalembert.structure.structure import SYMMETRIC, Structure, block, changed
from dalembert.tables import Table, cells, counted, percent, shown

NEIGHBOURS = 0.01
"""Modes whose frequencies differ by less, relative, share their shapes when a reduction is judged."""


class CachedBases:
    """Bases of the reductions in a builder of systems. Later calls use the bases of the first one.

    So differences of the reduced matrices leave out how the basis changes, as the complex step does.
    """

    def __init__(self) -> None:
        self._bases: list[np.ndarray] = []
        self._next = 0

    @contextmanager
    def call(self) -> Iterator[None]:
        """One call of the function: its reductions get the bases in their order."""
        self._next, before = 0, _cached.set(self)
        try:
            yield
        finally:
            _cached.reset(before)

    def basis(self, make: Callable[[], np.ndarray]) -> np.ndarray:
        """The basis of the next reduction."""
        if self._next == len(self._bases):
            self._bases.append(make())
        self._next += 1
        return self._bases[self._next - 1]


_cached: ContextVar[CachedBases | None] = ContextVar("held", default=None)


def kept_basis(make: Callable[[], np.ndarray]) -> np.ndarray:
    """The basis that ``make`` returns, or that of the first call of a builder whose bases are kept."""
    bases = _cached.get()
    return bases.basis(make) if bases else make()


@dataclass(frozen=True, eq=False)
class ReductionErrors(Summarised):
    """Errors of the lowest modes of a reduced structure relative to those of the full one.

    Parameters
    ----------
    full, reduced : array, shape (count,)
        Frequencies in Hz, ascending.
    similarity : array, shape (count,)
        Part of the kinetic energy of each reduced shape that lies in the full modes whose frequencies differ by less
        than 1 %; modes of equal frequency, whose shapes are anyone's choice, count together. 1 is perfect.
    """

    TITLE: ClassVar[str] = "Reduction"
    VERDICTS: ClassVar[tuple[str, str]] = ("compared", "")

    full: np.ndarray
    reduced: np.ndarray
    similarity: np.ndarray

    @property
    def relative(self) -> np.ndarray:
        """Relative errors of the frequencies; not negative, since a reduction only stiffens."""
        return self.reduced / self.full - 1

    @property
    def status(self) -> str:
        """What is compared, in a sentence."""
        return "The lowest modes of the reduced structure beside those of the full one."

    def facts(self) -> dict[str, str]:
        return {
            "modes compared": counted(len(self.full)),
            "largest error of a frequency": percent(np.max(self.relative)),
            "least similarity of a shape": shown(float(np.min(self.similarity)), digits=4),
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the frequencies and their errors."""
        columns = {
            "mode": range(1, len(self.full) + 1),
            "full (Hz)": self.full,
            "reduced (Hz)": self.reduced,
            "error (%)": cells(100 * np.asarray(self.relative), 3),
            "similarity of the shapes": self.similarity,
        }
        return (Table.of("reduction", "Modes of the full and the reduced structure", columns),)


@dataclass(frozen=True, eq=False)
class ReducedStructure(Structure):
    """A structure in few coordinates; :func:`craig_bampton` makes it.

    Parameters
    ----------
    mass, stiffness, dofs, damping, nodes, loss, gyroscopic, circulatory, base_inertia
        As of every :class:`Structure`; dense.
    basis : array, shape (n, reduced size)
        The motion of the full structure for each coordinate.
    full_dofs : Dofs
        Names of the n rows of the basis.
    """

    basis: np.ndarray = field(kw_only=True)
    full_dofs: Dofs = field(kw_only=True)

    def fixed(self, clamped: str | Sequence[str]) -> "ReducedStructure":
        """The structure with some of its degrees of freedom clamped.

        Parameters
        ----------
        held : str or sequence of str
            Degrees of freedom, nodes for all of theirs, or sets of nodes.
        """
        less = super().fixed(clamped)
        return replace(less, basis=self.basis[:, self.dofs.rows(less.dofs.names)])  # type: ignore[call-arg]

    def expand(self, motion: np.ndarray) -> np.ndarray:
        """Motion of the full structure, shape (n, ...), for one of the reduced structure, shape (size, ...)."""
        return np.tensordot(self.basis, motion, axes=1)

    def errors(self, full: Structure, count: int = 10) -> ReductionErrors:
        """Return the errors of frequencies and shapes of the lowest modes relative to those of the full structure.

        Parameters
        ----------
        full : Structure
            The one that was reduced.
        count : int
            Number of the lowest modes to compare; at most as many as the reduced structure has.

        Raises
        ------
        InputError
            For a structure with other degrees of freedom.
        """
        if full.dofs.names != self.full_dofs.names:
            raise InputError(
                f"errors: the structure given has {full.size} degrees of freedom, which are not those of the structure "
                f"that was reduced, with {len(self.full_dofs)}; give the one that craig_bampton was given"
            )
        ours, theirs = eigenmodes(self, min(count, self.size)), eigenmodes(full, min(count + 2, full.size))
        near = np.abs(theirs.frequencies / ours.frequencies[:, None] - 1) < NEIGHBOURS
        alike = similarity(self.expand(ours.shapes), theirs.shapes, real_part(full.mass))
        return ReductionErrors(theirs.frequencies[: len(alike)], ours.frequencies, np.sum(alike * near, axis=1))


@takes_checked("masters")
def craig_bampton(structure: Structure, masters: str | Sequence[str], modes: int = 50) -> ReducedStructure:
    r"""Reduce a structure to its master degrees of freedom and the lowest modes with these held.

    With the masters m and the others i, the motion is
    :math:`u_i = -K_{ii}^{-1} K_{im} u_m + \Phi q`, where :math:`\Phi` holds the lowest modes of
    :math:`K_{ii} \phi = \omega^2 M_{ii} \phi`. Static answers to forces on the masters are exact. Imaginary
    parts of the matrices (complex steps) are reduced by the basis of the real parts; its derivative is left out.

    Parameters
    ----------
    structure : Structure
        Held well enough by its masters that nothing else moves freely.
    masters : str or sequence of str
        Degrees of freedom, nodes or sets of nodes: where forces act, contacts are and motion is watched.
    modes : int
        How many modes with held masters; all if there are fewer.

    Returns
    -------
    ReducedStructure
        Its degrees of freedom are the masters, by their names, and then "mode 1.q", "mode 2.q", …

    Raises
    ------
    InputError
        For an unknown master or a negative number of modes.
    SolveError
        If a part of the structure moves freely while the masters are held.

    References
    ----------
    Craig, R. R., Bampton, M. C. C.: Coupling of substructures for dynamic analyses. AIAA J. 6(7), 1968.

    Examples
    --------
    >>> from dalembert.structure import lumped
    >>> names = [f"m{number}" for number in range(6)]
    >>> springs = [("m0", None, 1.0, 0.0)] + [(a, b, 1.0, 0.0) for a, b in zip(names, names[1:])]
    >>> chain = lumped(dict.fromkeys(names, 1.0), springs)
    >>> small = craig_bampton(chain, ["m5"], modes=2)
    >>> small.dofs.names
    ('m5.x', 'mode 1.q', 'mode 2.q')

    The relative error of the lowest natural frequency:

    >>> small.errors(chain, count=1).relative.round(6)
    array([0.000476])
    """
    if modes < 0:
        raise InputError(f"craig_bampton: modes is {modes}; expected 0 or more")
    master_rows = np.array(structure.rows(masters), dtype=int)
    inner = np.setdiff1d(np.arange(structure.size), master_rows)
    count = min(modes, len(inner))
    basis = kept_basis(lambda: held_basis(structure, master_rows, inner, count))

    matrices = changed(structure, lambda matrix: basis.T @ (matrix @ basis))
    # Symmetric but for rounding, and then exactly; parts of a rotor are not.
    matrices |= {name: (matrices[name] + matrices[name].T) / 2 for name in SYMMETRIC if name in matrices}
    names = [structure.dofs.names[row] for row in master_rows] + [f"mode {number}.q" for number in range(1, count + 1)]
    return ReducedStructure(
        dofs=Dofs(tuple(names)), nodes=structure.nodes, basis=basis, full_dofs=structure.dofs,
        base_inertia=basis.T @ structure.inertia_of_base, **matrices,
    )  # fmt: skip


def held_basis(structure: Structure, master_rows: np.ndarray, inner: np.ndarray, count: int) -> np.ndarray:
    """Static shapes of the masters and the lowest modes with these held, (n, masters + modes)."""
    mass, stiffness = real_part(structure.mass), real_part(structure.stiffness)
    basis = np.zeros((structure.size, len(master_rows) + count))
    basis[master_rows, np.arange(len(master_rows))] = 1.0
    if len(inner):
        inner_stiffness = block(stiffness, inner)
        solve = factorise(
            inner_stiffness, "craig_bampton: the stiffness with the masters held", "; clamp it or add masters"
        )
        basis[inner, : len(master_rows)] = -solve(dense(block(stiffness, inner, master_rows)))
        inner_mass = block(mass, inner)
        if len(inner) <= max(DENSE, 2 * count):
            shapes = all_modes(inner_mass, inner_stiffness)[1][:, :count]
        elif count:
            squares, shapes = lanczos(csc_array(inner_mass), csc_array(inner_stiffness), count, solve)
            shapes = shapes[:, np.argsort(squares)]
        else:
            shapes = np.zeros((len(inner), 0))
        basis[inner, len(master_rows) :] = shapes
    return basis
