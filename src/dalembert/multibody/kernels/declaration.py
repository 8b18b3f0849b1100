"""What a kind of component declares: columns, properties, and functions that kernels loop over components."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from dalembert.errors import ModelError
from dalembert.multibody.kernels.charts import Chart, flat
from dalembert.multibody.kernels.constraints import power_of, rates_of, residual_of

SWITCHES = ("delay", "stribeck")
"""Columns of the package's kinds that decide branches: whether they are zero."""


@dataclass(frozen=True, eq=False)
class Declaration:
    """A kind of component as its file declares it: its data columns, its properties, and its functions.

    Functions get local vectors ``x v a`` (coordinates, then multipliers), the component's numbers ``p`` and integers
    ``m`` by the names of their columns, and ``inputs`` (signals and callbacks). They are compiled for real and for
    complex numbers. What they may call are functions under :func:`dalembert.kernels.kernel.inner`.

    ``coordinates``, ``multipliers``: numbers of local ones; ``numbers``, ``integers``: names of columns; ``reactions``:
    number of multipliers of a joint that the component depends on, its local unknowns behind the coordinates; ``home``:
    module that holds the kind, where its functions come from another module; ``lengths``: columns that count to the
    extent of a mechanism, m; ``gravity``: columns of the gravity that acts on the component.

    ``residual(x, v, a, p, m, inputs, r)`` adds to ``r`` (zero before) what the component adds to the left side of the
    equations of motion M a + J^T lambda - Q = 0: applied forces with the opposite sign.
    ``constraint(x, p, m, inputs, g)`` fills ``g`` (multipliers,), which are zero where the joint is closed. Its time
    derivatives and the constraint forces follow by automatic differentiation; a signal's value is
    ``signal(inputs, number)``.
    ``forces(x, p, m, r)`` adds the constraint forces J^T lambda by a formula, where that is faster; lambda stand in
    ``x`` behind the coordinates. A test compares it with the automatic ones.
    ``energy(x, v, p, m, inputs)`` returns the kinetic and the potential energy, J, and the power, W, of the forces
    without a potential, negative where they dissipate. Without it, all forces count as power.
    ``mean(x, v, a, p, m, inputs, step, r)``: as ``residual``, of a step from x - step v / 2 to x + step v / 2, with
    forces whose work is the change of the potential energy and step times ``mean_power(x, v, p, m, inputs, step)``, W,
    the power of those without a potential. `EnergyMomentum` takes both.
    ``observe(x, v, a, p, m, inputs, out)`` fills the ``outputs`` (name, unit); ``observes_inputs``: whether these
    depend on signals, which are evaluated only then.
    ``angles``: outputs that are angles which are known up to whole turns. (``angle`` is one where the integer ``wraps``
    is 1.) The integration counts their turns; an output with ``rate`` for ``angle`` in its name is the rate.
    ``turn(x, v, p, m, out)`` fills angle and rate of each of them: less work at each step than all outputs.

    ``chart``: of a kind whose constraints are the internal ones of its coordinates: how increments change these.
    Integrators that support it solve for the increments, without these constraints and their multipliers. ``charts``:
    those of the coordinates, one after the other, `flat` ones between them; none if all are flat.
    ``dissipates``: whether a force depends on velocities; or the columns of which any entry that is not zero says so;
    () if it never does. Without it RadauIIA and the variational methods leave damping out of Newton's matrix, and
    converge more slowly or not. ``varying_mass``, likewise: whether the masses that it adds change with the
    coordinates. Some integrators need masses that do not. ``rotor``: these masses as constant ones of one more
    coordinate: a constraint that ties it to those of the kind, and its inertia. Their numbers and integers are columns
    of the kind.
    ``is_usual``: whether its kernels are compiled ahead by `dalembert compile`; else where a model first needs them.
    ``strains(x, length)``: in Python, strains (count, -) of components with local coordinates ``x`` (count,
    coordinates), in real and in complex numbers; ``references``: the columns of their values without stress. With both,
    statics takes stresses as separate unknowns, and needs far fewer iterations.
    ``driven``, ``loads``: whether a prescribed motion, or a load, may do work.
    ``holds``: whether a component on the ground keeps the mechanism from moving freely, as joints and springs do. It
    then has the columns ``a_kind b_kind`` (integers) and ``a_x a_y b_x b_y`` of two markers, in space ``a_z b_z`` too.
    ``holds_frame``: whether it then holds the direction of a ground point, not only the point. ``lanes``: whether the
    functions take eight samples side by side, in one call: no branch depends on the state, but `where` selects;
    branches on numbers ask `is_zero`. By default kinds of the package do, kinds of users do not.
    """

    name: str
    coordinates: int
    numbers: tuple[str, ...]
    integers: tuple[str, ...] = ()
    multipliers: int = 0
    reactions: int = 0
    residual: Callable[..., Any] | None = None
    constraint: Callable[..., Any] | None = None
    forces: Callable[..., Any] | None = None
    energy: Callable[..., Any] | None = None
    mean: Callable[..., Any] | None = None
    mean_power: Callable[..., Any] | None = None
    outputs: tuple[tuple[str, str], ...] = ()
    observe: Callable[..., Any] | None = None
    angles: tuple[str, ...] = ()
    turn: Callable[..., Any] | None = None
    home: str = ""
    observes_inputs: bool = False
    lengths: tuple[str, ...] = ()
    gravity: tuple[str, ...] = ()
    chart: Chart | None = None
    charts: tuple[Chart, ...] = ()
    dissipates: bool | str | tuple[str, ...] = False
    varying_mass: bool | str | tuple[str, ...] = False
    rotor: Any = None
    is_usual: bool = True
    strains: Callable[..., Any] | None = None
    references: tuple[str, ...] = ()
    driven: bool = False
    loads: bool = False
    holds: bool = False
    holds_frame: bool = True
    lanes: bool | None = None

    def __post_init__(self) -> None:
        sizes = [chart.size for chart in self.parts]
        if sum(sizes) != self.coordinates:
            raise ModelError(
                f"kind {self.name!r}: its charts have {' + '.join(map(str, sizes))} coordinates, the kind has "
                f"{self.coordinates}. Add flat(size) for coordinates without internal constraints"
            )

    @cached_property
    def is_built_in(self) -> bool:
        """Whether it is a kind of the package."""
        return (self.module or "").startswith("dalembert.")

    @cached_property
    def takes_lanes(self) -> bool:
        """Whether eight samples may run side by side."""
        return self.is_built_in if self.lanes is None else self.lanes

    @cached_property
    def switch_columns(self) -> list[int]:
        """Positions of the numbers that may decide branches: any of those of a user's kind."""
        return [place for place, name in enumerate(self.numbers) if not self.is_built_in or name in SWITCHES]

    @property
    def takes_duals(self) -> bool:
        """Whether the functions take dual numbers, for derivatives along eight directions at once."""
        return self.is_built_in or self.takes_lanes

    @property
    def parts(self) -> tuple[Chart, ...]:
        """Charts of all coordinates."""
        return (self.chart,) if self.chart is not None else self.charts or (flat(self.coordinates),)

    @cached_property
    def width(self) -> int:
        """Local unknowns."""
        return self.coordinates + self.multipliers + self.reactions

    @property
    def increments(self) -> int:
        """Local increments of the coordinates."""
        return sum(chart.increments for chart in self.parts)

    @property
    def is_flat(self) -> bool:
        """Whether increments are simply those of the coordinates."""
        return all(chart.is_flat for chart in self.parts)

    @property
    def takes_reactions(self) -> bool:
        """Whether a force depends on a joint's multipliers, so that the equations of motion are nonlinear in them."""
        return self.reactions > 0

    @cached_property
    def integer_record(self) -> np.dtype:
        return np.dtype([(name, "i8") for name in self.integers or ("unused",)])

    @property
    def number_names(self) -> tuple[str, ...]:
        """Columns of numbers in memory, at least one."""
        return self.numbers or ("unused",)

    def number_record(self, dtype: type) -> np.dtype:
        return np.dtype([(name, "c16" if dtype is complex else "f8") for name in self.number_names])

    @cached_property
    def length_columns(self) -> list[int]:
        """Positions of the columns that count to the extent of a mechanism."""
        return self.columns(self.lengths)

    def columns(self, names: tuple[str, ...]) -> list[int]:
        """Positions of columns of numbers."""
        return [self.numbers.index(name) for name in names]

    def dissipative(self, numbers: np.ndarray) -> bool:
        """Whether a force of components with these numbers (count, -) depends on velocities."""
        return self._shown(self.dissipates, numbers)

    def varies(self, numbers: np.ndarray) -> bool:
        """Whether masses of components with these numbers (count, -) change with the coordinates."""
        return self._shown(self.varying_mass, numbers)

    @property
    def varying(self) -> tuple[str, ...]:
        """The columns of masses that change with the coordinates."""
        given = self.varying_mass
        return (given,) if isinstance(given, str) else given if isinstance(given, tuple) else ()

    def _shown(self, given: bool | str | tuple[str, ...], numbers: np.ndarray) -> bool:
        if isinstance(given, bool):
            return given
        return bool(np.any(numbers[:, self.columns((given,) if isinstance(given, str) else given)]))

    @property
    def turns(self) -> bool:
        """Whether outputs may be angles that are known up to whole turns."""
        return bool(self.angles) or "wraps" in self.integers

    def turning(self, integers: Sequence[int]) -> list[int]:
        """Outputs that are angles known up to whole turns, of a component with these integers."""
        wraps = "wraps" in self.integers and integers[self.integers.index("wraps")] == 1
        names = {*self.angles, "angle"} if wraps else self.angles
        return [output for output, (name, _) in enumerate(self.outputs) if name in names]

    @cached_property
    def roles(self) -> frozenset[str]:
        """Roles that the kind has kernels of."""
        acts = self.residual is not None or self.constraint is not None
        roles = {
            **dict.fromkeys(("residual", "tangent", "pullback"), acts),
            **dict.fromkeys(("mean", "mean_tangent"), self.mean is not None),
            "mean_power": self.mean_power is not None,
            "rates": self.constraint is not None,
            "energy": self.energy is not None or self.residual is not None,
            "outputs": self.observe is not None,
            "turn": self.turn is not None and bool(self.angles),
            **dict.fromkeys(("spread", "change", "restore"), self.chart is not None),
        }
        return frozenset(role for role, known in roles.items() if known)

    def has(self, role: str) -> bool:
        """Whether the kind has kernels of this role."""
        return role in self.roles

    @cached_property
    def residual_function(self) -> Callable[..., Any]:
        """What fills the local residual: forces, then constraints."""
        if self.constraint is not None:
            return residual_of(self.constraint, self.forces, self.coordinates, self.multipliers)
        assert self.residual is not None, self.name
        return self.residual

    @cached_property
    def rates_function(self) -> Callable[..., Any]:
        """What fills the time derivatives of the constraints."""
        assert self.constraint is not None, self.name
        return rates_of(self.constraint, self.multipliers)

    @cached_property
    def energy_function(self) -> Callable[..., Any]:
        """What returns energies and power; without a function of the kind's, all that its forces do is power."""
        if self.energy is not None:
            return self.energy
        assert self.residual is not None, self.name
        return power_of(self.residual, self.width)

    @property
    def source(self) -> Callable[..., Any]:
        """A function of the file that defines the kind."""
        return self.residual or self.constraint or self.observe  # type: ignore[return-value] - one of them is there

    @property
    def module(self) -> str | None:
        """Module that holds the kind."""
        return self.home or self.source.__module__
