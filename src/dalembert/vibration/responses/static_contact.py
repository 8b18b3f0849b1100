"""The preload of a joint: static equilibrium with contact and friction."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.kernels.preparation import prepare
from dalembert.tables import Table, cells, counted, in_words, shown
from dalembert.threads import single_thread
from dalembert.vibration.balance.preparation import balance_kernels
from dalembert.vibration.balance.static_equilibrium import Equilibrium, static_equilibrium
from dalembert.vibration.interface.lowering import ELASTIC, FrictionBlock, Lowered, lower
from dalembert.vibration.laws.contacts import FrictionContact
from dalembert.vibration.laws.friction_law import (
    FRICTION,
    GAP,
    LOAD,
    NORMAL,
    SEPARATED,
    SLIPPING,
    STATES,
    STUCK,
    TANGENTIAL,
)
from dalembert.vibration.storage import Over, VibrationResult, versions
from dalembert.vibration.system.requirements import require_still
from dalembert.vibration.system.system import VibrationSystem

LISTED = 20
"""Contacts of the table, those with the largest normal forces."""


@dataclass(frozen=True, eq=False)
class StaticContact(VibrationResult):
    """Static equilibrium of a structure with contacts, as :func:`static_contact` returns it.

    Parameters
    ----------
    dofs : tuple of str
    displacements : array, shape (dofs,)
        m, rad.
    contacts : tuple of str
        Names of the friction contacts.
    normal : array, shape (contacts,)
        Normal forces, N.
    tangential : array, shape (contacts, 2)
        Friction forces on the first node along the tangential directions, N; NaN where there is only one.
    openings : array, shape (contacts,)
        Distances that are left to contact, m; negative where it is closed, NaN without a normal direction.
    states : array of uint8, shape (contacts,)
        0 separated, 1 stuck, 2 slipping.
    contact_places : array, shape (contacts, 3)
        m; NaN where the structure does not say where its nodes are.
    places : array, shape (nodes, 3)
        m, of the structure at rest; none where it does not say where its nodes are.
    faces : array of int, shape (faces, 3 or 4)
        Rows of ``places``.
    residual : float
        Forces that are not balanced, as part of all.
    provenance : mapping
    findings : tuple of Finding
        ``"open-joint"`` where no contact is closed.
    """

    FORMAT: ClassVar[str] = "dalembert static contact 1"
    TITLE: ClassVar[str] = "Static contact"

    dofs: tuple[str, ...]
    displacements: Annotated[np.ndarray, Over(("dof",), "m")]
    contacts: tuple[str, ...]
    normal: Annotated[np.ndarray, Over(("contact",), "N")]
    tangential: Annotated[np.ndarray, Over(("contact", "direction"), "N")]
    openings: Annotated[np.ndarray, Over(("contact",), "m")]
    states: Annotated[np.ndarray, Over(("contact",))]
    contact_places: Annotated[np.ndarray, Over(("contact", "axis"), "m")]
    places: Annotated[np.ndarray, Over(("node", "axis"), "m")]
    faces: Annotated[np.ndarray, Over(("face", "corner"))]
    residual: float
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    @property
    def success(self) -> bool:
        """Whether a contact is closed."""
        return not self.findings

    @property
    def status(self) -> str:
        """What the result is, in a sentence."""
        return "The static equilibrium from which a vibration starts."

    @property
    def friction(self) -> np.ndarray:
        """Sizes of the friction forces, N, (contacts,)."""
        return np.sqrt(np.nansum(np.square(self.tangential), axis=1))

    def displacement(self, dof: str) -> float:
        """Return the displacement of a degree of freedom, m or rad."""
        if dof not in self.dofs:
            raise InputError(f"StaticContact: {dof!r} is not a degree of freedom of the structure")
        return float(self.displacements[self.dofs.index(dof)])

    def facts(self) -> dict[str, str]:
        states = np.asarray(self.states)
        return {
            "contacts": counted(len(self.contacts)),
            **{state: counted(int(np.sum(states == number))) for number, state in enumerate(STATES)},
            "sum of the normal forces": in_words(float(np.sum(self.normal)), "N", 6),
            "largest displacement": in_words(float(np.abs(self.displacements).max()), "m", 5),
            "forces that are not balanced": shown(self.residual, digits=2),
        }

    def tables(self) -> tuple[Table, ...]:
        order = np.argsort(-np.asarray(self.normal), kind="stable")
        few = len(order) <= LISTED
        caption = "Contacts" if few else f"The {LISTED} contacts with the largest normal forces"
        first = Table.of("contacts-at-rest", caption, self._columns(order[:LISTED]))
        every = Table.of("all-contacts-at-rest", "All contacts", self._columns(order), detail=True)
        return (first,) if few else (first, every)

    def _columns(self, rows: np.ndarray) -> dict[str, list[Any]]:
        return {
            "contact": [self.contacts[row] for row in rows],
            "normal force (N)": cells(np.asarray(self.normal)[rows]),
            "friction force (N)": cells(self.friction[rows]),
            "state": [STATES[self.states[row]] for row in rows],
        }


@single_thread()
def static_contact(system: VibrationSystem) -> StaticContact:
    """Return the static equilibrium of a structure under its static forces, with contact and friction.

    Parameters
    ----------
    system : VibrationSystem
        Its static forces, such as those of bolts and gravity, its initial loads and its gaps act; a negative gap is an
        interference. Harmonic forces do not. All loads grow together from nothing.

    Returns
    -------
    StaticContact

    Raises
    ------
    InputError
        Without contacts, or for rigid ones.
    SolveError
        Where the static forces find no equilibrium.

    Examples
    --------
    >>> from dalembert.structure import Dofs, Structure
    >>> from dalembert.vibration import ElasticSlider, FrictionContact, StaticForce, VibrationSystem
    >>> block = Structure(np.eye(2), np.diag([1e3, 0.0]), Dofs(("m.x", "m.z")))
    >>> system = VibrationSystem(block)
    >>> for force in (StaticForce("m.x", 40.0), StaticForce("m.z", 50.0)):
    ...     added = system.add(force)
    >>> foot = FrictionContact("foot", "m", normal="z", friction=0.5, law=ElasticSlider(1e4, normal_stiffness=1e6))
    >>> added = system.add(foot)
    >>> joint = static_contact(system)
    >>> joint.normal.round(9).tolist(), joint.friction.round(9).tolist()  # 40 N on springs of 1e3 and 1e4 N/m: slip
    ([50.0], [25.0])
    >>> round(joint.displacement("m.x"), 9)  # (40 - 25) / 1e3
    0.015
    """
    require_still(system, "static_contact")
    lowered = lower(system).real
    rigid = [lowered.contacts[block.contacts[0]] for block in lowered.blocks if block.kind != ELASTIC]
    if rigid:
        raise InputError(
            f"static_contact: the contact {rigid[0]!r} is rigid; expected elastic ones. Give it an ElasticSlider with "
            "the stiffness of the surfaces"
        )
    if not lowered.contacts:
        raise InputError("static_contact: the system has no friction contact; add one (FrictionContact)")
    prepare(balance_kernels(lowered, events=False, residuals=True, derivatives=False))
    equilibrium = static_equilibrium(lowered)
    normal, tangential, openings, states = _by_contact(lowered, equilibrium)
    places, faces, contact_places = _places(system, lowered)
    return StaticContact(
        dofs=lowered.structure.dofs.names,
        displacements=equilibrium.displacements,
        contacts=lowered.contacts,
        normal=normal,
        tangential=tangential,
        openings=openings,
        states=states,
        contact_places=contact_places,
        places=places,
        faces=faces,
        residual=equilibrium.error,
        provenance={**versions(), "steps": equilibrium.steps},
        findings=_findings(normal, openings),
    )


def _by_contact(lowered: Lowered, equilibrium: Equilibrium) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Normal forces, tangential forces, openings and states of the contacts, of whose cells there may be several."""
    count = len(lowered.contacts)
    normal, tangential, openings = np.zeros(count), np.full((count, 2), np.nan), np.full(count, np.nan)
    states = np.full(count, SEPARATED, dtype=np.uint8)
    moved = lowered.matrix @ equilibrium.displacements
    for block in lowered.blocks:
        np.add.at(normal, block.contacts, block.numbers[:, LOAD])
        tangential[block.contacts, : block.tangents] = equilibrium.forces[block.rows[:, : block.tangents]]
        # A contact slips if one of its cells does.
        np.maximum.at(states, block.contacts, _states(block, moved[block.rows]))
        if block.normal:
            openings[block.contacts] = block.numbers[:, GAP] - moved[block.rows[:, -1]]
            firsts = np.unique(block.contacts, return_index=True)[1]
            normal[block.contacts[firsts]] += equilibrium.forces[block.rows[firsts, -1]]
    return normal, tangential, openings, states


def _states(block: FrictionBlock, moved: np.ndarray) -> np.ndarray:
    """States of cells at displacements (cells, columns)."""
    numbers = block.numbers
    load = numbers[:, LOAD].copy()
    if block.normal:
        load += numbers[:, NORMAL] * (moved[:, -1] - numbers[:, GAP])
    # By the force of the spring without slip: that of a slider which slipped is at its limit.
    trial = numbers[:, TANGENTIAL] * np.linalg.norm(moved[:, : block.tangents], axis=1)
    states = np.where(trial > numbers[:, FRICTION] * load, SLIPPING, STUCK)
    return np.where(load > 0, states, SEPARATED).astype(np.uint8)


def _places(system: VibrationSystem, lowered: Lowered) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nodes and faces of the structure, and places of the contacts; NaN for those that are not on a node."""
    nodes, resting = system.structure.nodes, np.full((len(lowered.contacts), 3), np.nan)
    if nodes is None:
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=int), resting
    firsts = {element.name: element.first for element in system.elements if isinstance(element, FrictionContact)}
    for row, name in enumerate(lowered.contacts):
        if firsts[name] in nodes.names:
            resting[row] = nodes.places[nodes.rows([firsts[name]])[0]]
    faces = np.zeros((0, 3), dtype=int) if nodes.faces is None else nodes.faces
    return nodes.places, faces, resting


def _findings(normal: np.ndarray, openings: np.ndarray) -> tuple[Finding, ...]:
    if np.any(normal > 0):
        return ()
    least = float(np.nanmin(openings, initial=np.inf))
    message = f"No contact is closed: the static forces leave the joint open, at least {shown(least)} m wide."
    advice = "Press it: turn or raise the static forces, or give its contacts an interference (a negative gap)."
    return (Finding("open-joint", "error", {"opening": least}, message, advice),)
