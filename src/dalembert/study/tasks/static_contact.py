"""Static contact: the equilibrium of a structure under its static forces, with contact and friction."""

from typing import Any

from pydantic import Field

from dalembert.structure import Dofs
from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks.requirements import needs_structure
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.table import StudyTable, naming, placed


class StaticContactTable(StudyTable):
    """Compute the static equilibrium of a structure with contact and friction."""

    observe: list[str] = Field(
        default_factory=list, description="degrees of freedom whose displacements are among the values of the run"
    )


class StaticContactTask(ResultTask):
    """The task ``[static_contact]``."""

    name = "static_contact"
    kind = "dalembert.vibration:StaticContact"
    rank = 13
    of_structures = True
    schema = StaticContactTable
    needs = (needs_structure,)

    def plan(self, study: Study) -> str:
        with placed("[static_contact], observe"):
            study.system().structure.dofs.rows(study.table.observe)
        return "computes the static equilibrium with contact and friction: 1 simulation"

    def effort(self, study: Study) -> Effort:
        return Effort(repeatedly(lambda: _equilibrium(study)), 1, 1, 1, "the equilibrium")

    def result(self, study: Study, emit: Emit) -> Any:
        return _equilibrium(study)

    def outcome(self, study: Study, joint: Any) -> Outcome:
        """Outcome of an equilibrium, with the sum of its normal forces and the number of closed contacts."""
        numbers = {"sum of normal forces": float(joint.normal.sum()), "closed": float((joint.states > 0).sum())}
        rows = Dofs(joint.dofs).rows(study.table.observe)
        moved = {joint.dofs[row]: float(joint.displacements[row]) for row in rows}
        numbers |= {"slipping": float((joint.states == 2).sum())}
        return Outcome(study, joint, {"values": numbers | moved})


def _equilibrium(study: Study) -> Any:
    from dalembert.vibration import static_contact

    system = study.system()
    with naming("model"):
        return static_contact(system)
