"""The function from parameters to a VibrationSystem that a study file's structure is."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from dalembert.errors import DalembertError, InputError
from dalembert.study.tables.builder import built, named_values
from dalembert.study.tables.model_table import ModelTable
from dalembert.study.tables.structure_parts import LinearSpring
from dalembert.study.tables.structure_table import StructureTable
from dalembert.study.text.expressions import Expression, resolved

if TYPE_CHECKING:
    from dalembert.structure import Structure
    from dalembert.vibration import VibrationSystem


@dataclass(frozen=True)
class StructureBuilder:
    """A structure written as data, called like any builder: ``builder(preload=80.0)``.

    Numbers may be complex; they pass from a parameter to a mass, a spring, a force or a contact through arithmetic
    alone. Matrices of a file or a function are read, clamped and reduced once.

    Parameters
    ----------
    model : ModelTable
    constants : mapping of str to float or Expression
    watched : tuple of str
        Degrees of freedom, nodes or sets whose motion is asked for, which a reduction keeps.
    """

    model: ModelTable
    constants: Mapping[str, float | Expression]
    watched: tuple[str, ...] = ()

    def __call__(self, **parameters: complex) -> "VibrationSystem":
        from dalembert.structure import with_rotors
        from dalembert.vibration import VibrationSystem

        values = named_values(self.constants, parameters)
        parts = {name: self._parts(name, values) for name in ("spring", "rotor", "force", "contact")}
        linear = [spring for spring in parts["spring"] if isinstance(spring, LinearSpring)]
        structure = _placed("[[model.rotor]]", with_rotors, self._structure(values, linear), parts["rotor"])
        speed = self.model.speed
        if speed is not None and not isinstance(speed, str):
            speed = resolved(speed, values, "[model], speed")
        system = _placed("[model], speed", VibrationSystem, structure, speed)
        for part in (*parts["force"], *parts["spring"], *parts["contact"]):
            if not isinstance(part, LinearSpring):
                system.add(part)
        return system

    def full(self) -> "Structure":
        """The matrices as they were read, clamped but not reduced."""
        return self._matrices

    def expanded(self, names: Iterable[str]) -> list[str]:
        """Names with the nodes of sets in the place of these, as far as these nodes are not clamped."""
        sets, known = self._table.sets, self._matrices.dofs if self._table.source else None
        expansions = [
            [node for node in sets[name] if known is None or known.has_node(node)] if name in sets else [name]
            for name in names
        ]
        return [name for names_here in expansions for name in names_here]

    @property
    def _table(self) -> StructureTable:
        return self.model.structure or StructureTable.model_validate({})

    def _parts(self, name: str, values: Mapping[str, Any]) -> list[Any]:
        result = []
        for number, table in enumerate(getattr(self.model, name), start=1):
            where = f"[[model.{name}]] {repr(table.name) if hasattr(table, 'name') else f'number {number}'}"
            result.append(_placed(where, built, table, values, where))
        return result

    def _structure(self, values: Mapping[str, Any], springs: list[LinearSpring]) -> "Structure":
        """Matrices with their loss, then springs, then the damping, then the dampers beside the springs."""
        from dalembert.structure.springs import with_springs

        base = self._lumped(values) if self.model.mass else self._reduced
        if self._table.loss_factor is not None:
            where = "[model.structure], loss_factor"
            base = _placed(where, base.with_loss, resolved(self._table.loss_factor, values, where))
        ends = [(spring.first, spring.second) for spring in springs]
        stiff = [(*pair, spring.stiffness, 0.0, spring.loss_factor) for pair, spring in zip(ends, springs, strict=True)]
        damped = [(*pair, 0.0, spring.damping) for pair, spring in zip(ends, springs, strict=True)]
        structure = _placed("[[model.spring]]", with_springs, base, stiff)
        if self._table.damping is not None:
            damping = built(self._table.damping, values, "[model.structure], damping")
            structure = _placed("[model.structure], damping", structure.with_damping, damping)
        return with_springs(structure, damped)

    def _lumped(self, values: Mapping[str, Any]) -> "Structure":
        from dalembert.structure import lumped

        masses = self._parts("mass", values)
        dofs = {f"{mass.name}.{direction}": mass.mass for mass in masses for direction in mass.directions}
        return _placed("[[model.mass]]", lumped, dofs, [])

    @cached_property
    def _matrices(self) -> "Structure":
        return _placed("[model.structure]", self._read)

    def _read(self) -> "Structure":
        from dalembert.structure import Structure, read_structure

        table = self._table
        if table.function is not None:
            structure = table.function.fitting(**table.arguments)(**table.arguments)
            if not isinstance(structure, Structure):
                raise InputError(f"{table.function} returned a {type(structure).__name__}; expected a Structure")
        else:
            path: Any = table.file or table.files
            structure = read_structure(path, table.names or None, table.dofs, table.directions)
        clamped = [node for name in table.fixed for node in table.sets.get(name, [name])]
        return structure.fixed(clamped) if clamped else structure

    @cached_property
    def _reduced(self) -> "Structure":
        from dalembert.structure import craig_bampton

        reduction = self._table.reduction
        if reduction is None:
            return self._matrices
        masters = [*self._moved(), *self.expanded(reduction.masters), *self.expanded(self.watched)]
        return _placed("[model.structure], reduction", craig_bampton, self._matrices, masters, reduction.modes)

    def _moved(self) -> list[str]:
        dofs = [dof for force in self.model.force for dof in _places(force, ("dof", "first", "second"))]
        for part in self.model.rotor:
            dofs += [*_places(part, ("first", "second")), *(getattr(part, "other", None) or ())]
        for spring in self.model.spring:
            ends = spring.dofs if hasattr(spring, "dofs") else (spring.first, spring.second)
            dofs += [end for end in ends if end is not None]
        for contact in self.model.contact:
            axes = [*(contact.tangential or ("x",)), *([contact.normal] if contact.normal else [])]
            ends = [end for end in (contact.first, contact.second) if end is not None]
            dofs += [f"{end}.{axis.removeprefix('-')}" for end in ends for axis in axes]
        return list(dict.fromkeys(dofs))


def _places(part: Any, keys: tuple[str, ...]) -> list[str]:
    """Degrees of freedom that a table names by some of these keys."""
    return [dof for key in keys if (dof := getattr(part, key, None)) is not None]


def _placed(where: str, function: Any, *arguments: Any) -> Any:
    try:
        return function(*arguments)
    except DalembertError as error:
        text = re.sub(r"^\w+ '[^']*': ", "", str(error))
        raise type(error)(text if text.startswith("[") else f"{where}: {text}") from None
