"""A linear structure: its matrices, the names of their rows, and where its nodes are."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.sparse import csc_array, issparse

from dalembert.argument_readers import names_of
from dalembert.arguments import Checked, is_number
from dalembert.errors import InputError, shown
from dalembert.notebook_display import Displayed
from dalembert.structure.damping import Modal, Rayleigh
from dalembert.structure.dofs import Dofs
from dalembert.structure.nodes import Nodes

Matrix = Any
"""A NumPy array or a SciPy sparse array, (n, n), real, or complex with a complex step as its imaginary part."""

AXES = ("x", "y", "z")
SYMMETRIC = ("mass", "stiffness", "damping", "loss")
ROTATING = ("gyroscopic", "circulatory")
"""Matrices in proportion to the speed of a rotor."""
MATRICES = (*SYMMETRIC, *ROTATING)
OPTIONAL = ("damping", "loss", *ROTATING)
ASYMMETRY = 1e-8
"""Largest difference from its transpose, as part of the largest entry, that is taken for rounding."""
STEP = 1e-10
"""Imaginary part, as part of the largest entry, above which it cannot be the direction of a derivative."""
FAINT = 1e-20
"""Imaginary part that is a direction however small the entries are."""


@dataclass(frozen=True, eq=False)
class Structure(Displayed, Checked):
    r"""A linear structure :math:`M \ddot x + C \dot x + K x = f`, perhaps with hysteretic damping or a rotor.

    Hysteretic (structural) damping is a loss matrix D: the dynamic stiffness at :math:`\omega > 0` is
    :math:`K - \omega^2 M + i \omega C + i D`. It has no meaning for other motions than harmonic ones, so integration in
    time, stability and nonlinear modes refuse it. D does not act on the mean of a motion.

    A rotor with the speed Ω adds the forces :math:`\Omega (G \dot x + N x)`, with the gyroscopic matrix G and the
    circulatory matrix N, of damping that turns with the rotor; see :func:`with_rotors`. The speed belongs to a
    :class:`~dalembert.vibration.VibrationSystem`; modes of the structure alone are those at rest.

    Parameters
    ----------
    mass, stiffness : array or sparse array, shape (n, n)
        kg and N/m where all unknowns are displacements; symmetric. Imaginary parts are directions of derivatives, so
        a complex stiffness K (1 + i η) is given as ``stiffness=K, loss=eta * K``.
    dofs : Dofs
        Names of the n rows.
    damping : array or sparse array, shape (n, n), optional
        N s/m; none if not given.
    nodes : Nodes, optional
        Where the nodes are, and their sets.
    loss : array or sparse array, shape (n, n), optional
        Hysteretic damping, N/m; none if not given. See :meth:`with_loss` for a loss factor.
    gyroscopic, circulatory : array or sparse array, shape (n, n), optional
        G and N, kg and N s/m where all unknowns are displacements; none if not given. They need no symmetry.
    base_inertia : array, shape (n, 3), optional
        Forces on the degrees of freedom by unit accelerations of all of them, and of the clamped ones, along x, y and
        z, kg. Those of the mass matrix if not given; :meth:`fixed` and a reduction keep them.

    Raises
    ------
    InputError
        For matrices whose sizes do not fit, or that are not finite, for a mass, stiffness, damping or loss that is not
        symmetric, for negative masses, and for imaginary parts that are too large to be directions of derivatives.

    Examples
    --------
    >>> import numpy as np
    >>> pair = Structure(np.eye(2), np.array([[2.0, -1.0], [-1.0, 1.0]]), Dofs(("a.x", "b.x")))
    >>> pair.size, pair.fixed(["b"]).stiffness.tolist()
    (2, [[2.0]])
    """

    mass: Matrix
    stiffness: Matrix
    dofs: Dofs
    damping: Matrix | None = None
    nodes: Nodes | None = None
    loss: Matrix | None = None
    gyroscopic: Matrix | None = None
    circulatory: Matrix | None = None
    base_inertia: np.ndarray | None = None

    def __post_init__(self) -> None:
        if not self.size:
            raise InputError(
                "Structure: there are no degrees of freedom, perhaps all are clamped; expected at least one"
            )
        for name in MATRICES:
            matrix = getattr(self, name)
            if matrix is None and name in OPTIONAL:
                continue
            matrix: Matrix = csc_array(matrix) if issparse(matrix) else np.asarray(matrix)
            object.__setattr__(self, name, matrix)
            if matrix.dtype.kind not in "iufc":
                raise InputError(f"Structure: the {name} is {shown(getattr(self, name))}; expected a matrix of numbers")
            if matrix.shape != (self.size, self.size):
                raise InputError(
                    f"Structure: the {name} matrix has shape {matrix.shape}; expected {(self.size, self.size)}, "
                    f"a row for each of the {self.size} degrees of freedom"
                )
            entries = matrix.data if issparse(matrix) else matrix
            if not np.all(np.isfinite(entries)):
                raise InputError(f"Structure: the {name} matrix has entries that are not finite numbers")
            off = abs(matrix - matrix.T).max() if name in SYMMETRIC else 0.0
            if off > ASYMMETRY * abs(matrix).max():
                raise InputError(
                    f"Structure: the {name} matrix is not symmetric, it differs from its transpose by up to {off:.3g}; "
                    "expected a symmetric one"
                )
            _require_direction(matrix, name)
        if self.base_inertia is not None and np.shape(self.base_inertia) != (self.size, 3):
            raise InputError(
                f"Structure: base_inertia has shape {np.shape(self.base_inertia)}; expected {(self.size, 3)}, a row "
                "for each degree of freedom and a column for each of x, y and z"
            )
        self._require_positive("mass", "kg")
        if self.loss is not None:
            self._require_positive("loss", "N/m")

    def _require_positive(self, name: str, unit: str) -> None:
        diagonal = np.real(getattr(self, name).diagonal())
        row = int(diagonal.argmin())
        if diagonal[row] < -ASYMMETRY * np.abs(diagonal).max():
            raise InputError(
                f"Structure: the {name} of {self.dofs.names[row]!r} is {diagonal[row]:g} {unit}; expected a number "
                "that is not negative"
            )

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return len(self.dofs)

    @property
    def rotates(self) -> bool:
        """Whether a part of it belongs to a rotor."""
        parts = (self.gyroscopic, self.circulatory)
        return any(matrix is not None and abs(matrix).max() > 0 for matrix in parts)

    @property
    def inertia_of_base(self) -> np.ndarray:
        """Forces by unit accelerations of all degrees of freedom along x, y and z, kg, (n, 3)."""
        if self.base_inertia is not None:
            return self.base_inertia
        directions = [name.rpartition(".")[2] for name in self.dofs.names]
        moved = np.array([[direction == axis for axis in AXES] for direction in directions], dtype=float)
        return np.asarray(self.mass @ moved)

    def rows(self, names: str | Sequence[str]) -> list[int]:
        """Rows of degrees of freedom, of all those of nodes, or of all those of sets of nodes.

        Nodes of a set that have none left, since they are clamped, are passed over.

        Raises
        ------
        InputError
            For an unknown name, with the nearest ones.
        """
        sets = self.nodes.sets if self.nodes else {}
        names = names_of(names, "Structure", "a list of degrees of freedom, nodes or sets")
        single = [
            name
            for name_or_set in names
            for name in (filter(self.dofs.has_node, sets[name_or_set]) if name_or_set in sets else [name_or_set])
        ]
        return list(dict.fromkeys(self.dofs.rows(single)))

    def fixed(self, clamped: str | Sequence[str]) -> Structure:
        """Return the structure with clamped degrees of freedom: their rows and columns are removed.

        Parameters
        ----------
        held : str or sequence of str
            Degrees of freedom, nodes for all of theirs, or sets of nodes.
        """
        out = np.ones(self.size, dtype=bool)
        out[self.rows(clamped)] = False
        kept = np.flatnonzero(out)
        return replace(
            self,
            dofs=Dofs(tuple(self.dofs.names[row] for row in kept)),
            # Clamped degrees of freedom move with the base, and their mass pulls at the others.
            base_inertia=self.inertia_of_base[kept],
            **changed(self, lambda matrix: block(matrix, kept)),
        )

    def with_damping(self, damping: Rayleigh | Modal | Matrix) -> Structure:
        """Return the structure with another damping.

        It replaces that of rotating dampers, too: :func:`with_rotors` comes last.

        Parameters
        ----------
        damping : Rayleigh, Modal, or array or sparse array of shape (n, n)

        Examples
        --------
        >>> bob = Structure(np.array([[2.0]]), np.array([[8.0]]), Dofs(("bob.x",)))
        >>> bob.with_damping(Modal(0.01)).damping.round(12).tolist()  # 2 · 0.01 · sqrt(2 · 8)
        [[0.08]]
        """
        matrix = damping.matrix(self.mass, self.stiffness) if isinstance(damping, (Rayleigh, Modal)) else damping
        if np.ndim(matrix) == 0 and not issparse(matrix):
            raise InputError(
                f"with_damping: damping is {shown(matrix)}; expected Modal(ratio), Rayleigh(mass, stiffness) or a "
                "matrix"
            )
        return replace(self, damping=matrix)

    def with_loss(self, loss: float | complex | Matrix) -> Structure:
        r"""Return the structure with another hysteretic damping.

        Parameters
        ----------
        loss : float, or array or sparse array of shape (n, n)
            Loss factor η for :math:`D = \eta K`, not negative, or the matrix D in N/m.

        Raises
        ------
        InputError
            For a loss factor that is negative or not a number, and a matrix that is no loss matrix.

        Examples
        --------
        >>> bob = Structure(np.array([[2.0]]), np.array([[8.0]]), Dofs(("bob.x",)))
        >>> bob.with_loss(0.02).loss.tolist()
        [[0.16]]
        """
        if np.ndim(loss) == 0 and not issparse(loss):
            loss = checked_factor("with_loss: the loss factor", loss) * self.stiffness
        return replace(self, loss=loss)


def changed(structure: Structure, change: Callable[[Matrix], Matrix]) -> dict[str, Matrix]:
    """Return the matrices of a structure by name, each after a change."""
    matrices = {name: getattr(structure, name) for name in MATRICES}
    return {name: change(matrix) for name, matrix in matrices.items() if matrix is not None}


def known_nodes(structure: Structure, where: str) -> Nodes:
    """Return the nodes of a structure. Refuse a structure without positions of nodes, naming the caller."""
    if structure.nodes is None:
        raise InputError(f"{where}: the structure does not say where its nodes are; give it nodes=Nodes(...)")
    return structure.nodes


def checked_factor(what: str, factor: Any) -> Any:
    """Return a loss factor that is a number and not negative."""
    if not is_number(factor) or np.real(factor) < 0 or abs(np.imag(factor)) > FAINT:
        raise InputError(f"{what} is {shown(factor)}; expected a real number that is not negative")
    return factor


def _require_direction(matrix: Matrix, name: str) -> None:
    if not np.iscomplexobj(matrix):
        return
    imaginary, largest = abs(matrix.imag).max(), abs(matrix.real).max()
    if imaginary > max(STEP * largest, FAINT):
        advice = (
            "Give hysteretic damping as stiffness=K.real, loss=K.imag" if name == "stiffness" else "Give a real one"
        )
        part = imaginary / (largest or 1.0)
        raise InputError(
            f"Structure: the {name} matrix has imaginary parts up to {imaginary:.3g}, {part:.2g} of its "
            f"largest entry. Imaginary parts are directions of derivatives here. {advice}"
        )


def block(matrix: Matrix, rows: np.ndarray, columns: np.ndarray | None = None) -> Matrix:
    """Some rows and columns (the same ones if not given) of a dense or sparse matrix."""
    columns = rows if columns is None else columns
    return matrix.tocsc()[:, columns].tocsr()[rows].tocsc() if issparse(matrix) else matrix[np.ix_(rows, columns)]
