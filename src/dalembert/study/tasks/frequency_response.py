"""Frequency response: periodic responses of a structure over frequency, or a family of them over one parameter."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field

from dalembert.errors import DalembertError, InputError, unknown
from dalembert.study.run.duration import Effort, repeatedly
from dalembert.study.run.events import Emit
from dalembert.study.tables.study import Study
from dalembert.study.tasks import curve_supplements
from dalembert.study.tasks.backbone import BackboneTable
from dalembert.study.tasks.curve_supplements import compare_in_time_table, family_supplements, single_curve_supplements
from dalembert.study.tasks.requirements import needs_structure, unnamed
from dalembert.study.tasks.sweep import Along, values_along
from dalembert.study.tasks.task import Outcome, Task, silent
from dalembert.study.text.numbers import Frequencies, FrequencyEnds, fixed
from dalembert.study.text.table import Read, StudyTable, placed

if TYPE_CHECKING:
    from dalembert.vibration import FollowedPoint, HarmonicBalance

MOST_DRAWN = 6
"""Degrees of freedom that a figure shows by themselves; of more the report chooses."""
VISCOUS = {"stability": "stability", "compare_in_time": "motions in time", "backbone": "nonlinear modes"}
"""What is not defined with hysteretic damping, by the key that asks for it."""


class FamilyTable(StudyTable):
    """A curve for each of several values of one parameter."""

    parameter: str = Field(description="such as a preload; the others keep their first guesses")
    values: Along = Field(
        description="a list, a range, or { count = 9 } between the bounds; the first is what reductions are measured by"
    )


class HeldAmplitudeTable(StudyTable):
    """An amplitude that is held by a factor of the forces."""

    dof: str = Field(description="whose first harmonic is held: 'tip.x'")
    amplitude: Annotated[float, Read(fixed("m"))] = Field(gt=0, description="of its first harmonic")


class FrequencyResponseTable(StudyTable):
    """Follow the periodic response of a structure over frequency."""

    frequencies: Frequencies | None = Field(None, description="of the points: a list, or a range")
    between: FrequencyEnds | None = Field(
        None, description="two frequencies, from the first to the second with as many points as the curve needs"
    )
    continuation: Literal["natural", "arc-length"] = Field(
        "natural", description="'arc-length' goes past folds, and needs between"
    )
    observe: list[str] | None = Field(
        None, min_length=1, description="degrees of freedom, nodes or sets whose motion is kept; 'm2' or 'm2.x'"
    )
    dof: str | None = Field(None, description="whose peak is reported; the first observed one if not given")
    amplitude: str = Field("peak", description="'peak', 'rms', or 'harmonic 1' and so on")
    stability: bool = Field(False, description="whether to find which points are stable, and where that changes")
    control: HeldAmplitudeTable | None = Field(None, description="an amplitude that a controller of the forces holds")
    branches: bool = Field(
        False, description="whether to follow the branches at branch points and period doublings; needs stability"
    )
    isolated: Frequencies | None = Field(
        None, description="at which branches are sought that the curve does not pass, by a path over the forces"
    )
    deformed: bool = Field(
        True,
        description="whether the report draws the motion at the peak, where the structure says where its nodes are",
    )
    compare_in_time: Any = None
    backbone: BackboneTable | None = Field(None, description="a nonlinear mode beside the curve")
    sweep: FamilyTable | None = Field(None, description="a curve for each value of a parameter")

    def _wrong(self) -> list[str]:
        wrong = []
        if (self.frequencies is None) == (self.between is None):
            stated = (
                "neither frequencies nor between is" if self.between is None else "frequencies and between are both"
            )
            wrong.append(f"{stated} given; expected one of them")
        if self.continuation == "arc-length" and self.between is None:
            wrong.append("continuation: a path by arc length finds its own frequencies; give between = [begin, end]")
        ends = self.between or [1.0, 2.0]
        for value in (*(self.frequencies or ()), *ends):
            if not value > 0:
                wrong.append(f"the frequency {value:g} Hz was given; expected positive ones")
                break
        if self.control is not None:
            refused = {
                "continuation = 'arc-length'": self.continuation == "arc-length",
                "stability": self.stability,
                "compare_in_time": self.compare_in_time is not None,
                "isolated": self.isolated is not None,
            }
            wrong += [
                f"control: a held amplitude does not go with {what}; leave one of them out"
                for what, present in refused.items()
                if present
            ]
        if self.branches and not (self.stability and self.continuation == "arc-length"):
            wrong.append("branches: they begin at markers; give stability = true and continuation = 'arc-length'")
        if self.isolated is not None and self.between is None:
            wrong.append("isolated: the range of its branches is missing; give between = [begin, end]")
        outside = [value for value in self.isolated or () if not min(ends) <= value <= max(ends)]
        if outside and self.between is not None:
            wrong.append(f"isolated: {outside[0]:g} Hz lies outside between; expected frequencies inside")
        if ends[0] == ends[1]:
            wrong.append(f"between: {ends[0]:g} Hz was given twice; expected two different frequencies")
        return wrong

    @property
    def along(self) -> Any:
        """Frequencies as :func:`~dalembert.vibration.responses.frequency_response` takes them."""
        return tuple(self.between) if self.between is not None else np.array(self.frequencies)


class Response(Outcome):
    """A curve, or a family of them."""

    @property
    def supplements(self) -> list[Any]:
        """What the report shows beside the result: its branches by their names."""
        from dalembert.vibration import FrequencyCurve

        branches = {
            name.replace("_", " "): result
            for name, result in self.further_results.items()
            if isinstance(result, FrequencyCurve)
        }
        others = [result for result in self.further_results.values() if not isinstance(result, FrequencyCurve)]
        return [*others, branches] if branches else others

    @property
    def summary(self) -> str:
        peaks = "".join(f"\n{name}: {value:.6g}" for name, value in self.best.get("values", {}).items())
        more = "".join(f"\n\n{result.summary()}" for result in self.further_results.values())
        return self.result.summary() + peaks * (self.study.table.amplitude != "peak") + more


def _best(table: FrequencyResponseTable, result: Any) -> dict[str, Any]:
    dof = table.dof or result.dofs[0]
    if table.sweep is None:
        if not result.converged.any():
            return {}
        peak = result.peak(dof, table.amplitude)
        return {"values": {f"{table.amplitude} of {dof}": peak.amplitude, "frequency (Hz)": peak.frequency}}
    best = result.best(dof, table.amplitude)
    row = result.values.tolist().index(best)
    peak, part = result.peaks(dof, table.amplitude)[row], result.reduction(dof, table.amplitude)[row]
    peaks = {
        f"{table.amplitude} of {dof}": peak.amplitude,
        "frequency (Hz)": peak.frequency,
        "reduction": float(part),
    }
    return {"values": {table.sweep.parameter: best, **peaks}}


def drawn_dofs(table: FrequencyResponseTable, result: Any) -> tuple[str, ...]:
    """The degrees of freedom that figures show: that of the stated peak first, then those that were asked for."""
    chosen = tuple(name for name in result.dofs if table.dof in (name, name.rpartition(".")[0]))
    observed = () if table.observe is None or len(result.dofs) > MOST_DRAWN else result.dofs
    return tuple(dict.fromkeys((*chosen, *observed)))


def _response(study: Study, result: Any, further_results: Mapping[str, Any]) -> Response:
    dofs = drawn_dofs(study.table, result)
    if study.table.dof is not None and study.table.sweep is None:  # else its peak might be that of another one
        dofs = tuple(name for name in dofs if study.table.dof in (name, name.rpartition(".")[0]))
    options = {"dofs": dofs, "amplitude": study.table.amplitude}
    return Response(study, result, _best(study.table, result), options, further_results)


class FrequencyResponseTask(Task):
    """The task ``[frequency_response]``."""

    name = "frequency_response"
    rank = 9
    of_structures = True
    schema = FrequencyResponseTable
    needs = (needs_structure,)

    def keys(self) -> dict[str, Any]:
        described = Field(None, description="points of the curve in time")
        return {"compare_in_time": (compare_in_time_table() | None, described)}

    def wrong(self, file: Any) -> list[str]:
        table = file.frequency_response
        wrong = super().wrong(file)
        if table.sweep is not None:
            wrong += unnamed([table.sweep.parameter], file.parameters, "[frequency_response], sweep")
            wrong += [
                f"[frequency_response], {key}: it belongs to one curve, and sweep makes several; leave one of them out"
                for key in ("compare_in_time", "backbone", "branches", "isolated")
                if getattr(table, key)
            ]
        return wrong

    def plan(self, study: Study) -> str:
        from dalembert.vibration.paths.amplitudes import Amplitude
        from dalembert.vibration.system.requirements import require_viscous

        table, problem = study.table, study.equations()
        for key, what in VISCOUS.items():
            if getattr(table, key):
                with placed(f"[frequency_response], {key}"):
                    require_viscous(problem.lowered.structure, what)
        names = problem.lowered.structure.dofs.names
        if table.observe is not None:
            with placed("[frequency_response], observe"):
                names = [names[row] for row in problem.lowered.structure.rows(_observed(study) or [])]
        if table.control is not None:
            with placed("[frequency_response], control"):
                problem.lowered.structure.dofs.index(table.control.dof)
        if table.dof is not None and not any(
            name == table.dof or name.rpartition(".")[0] == table.dof for name in names
        ):
            raise InputError(unknown("observed degree of freedom", table.dof, names, "[frequency_response], dof"))
        with placed("[frequency_response], amplitude"):
            Amplitude(table.amplitude, balance_of(study).first().orders)
        points = "as many points as the curve needs" if table.between else f"{len(table.frequencies)} points"
        ends = table.between or (table.frequencies[0], table.frequencies[-1])
        way = f"follows the response from {ends[0]:g} to {ends[1]:g} Hz ({points}, {balance_of(study).words})"
        if table.sweep is None:
            return f"{way}: 1 simulation"
        values = _values(study)
        return f"{way} for {len(values)} values of {table.sweep.parameter}: {len(values)} simulations"

    def effort(self, study: Study) -> Effort:
        from dalembert.vibration import frequency_response

        table, system = study.table, study.system()
        ends = np.array(table.between or (table.frequencies[0], table.frequencies[-1]))

        def once() -> None:
            options = curve_options(study) | {"checkpoint": None, "stability": False, "continuation": "natural"}
            frequency_response(system, ends, balance_of(study), check=False, **options)

        curves = 1 if table.sweep is None else len(_values(study))
        count = None if table.between is not None else curves * len(table.frequencies)
        return Effort(repeatedly(once), 2, count, count, "a point, going by both ends of the curve")

    def parts(self, study: Study) -> Iterable[Callable[[], object]]:
        """The curve, or those of a family; and the nonlinear mode beside it."""
        table = study.table
        parts: list[Callable[[], object]] = [partial(self.run, study, silent)]
        if table.sweep is not None:
            parts.append(partial(_any_curve, study))
        if table.backbone is not None:
            parts.append(lambda: table.backbone.follow(study, study.system()))
        return parts

    def run(self, study: Study, emit: Emit) -> Outcome:
        from dalembert.vibration import frequency_response, frequency_responses

        table = study.table
        options = curve_options(study)
        if table.sweep is None:
            emit("following", begin=float(table.along[0]), end=float(table.along[-1]))
            study.equations()
            system = study.system()
            tell = _point_events(study, emit)
            curve = frequency_response(system, table.along, balance_of(study), on_point=tell, **options)
            return _response(study, curve, single_curve_supplements(study, curve, system))
        name, values = table.sweep.parameter, _values(study)
        unit = next(item.unit for item in study.parameters if item.name == name)

        def on_curve(row: int, curve: Any, failure: str | None) -> None:
            details: dict[str, Any] = {"parameter": name, "value": float(values[row])}
            if curve is not None and curve.converged.any():
                dof = table.dof or curve.dofs[0]
                peak = curve.peak(dof, table.amplitude)
                details |= {"dof": dof, "amplitude": peak.amplitude, "frequency": peak.frequency}
            converged = None if curve is None else int(curve.converged.sum())
            emit("swept", **details, done=row + 1, total=len(values), points=converged, failure=failure)

        family = frequency_responses(
            study.along(name),
            name,
            values,
            table.along,
            balance_of(study),
            unit=unit,
            executor=study.executor,
            on_curve=on_curve,
            **options,
        )
        return _response(study, family, family_supplements(study, family))

    def load(self, study: Study, path: Path) -> Outcome:
        from dalembert.vibration import CurveFamily, FrequencyCurve

        kind = FrequencyCurve if study.table.sweep is None else CurveFamily
        return _response(study, kind.load(path), curve_supplements.load(path))


def balance_of(study: Study) -> "HarmonicBalance":
    """The method, which keeps the harmonic whose amplitude is reported if it chooses their number."""
    from dalembert.vibration.paths.amplitudes import highest_order

    return study.balance.keeping(highest_order(study.table.amplitude))


def curve_options(study: Study) -> dict[str, Any]:
    """Settings of a curve, or of each curve of a family."""
    from dalembert.vibration import HeldAmplitude

    table = study.table
    settings = table.picked("continuation", "stability")
    if table.control is not None:
        settings["control"] = HeldAmplitude(table.control.dof, table.control.amplitude)
    return {**settings, "observe": _observed(study), "checkpoint": study.checkpoint}


def _any_curve(study: Study) -> None:
    """Follow the first curve of a family that can be; a family fails only if all its curves do."""
    from dalembert.vibration import frequency_response

    build, errors = study.along(study.table.sweep.parameter), []
    for value in _values(study).tolist():
        try:
            system = build(**{study.table.sweep.parameter: value})
            frequency_response(system, study.table.along, balance_of(study), **curve_options(study))
            return
        except DalembertError as error:
            errors.append(error)
    raise errors[0]


def _point_events(study: Study, emit: Emit) -> Callable[["FollowedPoint"], None]:
    from dalembert.vibration.paths.amplitudes import Amplitude

    kind, dof = study.table.amplitude, study.table.dof

    def tell(point: "FollowedPoint") -> None:
        names = (dof, *(name for name in point.dofs if name.rpartition(".")[0] == dof), *point.dofs)
        row = next(point.dofs.index(name) for name in names if name in point.dofs)
        amplitude = float(Amplitude(kind, point.orders).of(point.response[row]))
        emit(
            "followed", frequency=point.frequency, amplitude=amplitude, dof=point.dofs[row],
            done=round(point.done, 4), harmonics=point.orders[-1],
        )  # fmt: skip

    return tell


def _observed(study: Study) -> list[str] | None:
    names = study.table.observe
    expanded = getattr(study.builder, "expanded", None)
    return names if names is None or expanded is None else expanded(names)


def _values(study: Study) -> np.ndarray:
    """Values of the swept parameter, (values,)."""
    sweep = study.table.sweep
    return values_along(study.parameters, sweep.parameter, sweep.values)
