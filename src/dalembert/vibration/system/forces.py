r"""Forces on a vibrating system, as sums of terms.

A term is a pattern over the degrees of freedom times a function of the excitation frequency,
:math:`f(t) = p(\omega)\,[a \cos h\omega t + b \sin h\omega t]`. A structure answers each pattern once, whatever the
frequency.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from dalembert.argument_readers import numbers_of
from dalembert.arguments import Checked
from dalembert.errors import InputError
from dalembert.structure import Structure
from dalembert.vibration.laws.contacts import Number

AXES = ("x", "y", "z")
MODAL = "q"
"""Direction of a coordinate that is a mode."""
Factor = Callable[[float], tuple[float, float]]
"""A function of ω, and its derivative."""


class Term(NamedTuple):
    """A part of a force: degrees of freedom ``rows``, ``cosine`` a and ``sine`` b (rows,) in N, ``harmonic`` h, and
    ``factor``, p; None for 1.
    """

    rows: np.ndarray
    cosine: np.ndarray
    sine: np.ndarray
    harmonic: int
    factor: Factor | None = None


@dataclass(frozen=True)
class HarmonicForce(Checked):
    """Force amplitude · cos(harmonic · ω t + phase) on a degree of freedom.

    Parameters
    ----------
    dof : str
        Such as ``"A.x"``.
    amplitude : float
        N.
    phase : float
        rad.
    harmonic : int
    """

    dof: str
    amplitude: Number = field(metadata={"unit": "N"})
    phase: Number = field(default=0.0, metadata={"unit": "rad"})
    harmonic: int = 1

    def __post_init__(self) -> None:
        _require_varying(self.where, self.harmonic)

    @property
    def dofs(self) -> tuple[str, ...]:
        """Where it acts."""
        return (self.dof,)

    @property
    def where(self) -> str:
        """What it is, for messages."""
        return f"the force on {self.dof!r}"

    def terms(self, structure: Structure) -> list[Term]:
        """Return its parts on the degrees of freedom of a structure."""
        # a cos(hτ + φ) = a cos φ cos hτ - a sin φ sin hτ
        turned = self.amplitude * np.cos(self.phase), -self.amplitude * np.sin(self.phase)
        return [_at(structure, self.dof, *turned, self.harmonic)]


@dataclass(frozen=True)
class StaticForce(Checked):
    """A constant force on a degree of freedom.

    Parameters
    ----------
    dof : str
    value : float
        N.
    """

    dof: str
    value: Number = field(metadata={"unit": "N"})

    @property
    def dofs(self) -> tuple[str, ...]:
        """Where it acts."""
        return (self.dof,)

    @property
    def where(self) -> str:
        """What it is, for messages."""
        return f"the force on {self.dof!r}"

    @property
    def harmonic(self) -> int:
        """The mean."""
        return 0

    def terms(self, structure: Structure) -> list[Term]:
        """Return its only part."""
        return [_at(structure, self.dof, self.value, 0.0, 0)]


@dataclass(frozen=True)
class Unbalance(Checked):
    r"""The force of a rotating unbalance, :math:`m e\,\omega^2 (\cos(\omega t + \varphi), \sin(\omega t + \varphi))`.

    Parameters
    ----------
    first, second : str
        Degrees of freedom across the axis, such as ``"disk.x"`` and ``"disk.y"``. The rotor turns from the first to the
        second.
    moment : float
        Mass times eccentricity, kg m.
    phase : float
        rad.

    Examples
    --------
    >>> import numpy as np
    >>> import dalembert as da
    >>> rotor = da.lumped({"disk.x": 1.0, "disk.y": 1.0}, [("disk.x", None, 1.0, 0.1), ("disk.y", None, 1.0, 0.1)])
    >>> system = da.VibrationSystem(rotor, speed="synchronous")
    >>> unbalance = system.add(Unbalance("disk.x", "disk.y", moment=0.01))
    >>> curve = da.frequency_response(system, np.array([1.0]) / (2 * np.pi))
    >>> float(curve.amplitude("disk.x")[0].round(6))  # at the resonance: m e/(2 D) with D = 0.05
    0.1
    """

    first: str
    second: str
    moment: Number = field(metadata={"unit": "kg*m"})
    phase: Number = field(default=0.0, metadata={"unit": "rad"})

    def __post_init__(self) -> None:
        if self.first == self.second:
            raise InputError(f"{self.where}: both directions are equal; expected two across the axis")

    @property
    def dofs(self) -> tuple[str, ...]:
        """Where it acts."""
        return self.first, self.second

    @property
    def where(self) -> str:
        """What it is, for messages."""
        return f"the unbalance at {self.first!r}"

    @property
    def harmonic(self) -> int:
        """Once in a turn."""
        return 1

    def terms(self, structure: Structure) -> list[Term]:
        """Return its parts on the degrees of freedom of a structure."""
        # sin(τ + φ) = sin φ cos τ + cos φ sin τ
        c, s = self.moment * np.cos(self.phase), self.moment * np.sin(self.phase)
        ends = (self.first, c, -s), (self.second, s, c)
        return [_at(structure, dof, cosine, sine, 1, _square) for dof, cosine, sine in ends]


@dataclass(frozen=True)
class TabulatedForce(Checked):
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
        _require_varying(where, self.harmonic)
        for name in ("frequencies", "amplitudes", "phases"):
            numbers = numbers_of(getattr(self, name), where, name)
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
    def dofs(self) -> tuple[str, ...]:
        """Where it acts."""
        return (self.dof,)

    @property
    def where(self) -> str:
        """What it is, for messages."""
        return f"the force on {self.dof!r}"

    @property
    def range(self) -> tuple[float, float]:
        """First and last frequency of the table, Hz."""
        return self.frequencies[0], self.frequencies[-1]

    def terms(self, structure: Structure) -> list[Term]:
        """Return its parts on the degrees of freedom of a structure."""
        return [
            _at(structure, self.dof, self.scale, 0.0, self.harmonic, self._part(0)),
            _at(structure, self.dof, 0.0, self.scale, self.harmonic, self._part(1)),
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


@dataclass(frozen=True)
class BaseExcitation(Checked):
    r"""A base that moves along an axis, :math:`x_b = X \cos(h\omega t + \varphi)`, and carries a structure.

    The displacements of the structure are those relative to the base: it feels the force
    :math:`-M \iota\, \ddot x_b`, with :math:`\iota` = 1 for the degrees of freedom along the axis. Springs, dampers and
    contacts to the ground act between the structure and the base.

    Parameters
    ----------
    direction : {"x", "y", "z"}
    displacement : float
        X, m.
    acceleration : float
        Amplitude of the acceleration, m/s², in place of the displacement.
    phase : float
        rad.
    harmonic : int

    Raises
    ------
    InputError
        For both amplitudes, or none; and for a structure with coordinates along no axis, such as modes.

    Examples
    --------
    >>> import numpy as np
    >>> import dalembert as da
    >>> system = da.VibrationSystem(da.lumped({"m": 2.0}, [("m", None, 2.0, 0.2)]))
    >>> base = system.add(BaseExcitation("x", displacement=0.01))
    >>> curve = da.frequency_response(system, np.array([1.0]) / (2 * np.pi))
    >>> float(curve.amplitude("m")[0].round(6))  # X/(2 D) with D = 0.05
    0.1
    """

    direction: str
    displacement: Number = field(default=0.0, metadata={"unit": "m"})
    acceleration: Number = field(default=0.0, metadata={"unit": "m/s^2"})
    phase: Number = field(default=0.0, metadata={"unit": "rad"})
    harmonic: int = 1

    def __post_init__(self) -> None:
        _require_varying(self.where, self.harmonic)
        if self.direction not in AXES:
            raise InputError(f"BaseExcitation: direction is {self.direction!r}; expected one of {', '.join(AXES)}")
        if bool(self.displacement) == bool(self.acceleration):
            raise InputError(f"{self.where} has {self._amplitudes}; expected one of them")

    @property
    def dofs(self) -> tuple[str, ...]:
        """None of the structure: the force acts on all masses."""
        return ()

    @property
    def where(self) -> str:
        """What it is, for messages."""
        return f"the base excitation along {self.direction!r}"

    @property
    def _amplitudes(self) -> str:
        return "both a displacement and an acceleration" if self.displacement else "no displacement and no acceleration"

    def terms(self, structure: Structure) -> list[Term]:
        """Return its parts on the degrees of freedom of a structure."""
        names = structure.dofs.names
        axes = [name.rpartition(".")[2] for name in names]
        if MODAL in axes:
            raise InputError(
                f"{self.where}: the structure has modes as coordinates, {names[axes.index(MODAL)]!r}, whose inertia "
                "along the axis is not known. Excite the full structure"
            )
        moved = np.array([axis == self.direction for axis in axes], dtype=float)
        if not moved.any():
            raise InputError(f"{self.where}: no degree of freedom moves along this axis")
        inertia = np.asarray(structure.mass @ moved)
        # -M ι ẍ_b: + (hω)² X M ι cos(hτ + φ) of a displacement.
        size = self.displacement if self.displacement else -self.acceleration
        c, s = inertia * size * np.cos(self.phase), -inertia * size * np.sin(self.phase)
        square = _multiple_of_square(self.harmonic) if self.displacement else None
        return [Term(np.arange(len(names)), c, s, self.harmonic, square)]


Force = HarmonicForce | StaticForce | Unbalance | TabulatedForce | BaseExcitation


def loads_range(forces: Iterable[Force]) -> tuple[float, float]:
    """Return the frequencies between which all forces are known, Hz."""
    ranges = [force.range for force in forces if isinstance(force, TabulatedForce)]
    return max((low for low, _ in ranges), default=0.0), min((high for _, high in ranges), default=np.inf)


def _at(
    structure: Structure, dof: str, cosine: Number, sine: Number, harmonic: int, factor: Factor | None = None
) -> Term:
    row = structure.dofs.index(dof, "a force")
    return Term(np.array([row]), np.array([cosine]), np.array([sine]), harmonic, factor)


def _square(omega: float) -> tuple[float, float]:
    return omega**2, 2 * omega


def _multiple_of_square(harmonic: int) -> Factor:
    return lambda omega: ((harmonic * omega) ** 2, 2 * harmonic**2 * omega)


def _require_varying(where: str, harmonic: int) -> None:
    if harmonic < 1:
        raise InputError(
            f"{where}: the harmonic is {harmonic}; expected 1 or more, and a StaticForce for a force that does not "
            "change"
        )
