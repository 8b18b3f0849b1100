"""Laws of the user's without memory, of several degrees of freedom, as functions of arrays."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError, shown
from dalembert.forward.builders import call_error
from dalembert.forward.complex_steps import DROPPING, attempted, lost_step


@dataclass(frozen=True)
class UserElement(Checked):
    """A law of the user's without memory, of several degrees of freedom.

    Parameters
    ----------
    name : str
    dofs : sequence of str
        Degrees of freedom.
    function : callable
        ``function(u)`` of displacements (dofs, samples), m, returns the internal forces (dofs, samples), N, which stand
        beside the springs of the structure. Its derivative is taken by a complex step: it must run in complex numbers.
        It is compared with differences at the first displacements.

    Raises
    ------
    InputError
        By :meth:`law`, for a function that drops the imaginary part of displacements, as ``abs`` does, and for one
        whose forces at zero displacements are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> UserElement("quintic", ["A.x"], lambda u: 2.0 * u**5).law(np.array([[1.0]]))[1].tolist()
    [[[10.0]]]
    """

    name: str
    dofs: Sequence[str]
    function: Callable[[np.ndarray], np.ndarray]

    def law(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Forces (dofs, samples) and their derivatives (dofs, dofs, samples), the latter of real displacements only."""
        values = self._forces(u)
        if np.iscomplexobj(u):
            return values, np.zeros(0)
        # Elsewhere a trial of Newton's method may lie beyond what the law is for; the search goes back there.
        if not np.any(u) and not np.all(np.isfinite(values)):
            raise InputError(
                f"element {self.name!r}: its function returned {values[~np.isfinite(values)][0]} at zero "
                "displacements; expected finite forces"
            )
        if not self._compared and np.any(u) and not np.iscomplexobj(values):  # where no parameter is moved
            self._compare(u)
        slopes = np.empty((len(u), *u.shape))
        for column in range(len(u)):
            moved = u.astype(complex)
            moved[column] += 1e-30j
            slopes[:, column] = np.imag(self._forces(moved)) / 1e-30
        # NaN in place of infinity, which sums turn into NaN with a warning.
        return np.where(np.isfinite(values), values, np.nan), np.where(np.isfinite(slopes), slopes, np.nan)

    def __post_init__(self) -> None:
        object.__setattr__(self, "dofs", (self.dofs,) if isinstance(self.dofs, str) else tuple(self.dofs))
        if not self.dofs or len(set(self.dofs)) < len(self.dofs):
            raise InputError(
                f"element {self.name!r}: dofs is {shown(list(self.dofs))}; expected one or more different names"
            )
        error = call_error(self.function, None)
        if error is not None:
            raise InputError(
                f"element {self.name!r}: its function cannot be called with displacements alone: {error}. A law with "
                "internal state cannot be a function, only contacts (FrictionContact) have one"
            )

    def _forces(self, u: np.ndarray) -> np.ndarray:
        """What the function returns, as an array like the displacements."""
        where = f"element {self.name!r}"
        returned = self.function(u.copy())
        if isinstance(returned, tuple):
            raise InputError(
                f"{where}: its function returned {len(returned)} values; expected the forces alone. A law with "
                "internal state cannot be a function, only contacts (FrictionContact) have one"
            )
        values = np.asarray(returned)
        if values.shape != u.shape or values.dtype.kind not in "iufc":
            what = shown(returned) if values.ndim == 0 else f"an array of shape {values.shape}"
            raise InputError(
                f"{where}: its function returned {what} for displacements of shape {u.shape}; expected forces of that "
                "shape"
            )
        return values

    @cached_property
    def _compared(self) -> list[bool]:
        """Not empty once the complex step was compared with differences."""
        return []

    def _compare(self, u: np.ndarray) -> None:
        move = np.random.default_rng(0).uniform(0.5, 1.0, (len(u), 1)) * np.max(np.abs(u))
        lost = attempted(partial(lost_step, lambda shift: np.ravel(self.function(u + shift * move)), 1.0))
        if lost:
            raise InputError(
                f"element {self.name!r}: the derivative of its force by the displacements is "
                f"{lost.by_step / np.max(move):.6g} N/m by the complex step, but "
                f"{lost.by_differences / np.max(move):.6g} N/m by differences. Its function drops the imaginary part, "
                f"as {DROPPING} do. Use absolute, norm, hypot and atan2 of dalembert"
            )
        self._compared.append(True)
