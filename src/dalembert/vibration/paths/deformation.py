"""The motion of a whole structure at one point of a curve, and what its contacts do there, to be drawn."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.errors import InputError
from dalembert.structure.mode_shapes import drawn_nodes, node_motion
from dalembert.structure.structure import known_nodes
from dalembert.tables import counted, in_words, shown
from dalembert.threads import single_thread
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.fourier import synthesis
from dalembert.vibration.interface.contacts_stuck import ContactsStuck
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.laws.contacts import FrictionContact
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.storage import Over, VibrationResult
from dalembert.vibration.system.system import VibrationSystem


@dataclass(frozen=True, eq=False)
class Deformation(VibrationResult):
    """A periodic motion of a structure at its nodes, as :func:`deformation` returns it.

    Parameters
    ----------
    frequency : float
        Hz.
    orders : tuple of int
        Harmonics; the coefficients are the mean, if it is kept, then a cosine and a sine for each other one.
    places : array, shape (nodes, 3)
        m, at rest.
    faces : array of int, shape (faces, 3 or 4)
        Rows of ``places``; none where the structure has none.
    coefficients : array, shape (nodes, 3, coefficients)
        m.
    contacts : tuple of str
        Names of the friction contacts that lie on nodes.
    contact_places : array, shape (contacts, 3)
        m.
    states : array of uint8, shape (contacts, phases)
        0 separated, 1 stuck, 2 slipping, over the period.
    energies : array, shape (contacts,)
        J, dissipated in a period.
    provenance : mapping
    """

    FORMAT: ClassVar[str] = "dalembert deformation 1"
    TITLE: ClassVar[str] = "Deformed shape"

    frequency: float
    orders: tuple[int, ...]
    places: Annotated[np.ndarray, Over(("node", "axis"), "m")]
    faces: Annotated[np.ndarray, Over(("face", "corner"))]
    coefficients: Annotated[np.ndarray, Over(("node", "axis", "coefficient"), "m")]
    contacts: tuple[str, ...]
    contact_places: Annotated[np.ndarray, Over(("contact", "axis"), "m")]
    states: Annotated[np.ndarray, Over(("contact", "phase"))]
    energies: Annotated[np.ndarray, Over(("contact",), "J")]
    provenance: Mapping[str, Any]

    def motion(self, phases: np.ndarray) -> np.ndarray:
        """Displacements, m, at phases of the period (rad), (phases, nodes, 3)."""
        waves = synthesis(self.orders, np.asarray(phases, dtype=float))
        return np.moveaxis(self.coefficients @ waves.T, -1, 0)

    @property
    def status(self) -> str:
        """What the result is, in a sentence."""
        return "The motion of the whole structure at one point of a response over frequency."

    def facts(self) -> dict[str, str]:
        largest = np.linalg.norm(self.motion(np.linspace(0, 2 * np.pi, 64)), axis=2).max(initial=0.0)
        return {
            "frequency": f"{shown(self.frequency)} Hz",
            "nodes": counted(len(self.places)),
            "largest displacement": in_words(float(largest), "m", 5),
            **({"contacts": counted(len(self.contacts))} if self.contacts else {}),
        }


def deformation(system: VibrationSystem, curve: FrequencyCurve, point: int | None = None) -> Deformation:
    """The motion of all nodes of a structure at one point of a curve; of a reduced structure, of the full one.

    Parameters
    ----------
    system : VibrationSystem
        That of the curve; its structure has nodes.
    curve : FrequencyCurve
    point : int, optional
        Of the curve; that with the largest displacement if not given.

    Raises
    ------
    InputError
        For a point that was not found, a system that is not that of the curve, or a structure that does not say where
        its nodes are.

    Examples
    --------
    >>> from dalembert.structure import Material, Modal, plate
    >>> from dalembert.vibration import HarmonicForce, frequency_response
    >>> square = plate((0.4, 0.4), 2e-3, Material(210e9, 0.3, 7800.0), (4, 4)).fixed("edge").with_damping(Modal(0.01))
    >>> middle = square.nodes.nearest((0.2, 0.2))
    >>> system = VibrationSystem(square)
    >>> force = system.add(HarmonicForce(f"{middle}.z", 1.0))
    >>> curve = frequency_response(system, np.array([100.0, 110.0]), HarmonicBalance(harmonics=1))
    >>> shape = deformation(system, curve)
    >>> shape.coefficients.shape, shape.frequency
    ((25, 3, 3), 110.0)
    """
    nodes = known_nodes(system.structure, "deformation")
    converged = np.flatnonzero(curve.converged)
    chosen = _largest(curve) if point is None else point
    if chosen not in converged:
        raise InputError(
            f"deformation: the point {chosen} was not found; expected one of the {len(converged)} that were"
        )
    motion = node_motion(system.structure, _response(system, curve, chosen))
    kept, faces = drawn_nodes(motion, nodes.faces)
    resting = {element.name: element.first for element in system.elements if isinstance(element, FrictionContact)}
    placed = [name for name in curve.contacts if resting[name] in nodes.names]
    rows = [curve.contacts.index(name) for name in placed]
    owners = [row.rpartition(".")[0] for row in curve.coordinates]
    taken = [curve.dissipated(row)[chosen] for row in curve.coordinates]
    energies = [sum(part for part, owner in zip(taken, owners, strict=True) if owner == name) for name in placed]
    return Deformation(
        frequency=float(curve.frequencies[chosen]),
        orders=curve.orders,
        places=nodes.places[kept],
        faces=faces,
        coefficients=motion[kept],
        contacts=tuple(placed),
        contact_places=nodes.places[nodes.rows([resting[name] for name in placed])].reshape(-1, 3),
        states=curve.states[chosen][rows],
        energies=np.array(energies, dtype=float),
        provenance=dict(curve.provenance),
    )


def _largest(curve: FrequencyCurve) -> int:
    """The point with the largest displacement of an observed degree of freedom; -1 where none was found."""
    moving = [dof for dof in curve.dofs if dof.rpartition(".")[2] in ("x", "y", "z")] or list(curve.dofs)
    sizes = np.max([curve.amplitude(dof) for dof in moving], axis=0)
    return int(np.nanargmax(sizes)) if np.isfinite(sizes).any() else -1


@single_thread()
def _response(system: VibrationSystem, curve: FrequencyCurve, point: int) -> np.ndarray:
    """Coefficients of all degrees of freedom, (size, coefficients), from the unknowns that the curve keeps."""
    method = HarmonicBalance(**curve.provenance["method"])
    lowered = replace(lower(system).real, periods=method.periods)
    if "control" in curve.provenance:
        lowered = lowered.measuring(lowered.structure.dofs.index(curve.provenance["control"]["dof"]))
    highest = 2 * np.pi * float(np.max(curve.frequencies)) / method.periods
    problem = Equations(lowered, method, _stuck=ContactsStuck(lowered, highest))
    balance, unknowns = problem.balance(int(curve.samples[point])), curve.unknowns[point]
    if unknowns.shape != balance.shape or curve.contacts != problem.lowered.contacts:
        raise InputError(
            f"deformation: the curve has unknowns of shape {unknowns.shape} and {len(curve.contacts)} contacts; the "
            f"system has {balance.shape} and {len(problem.lowered.contacts)}; give the system of the curve"
        )
    place = problem.at(problem.omega(curve.frequencies[point]))
    if "control" in curve.provenance:
        place = place.loaded(float(curve.load_factors[point]))
    return problem.motion(place, unknowns, int(curve.samples[point]))
