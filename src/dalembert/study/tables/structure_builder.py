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
        from dalembert.vibration import VibrationSystem

        values = named_values(self.constants, parameters)
        parts = {name: self._parts(name, values) for name in ("spring", "force", "contact")}
        linear = [one for one in parts["spring"] if isinstance(one, LinearSpring)]
        system = VibrationSystem(self._structure(values, linear))
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
        found = [
            [node for node in sets[name] if known is None or known.has_node(node)] if name in sets else [name]
            for name in names
        ]
        return [name for own in found for name in own]

    @property
    def _table(self) -> StructureTable:
        return self.model.structure or StructureTable.model_validate({})

    def _parts(self, name: str, values: Mapping[str, Any]) -> list[Any]:
        found = []
        for number, table in enumerate(getattr(self.model, name), start=1):
            where = f"[[model.{name}]] {repr(table.name) if hasattr(table, 'name') else f'number {number}'}"
            found.append(_told(where, built, table, values, where))
        return found

    def _structure(self, values: Mapping[str, Any], springs: list[LinearSpring]) -> "Structure":
        """Matrices with their loss, then springs, then the damping, then the dampers beside the springs."""
        from dalembert.structure.springs import with_springs

        base = self._lumped(values) if self.model.mass else self._reduced
        if self._table.loss_factor is not None:
            where = "[model.structure], loss_factor"
            base = _told(where, base.with_loss, resolved(self._table.loss_factor, values, where))
        ends = [(one.first, one.second) for one in springs]
        stiff = [(*pair, one.stiffness, 0.0, one.loss_factor) for pair, one in zip(ends, springs, strict=True)]
        damped = [(*pair, 0.0, one.damping) for pair, one in zip(ends, springs, strict=True)]
        whole = _told("[[model.spring]]", with_springs, base, stiff)
        if self._table.damping is not None:
            damping = built(self._table.damping, values, "[model.structure], damping")
            whole = _told("[model.structure], damping", whole.with_damping, damping)
        return with_springs(whole, damped)

    def _lumped(self, values: Mapping[str, Any]) -> "Structure":
        from dalembert.structure import lumped

        masses = self._parts("mass", values)
        dofs = {f"{one.name}.{direction}": one.mass for one in masses for direction in one.directions}
        return _told("[[model.mass]]", lumped, dofs, [])

    @cached_property
    def _matrices(self) -> "Structure":
        return _told("[model.structure]", self._read)

    def _read(self) -> "Structure":
        from dalembert.structure import Structure, read_structure

        table = self._table
        if table.function is not None:
            whole = table.function.fitting(**table.arguments)(**table.arguments)
            if not isinstance(whole, Structure):
                raise InputError(f"{table.function} returned a {type(whole).__name__}; expected a Structure")
        else:
            path: Any = table.file or table.files
            whole = read_structure(path, table.names or None, table.dofs, table.directions)
        held = [one for name in table.fixed for one in table.sets.get(name, [name])]
        return whole.fixed(held) if held else whole

    @cached_property
    def _reduced(self) -> "Structure":
        from dalembert.structure import craig_bampton

        reduction = self._table.reduction
        if reduction is None:
            return self._matrices
        masters = [*self._moved(), *self.expanded(reduction.masters), *self.expanded(self.watched)]
        return _told("[model.structure], reduction", craig_bampton, self._matrices, masters, reduction.modes)

    def _moved(self) -> list[str]:
        found = [force.dof for force in self.model.force]
        for spring in self.model.spring:
            ends = spring.dofs if hasattr(spring, "dofs") else (spring.first, spring.second)
            found += [end for end in ends if end is not None]
        for contact in self.model.contact:
            axes = [*(contact.tangential or ("x",)), *([contact.normal] if contact.normal else [])]
            ends = [end for end in (contact.first, contact.second) if end is not None]
            found += [f"{end}.{axis.removeprefix('-')}" for end in ends for axis in axes]
        return list(dict.fromkeys(found))


def _told(where: str, function: Any, *arguments: Any) -> Any:
    try:
        return function(*arguments)
    except DalembertError as error:
        text = re.sub(r"^\w+ '[^']*': ", "", str(error))
        raise type(error)(text if text.startswith("[") else f"{where}: {text}") from None
