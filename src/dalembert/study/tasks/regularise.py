"""Regularise: many smooth parameters, such as an unknown history, from measured data."""

from typing import Annotated, Any, Literal

from pydantic import Field

from dalembert.study.run.duration import Effort, evaluated
from dalembert.study.run.events import Emit, teller
from dalembert.study.tables.posing import posed
from dalembert.study.tables.study import Study
from dalembert.study.tables.unused import few, unused_parameters
from dalembert.study.tasks.requirements import needs_parameters, needs_solver, unnamed
from dalembert.study.tasks.task import Outcome, ResultTask
from dalembert.study.text.table import Read, StudyTable, alternative

ROUND = 40
"""Simulations of a round beside its sensitivities, about: ten gradients by the adjoint."""


_WEIGHT: Any = alternative(
    lambda value: isinstance(value, str), Literal["l-curve", "discrepancy"], Annotated[float, Field(gt=0)]
)


class RegulariseTable(StudyTable):
    """Identify many parameters that are smooth, with a penalty on their differences (Tikhonov)."""

    smooth: str | list[str] | None = Field(
        None,
        description="a series of parameters, or names in the order of the history or field, whose differences are "
        "penalised; all if not given",
    )
    order: int = Field(2, ge=1, le=3, description="of the differences")
    weight: Annotated[str | float, Read(_WEIGHT)] = Field(
        "l-curve",
        description="of the penalty: a number, 'l-curve' for the corner of the L-curve, or 'discrepancy' for residuals "
        "as large as the deviations of the data",
    )
    rounds: int = Field(8, ge=1, description="linearisations at most, after each of which the weight is chosen again")
    derivative: Literal["auto", "direct", "adjoint"] = Field(
        "auto", description="gradients: from all sensitivities, from the adjoint, or by the number of parameters"
    )


class Regularise(ResultTask):
    """The task ``[regularise]``."""

    name = "regularise"
    rank = 4
    schema = RegulariseTable
    keeps_responses = True
    kind = "dalembert.inverse:RegularisedFit"
    needs = (needs_parameters, needs_solver)

    def wrong(self, file: Any) -> list[str]:
        wrong, table = super().wrong(file), file.regularise
        if file.data is None:
            wrong.append("[regularise] needs a [data] table")
        elif table.weight == "discrepancy" and file.data.deviations is None:
            wrong.append("[regularise], weight: 'discrepancy' compares with the noise; give deviations in [data]")
        smooth = _smooth(file)
        unused = [name for name in unused_parameters(file) if smooth is None or name in smooth]
        if unused:
            wrong.append(
                f"[regularise], smooth: no number of the model depends on {few(unused)}; use them in the model"
            )
        return [*wrong, *unnamed(smooth or (), file.parameters, "[regularise], smooth")]

    def plan(self, study: Study) -> str:
        model, data = posed(study)
        channels = ", ".join(data.channels)  # pyright: ignore[reportOptionalMemberAccess]
        count = len(model.parameters)  # pyright: ignore[reportAttributeAccessIssue]
        most = study.table.rounds * (ROUND + count)
        return f"identifies {count} smooth parameters from {channels} by at most {most} simulations"

    def effort(self, study: Study) -> Effort:
        model: Any = posed(study)[0]
        per_round = ROUND + len(model.parameters)
        return evaluated(model, model.parameters.start, 2 * per_round, study.table.rounds * per_round)

    def result(self, study: Study, emit: Emit) -> Any:
        from dalembert.inverse import regularise
        from dalembert.inverse.events import as_record

        model, data = posed(study)
        picked = study.table.picked("order", "weight", "rounds", "derivative")
        picked |= {"smooth": _smooth(study.file), "on_event": teller(emit, as_record)}
        return regularise(model, data, **picked)  # type: ignore[arg-type] - one record

    def outcome(self, study: Study, result: Any) -> Outcome:
        """Outcome with the weight, and the number of parameters that the data determine."""
        values = {"weight": result.weight, "effective parameters": result.effective, "residual": result.residual_norm}
        return Outcome(study, result, {"values": values})


def _smooth(file: Any) -> list[str] | None:
    smooth = file.regularise.smooth
    if not isinstance(smooth, str):
        return smooth
    numbered = [name for name in file.parameters if name.removeprefix(f"{smooth}_").isdigit()]
    return numbered or [smooth]
