"""Modes: free undamped vibrations of a structure, contacts and springs without memory left out."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import Field

from dalembert.errors import InputError
from dalembert.study.table import StudyTable
from dalembert.study.tasks.result import ResultOutcome
from dalembert.study.tasks.task import Outcome, Task
from dalembert.study.tasks.wrong import needs_structure

if TYPE_CHECKING:
    from dalembert.structure import ModeShapes
    from dalembert.study.duration import Effort
    from dalembert.study.events import Emit
    from dalembert.study.study import Study


class ModesTable(StudyTable):
    """Find the lowest modes of a structure."""

    count: int = Field(10, ge=1, description="how many; at most as many as the structure has degrees of freedom")


class Modes(Task):
    """The task ``[modes]``."""

    name = "modes"
    rank = 12
    of_structures = True

    def table(self) -> type[StudyTable]:
        return ModesTable

    def wrong(self, file: Any) -> list[str]:
        return needs_structure(file, "modes")

    def plan(self, study: "Study") -> str:
        structure = study.system().structure
        if structure.nodes is None:
            raise InputError(
                "[modes] draws the shapes, and the structure does not say where its nodes are; let a function of "
                "[model.structure] or [model] give it nodes"
            )
        return f"finds the lowest {_count(study, structure)} of {structure.size} modes: 1 simulation"

    def effort(self, study: "Study") -> "Effort":
        from dalembert.study.duration import Effort, whole

        return Effort(whole(lambda: _shapes(study)), 1, 1, 1, "these modes, found once")

    def unknowns(self, study: "Study") -> tuple[str, ...]:
        return ()

    def parts(self, study: "Study") -> Iterable[Callable[[], object]]:
        """None: the plan checks all."""
        return ()

    def run(self, study: "Study", emit: "Emit") -> Outcome:
        return _outcome(study, _shapes(study))

    def load(self, study: "Study", path: Path) -> Outcome:
        from dalembert.structure import ModeShapes

        return _outcome(study, ModeShapes.load(path))


def _count(study: "Study", structure: Any) -> int:
    return min(study.table.count, structure.size)


def _shapes(study: "Study") -> "ModeShapes":
    from dalembert.structure import eigenmodes, mode_shapes

    structure = study.system().structure
    return mode_shapes(structure, eigenmodes(structure, _count(study, structure)))


def _outcome(study: "Study", shapes: "ModeShapes") -> Outcome:
    """Outcome of modes, with their frequencies."""
    values = {f"mode {number}": value for number, value in enumerate(shapes.frequencies.tolist(), start=1)}
    return ResultOutcome(study, shapes, {"values": values})
