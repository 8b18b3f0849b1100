"""A force by a table over frequency."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.interpolate import PchipInterpolator

from dalembert.argument_readers import numbers_of
from dalembert.arguments import Checked
from dalembert.errors import InputError
from dalembert.structure import Structure
from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.system.force_terms import AtDof, Factor, Term, require_varying, term_at


@dataclass(frozen=True)
class TabulatedForce(AtDof, Checked):
    r"""A force whose amplitude and phase depend on the excitation frequency, such as a measured one.

    Between the frequencies of the table, :math:`F \cos\varphi` and :math:`F \sin\varphi` are interpolated by piecewise
    cubic polynomials that do not overshoot (PCHIP).

    Parameters
    ----------
    dof : str
    frequencies : sequence of float
        Hz, ascending, positive.
    amplitudes : sequence of float
        N, one for each frequency.
    phases : sequence of float, optional
        rad; zero if not given.
    harmonic : int
        Of the excitation frequency, in which the force acts.
    scale : float
        By which the amplitudes are multiplied.

    Raises
    ------
    InputError
        For a table of fewer than two frequencies, that do not ascend, or of other lengths. A curve that leaves the
        table is refused, too.
    """

    dof: str
    frequencies: Sequence[float] = field(metadata={"unit": "Hz"})
    amplitudes: Sequence[float] = field(metadata={"unit": "N"})
    phases: Sequence[float] = field(default=(), metadata={"unit": "rad"})
    harmonic: int = 1
    scale: Number = field(default=1.0, metadata={"unit": ""})

    def __post_init__(self) -> None:
        where = self.where
        require_varying(where, self.harmonic)
        for name in ("frequencies", "amplitudes", "phases"):
            numbers = numbers_of(getattr(self, name), where, name)
            if not np.all(np.isfinite(numbers)):
                raise InputError(f"{where}: the {name} of the table are not all finite numbers")
            object.__setattr__(self, name, tuple(numbers.ravel().tolist()))
        count = len(self.frequencies)
        if count < 2 or self.frequencies[0] <= 0 or np.any(np.diff(self.frequencies) <= 0):
            raise InputError(
                f"{where}: the frequencies of the table are {list(self.frequencies[:4])}; expected two or more, "
                "positive and ascending, in Hz"
            )
        for name in ("amplitudes", "phases"):
            values = getattr(self, name)
            if len(values) != count and (values or name == "amplitudes"):
                raise InputError(
                    f"{where}: the table has {count} frequencies and {len(values)} {name}; expected as many"
                )

    @property
    def range(self) -> tuple[float, float]:
        """First and last frequency of the table, Hz."""
        return self.frequencies[0], self.frequencies[-1]

    def terms(self, structure: Structure) -> list[Term]:
        """Return its parts on the degrees of freedom of a structure."""
        return [
            term_at(structure, self.dof, self.scale, 0.0, self.harmonic, self._part(0)),
            term_at(structure, self.dof, 0.0, self.scale, self.harmonic, self._part(1)),
        ]

    def _part(self, number: int) -> Factor:
        """Return the cosine or the sine of the force over ω, N."""
        curve, slope = self._curves[number]

        def factor(omega: float) -> tuple[float, float]:
            # A path may pass the ends of its range a little: the force stays there.
            at = float(np.clip(omega / (2 * np.pi), *self.range))
            return float(curve(at)), float(slope(at)) / (2 * np.pi)

        return factor

    @cached_property
    def _curves(self) -> list[tuple[PchipInterpolator, Callable]]:
        phases = np.array(self.phases or np.zeros(len(self.frequencies)))
        parts = np.array(self.amplitudes) * np.array([np.cos(phases), -np.sin(phases)])
        curves = [PchipInterpolator(self.frequencies, part) for part in parts]
        return [(curve, curve.derivative()) for curve in curves]
