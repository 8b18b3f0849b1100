"""Modes of free bodies as a study file writes them: of a box, of a mesh in a file, or by a function."""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

from dalembert.arguments import Checked
from dalembert.errors import InputError, shown
from dalembert.multibody.components.fields import Number, number
from dalembert.structure.free_body_modes import FreeBodyModes
from dalembert.study.tables.dataclass_tables import Written


@dataclass(frozen=True, kw_only=True)
class Homogeneous(Checked, Written):
    """A body of one material. The reduction is made once; the modulus and the density scale it."""

    KIND: ClassVar[str]

    youngs_modulus: Number = number("Pa", above=0)
    poisson_ratio: float = field(metadata={"unit": ""})
    density: Number = number("kg/m**3", above=0)
    interfaces: Mapping[str, str | list[str]] = field(default_factory=dict)
    modes: int = 12
    element: str | None = None
    gauges: Mapping[str, list[list[float]]] = field(default_factory=dict)

    @property
    @abstractmethod
    def source(self) -> tuple[Any, ...]:
        """What the mesh is made of: a path and its time, or a size and numbers of elements."""

    @property
    def value(self) -> FreeBodyModes:
        nodes = tuple((name, members if isinstance(members, str) else tuple(members))
                      for name, members in self.interfaces.items())  # fmt: skip
        for name, ends in self.gauges.items():
            if [len(end) for end in ends] != [3, 3]:
                raise InputError(f"gauge {name!r} is {shown(ends)}; expected the positions of its two ends, in m")
        gauges = tuple((name, tuple(map(tuple, ends))) for name, ends in self.gauges.items())
        unit = _unit_modes(self.source, float(self.poisson_ratio), nodes, self.modes, gauges, self.element)
        return unit.scaled(self.youngs_modulus, self.density)


@dataclass(frozen=True, kw_only=True)
class BoxBody(Homogeneous):
    """A box of bricks between its corner and the opposite one.

    Parameters
    ----------
    size : (float, float, float)
        Along x, y and z, m.
    elements : (int, int, int)
    youngs_modulus : float
        Pa.
    poisson_ratio : float
    density : float
        kg/m^3.
    interfaces : mapping of str to str
        Interface nodes: each is tied to the nodes of a side: left, right (x), front, back (y), bottom, top (z).
    modes : int
        Number of modes beside the static shapes.
    element : str, optional
        Kind of element, as of :func:`dalembert.structure.solid`.
    gauges : mapping of str to two (float, float, float)
        Strain gauges for sensors: positions of their ends, m; the nearest nodes are taken.
    """

    KIND = "box"
    size: tuple[float, float, float] = field(metadata={"unit": "m"})
    elements: tuple[int, int, int]

    @property
    def source(self) -> tuple[Any, ...]:
        return tuple(self.size), tuple(self.elements)


@dataclass(frozen=True, kw_only=True)
class MeshBody(Homogeneous):
    """A mesh of bricks or tetrahedra in a file of Gmsh, Abaqus, Nastran or VTK.

    Parameters
    ----------
    mesh : path
    youngs_modulus : float
        Pa.
    poisson_ratio : float
    density : float
        kg/m^3.
    interfaces : mapping of str to str or list of str
        Interface nodes: each is tied to nodes of the mesh, or to its named sets.
    modes : int
        Number of modes beside the static shapes.
    element : str, optional
        Kind of element, as of :func:`dalembert.structure.solid`.
    gauges : mapping of str to two (float, float, float)
        Strain gauges for sensors: positions of their ends, m; the nearest nodes are taken.
    """

    KIND = "mesh"
    mesh: Path = field(metadata={"table": "DataFile"})

    @property
    def source(self) -> tuple[Any, ...]:
        return str(self.mesh), self.mesh.stat().st_mtime_ns  # a mesh that was edited is another one


@dataclass(frozen=True, kw_only=True)
class FunctionBody(Checked, Written):
    """What a Python function returns: FreeBodyModes.

    Parameters
    ----------
    function : callable
    arguments : mapping
        Of the function.
    """

    KIND: ClassVar[str] = "function"
    function: Callable[..., Any]
    arguments: Mapping[str, Any] = field(default_factory=dict)

    @property
    def value(self) -> FreeBodyModes:
        modes = self.function(**self.arguments)
        if not isinstance(modes, FreeBodyModes):
            raise InputError(f"the function returned a {type(modes).__name__}; expected {FreeBodyModes.IN_WORDS}")
        return modes


@cache
def _unit_modes(
    source: tuple[Any, ...],
    poisson_ratio: float,
    interfaces: tuple[Any, ...],
    modes: int,
    gauges: tuple[Any, ...],
    element: str | None,
) -> Any:
    """Modes of a body with a Young's modulus and a density of 1."""
    from dalembert.structure import Material, box, free_body_modes, solid, strain_between

    mesh = source[0] if isinstance(source[0], str) else box(*source)
    structure = solid(mesh, Material(1.0, poisson_ratio, 1.0), element)
    nodes: Any = structure.nodes
    recovery = {name: strain_between(structure, *map(nodes.nearest, ends)) for name, ends in gauges}
    return free_body_modes(structure, dict(interfaces), modes, recovery)


FREE_BODIES = (BoxBody, MeshBody, FunctionBody)
