"""Modes: free undamped vibrations of a structure, contacts and springs without memory left out."""

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from pydantic import Field

from dalembert.errors import InputError
from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_structure
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.table import StudyTable

if TYPE_CHECKING:
    from dalembert.structure import ModeShapes


class ModesTable(StudyTable):
    """Find the lowest modes of a structure."""

    count: int = Field(10, ge=1, description="how many; at most as many as the structure has degrees of freedom")


class Modes(ResultTask):
    """The task ``[modes]``."""

    name = "modes"
    kind = "dalembert.structure:ModeShapes"
    rank = 12
    of_structures = True
    schema = ModesTable
    needs = (needs_structure,)

    def plan(self, study: Study) -> str:
        structure = study.system().structure
        if structure.nodes is None:
            raise InputError(
                "[modes] draws the shapes, and the structure does not say where its nodes are; the function that "
                "[model.structure] or [model] names must return a structure with nodes=Nodes(...)"
            )
        return f"finds the lowest {_count(study, structure)} of {structure.size} modes: 1 simulation"

    def effort(self, study: Study) -> Effort:
        return Effort(repeatedly(lambda: _shapes(study)), 1, 1, 1, "these modes, found once")

    def unknowns(self, study: Study) -> tuple[str, ...]:
        return ()

    def parts(self, study: Study) -> Iterable[Callable[[], object]]:
        """None: the plan checks all."""
        return ()

    def result(self, study: Study, emit: Emit) -> Any:
        return _shapes(study)

    def outcome(self, study: Study, shapes: "ModeShapes") -> Outcome:
        """Outcome of modes, with their frequencies."""
        values = {f"mode {number}": value for number, value in enumerate(shapes.frequencies.tolist(), start=1)}
        return Outcome(study, shapes, {"values": values})


def _count(study: Study, structure: Any) -> int:
    return min(study.table.count, structure.size)


def _shapes(study: Study) -> "ModeShapes":
    from dalembert.structure import eigenmodes, mode_shapes

    structure = study.system().structure
    return mode_shapes(structure, eigenmodes(structure, _count(study, structure)))
