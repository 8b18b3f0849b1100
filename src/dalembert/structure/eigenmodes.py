"""Frequencies and shapes of the free vibrations of a structure, and how similar shapes are."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_array, issparse
from scipy.sparse.linalg import LinearOperator, eigsh

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.structure.factorise import factorise
from dalembert.structure.structure import Matrix, Structure

DENSE = 400
"""Degrees of freedom up to which all modes at once cost less than some by iteration."""


@dataclass(frozen=True, eq=False)
class EigenModes:
    r"""Free undamped vibrations, :math:`K \phi = \omega^2 M \phi`.

    Parameters
    ----------
    frequencies : array, shape (count,)
        Hz, ascending.
    shapes : array, shape (n, count)
        Normalised to :math:`\phi^T M \phi = 1`; the largest entry of each is positive.
    """

    frequencies: np.ndarray
    shapes: np.ndarray


@takes_checked()
def eigenmodes(structure: Structure, count: int = 10, shift: float = 0.0) -> EigenModes:
    """Return the modes whose frequencies are nearest to a shift, by Lanczos iteration on the inverse; dense if small.

    Parameters
    ----------
    structure : Structure
        Its damping, and the imaginary parts of its matrices, are not used.
    count : int
        How many.
    shift : float
        Hz; with 0 the lowest ones come. A structure that is not held needs one that is not a frequency of it, such as
        a tenth of the first elastic one.

    Raises
    ------
    InputError
        For a count that is not between 1 and the number of degrees of freedom, and for a mass matrix that is not
        positive definite in a small structure.
    SolveError
        For a shift that is a frequency of the structure.

    Examples
    --------
    >>> from dalembert.structure import lumped
    >>> pair = lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.0), ("a", "b", 1.0, 0.0), ("b", None, 1.0, 0.0)])
    >>> (2 * np.pi * eigenmodes(pair, 2).frequencies) ** 2  # 1 and 3 by hand
    array([1., 3.])
    """
    if not 1 <= count <= structure.size:
        raise InputError(
            f"eigenmodes: {count} modes are asked for; expected 1 to {structure.size}, as many as the structure has "
            "degrees of freedom"
        )
    sigma = (2 * np.pi * shift) ** 2
    mass, stiffness = (real_part(matrix) for matrix in (structure.mass, structure.stiffness))
    if structure.size <= max(DENSE, 2 * count):
        squares, shapes = all_modes(mass, stiffness)
        near = np.sort(np.argsort(np.abs(squares - sigma), kind="stable")[:count])
    else:
        solve = factorise(
            csc_array(stiffness - sigma * mass),
            "eigenmodes: the stiffness, less the mass at the shift,",
            ", or the shift is a frequency of it; clamp it, or choose another shift",
        )
        squares, shapes = lanczos(csc_array(mass), csc_array(stiffness), count, solve, sigma)
        near = np.argsort(squares)
    shapes = shapes[:, near]
    shapes = shapes * np.sign(shapes[np.argmax(np.abs(shapes), axis=0), np.arange(count)])
    return EigenModes(np.sqrt(np.clip(squares[near], 0.0, None)) / (2 * np.pi), shapes)


def similarity(shapes: np.ndarray, references: np.ndarray, mass: Matrix) -> np.ndarray:
    r"""Return the modal assurance criterion of each pair of shapes, weighted by the mass.

    :math:`(\phi^T M \psi)^2 / (\phi^T M \phi \; \psi^T M \psi)`: 1 for the same shape, 0 for orthogonal ones.

    Parameters
    ----------
    shapes, others : array, shape (n, count) and (n, other count)
    mass : array or sparse array, shape (n, n)

    Returns
    -------
    array, shape (count, other count)

    References
    ----------
    Allemang, R. J.: The modal assurance criterion. Sound and Vibration 37(8), 2003.

    Examples
    --------
    >>> similarity(np.array([[1.0], [1.0]]), np.array([[2.0, 1.0], [2.0, 0.0]]), np.eye(2)).round(12)
    array([[1. , 0.5]])
    """
    sizes, other_sizes = (np.einsum("ij,ij->j", modes, mass @ modes) for modes in (shapes, references))
    return (shapes.T @ (mass @ references)) ** 2 / np.outer(sizes, other_sizes)


def real_part(matrix: Matrix) -> Matrix:
    """Return the real part of a dense or sparse matrix."""
    return matrix.real if np.iscomplexobj(matrix) else matrix


def dense(matrix: Matrix) -> np.ndarray:
    """Return a matrix that is not sparse."""
    return matrix.toarray() if issparse(matrix) else matrix


def all_modes(mass: Matrix, stiffness: Matrix) -> tuple[np.ndarray, np.ndarray]:
    """Squares of all angular frequencies, ascending, and shapes, by dense matrices."""
    try:
        return eigh(dense(stiffness), dense(mass))
    except np.linalg.LinAlgError:
        raise InputError(
            "eigenmodes: the mass matrix is not positive definite; give all degrees of freedom a mass"
        ) from None


def lanczos(
    mass: Any, stiffness: Any, count: int, solve: Callable[[np.ndarray], np.ndarray], sigma: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Squares of angular frequencies nearest to ``sigma``, and shapes, by the solution with K - sigma M."""
    inverse = cast(Any, LinearOperator)(mass.shape, matvec=solve, dtype=float)
    # The same start each time, so that bits repeat; without symmetry, so that it has a part of every mode.
    start = np.random.default_rng(0).standard_normal(mass.shape[0])
    return cast(Any, eigsh(stiffness, count, mass, sigma=sigma, OPinv=inverse, v0=start))
