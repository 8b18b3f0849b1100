"""Material damping and damping ratios, as matrices."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import issparse

from dalembert.arguments import Checked
from dalembert.errors import InputError

LARGEST = 5000
"""Degrees of freedom up to which a damping ratio of all modes is written as a matrix, which is full."""


@dataclass(frozen=True)
class Rayleigh(Checked):
    r"""Damping in proportion to mass and stiffness, :math:`C = \alpha M + \beta K`.

    A mode of angular frequency :math:`\omega` gets the ratio :math:`(\alpha / \omega + \beta \omega) / 2`.

    Parameters
    ----------
    mass : float
        :math:`\alpha`, 1/s.
    stiffness : float
        :math:`\beta`, s.
    """

    mass: float | complex = field(default=0.0, metadata={"unit": "1/s"})
    stiffness: float | complex = field(default=0.0, metadata={"unit": "s"})

    def matrix(self, mass: Any, stiffness: Any) -> Any:
        """The damping matrix, shape (n, n), sparse where the others are."""
        return self.mass * mass + self.stiffness * stiffness


@dataclass(frozen=True)
class Modal(Checked):
    r"""One damping ratio for all modes, :math:`C = 2 \zeta M (M^{-1} K)^{1/2}`; rigid motions are not damped.

    The matrix is full, so a large model is reduced first (:func:`~dalembert.structure.craig_bampton`). Derivatives by
    complex step with respect to the ratio, the mass and the stiffness are exact: the derivative of the square root
    solves a Sylvester equation, which the modes make diagonal.

    Parameters
    ----------
    ratio : float
        :math:`\zeta`.

    Raises
    ------
    InputError
        By :meth:`matrix`, for a model that is too large or whose mass matrix is not positive definite.
    """

    ratio: float | complex = field(metadata={"unit": ""})

    def matrix(self, mass: Any, stiffness: Any) -> np.ndarray:
        """The damping matrix, shape (n, n)."""
        if mass.shape[0] > LARGEST:
            raise InputError(
                f"Modal: one ratio for all modes of {mass.shape[0]} degrees of freedom is a full matrix; expected at "
                f"most {LARGEST}; reduce the structure first with craig_bampton, or use Rayleigh"
            )
        m, k = (matrix.toarray() if issparse(matrix) else np.asarray(matrix) for matrix in (mass, stiffness))
        try:
            squares, shapes = eigh(np.real(k), np.real(m))
        except np.linalg.LinAlgError:
            raise InputError(
                "Modal: the mass matrix is not positive definite, so some modes have no frequency; "
                "give all degrees of freedom a mass, or use Rayleigh"
            ) from None
        omega = np.sqrt(np.clip(squares, 0.0, None))
        left = np.real(m) @ shapes
        root = (shapes * omega) @ left.T
        if np.iscomplexobj(m) or np.iscomplexobj(k):
            change = shapes.T @ np.imag(k) @ shapes - shapes.T @ np.imag(m) @ shapes * squares
            sums = omega[:, None] + omega
            change = np.divide(change, sums, out=np.zeros_like(change), where=sums > 0)
            root = root + 1j * (shapes @ change @ left.T)
        damping = 2 * self.ratio * m @ root
        return (damping + damping.T) / 2
