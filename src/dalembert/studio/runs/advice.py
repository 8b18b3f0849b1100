"""The advice of findings as changes to a study: each can be shown before it is made."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from tomlkit import TOMLDocument

from dalembert.studio.editor.entries import first_guess, like, number_of, put, table_at, units_of

Values = Mapping[str, Any]
Best = Mapping[str, float]
Apply = Callable[[TOMLDocument], None]
Advice = Callable[[Values, TOMLDocument, Best], Iterator[tuple[str, Apply]]]
_ADVICE: dict[str, Advice] = {}
_STARTS = {"least-squares": 8, "response-sensitivity": 8}
"""Starts by the names of methods where a study does not give them; 1 of the others."""


@dataclass(frozen=True)
class Change:
    """A change to a study. ``code`` is that of the finding that advises it. ``label`` says what it does, as the text of
    a button. ``apply(document)`` changes a document of tomlkit; comments and order stay.
    """

    code: str
    label: str
    apply: Apply


def changes_of(state: Mapping[str, Any], document: TOMLDocument) -> list[Change]:
    """Return the changes that the findings of a run advise, in their order, each once. ``state`` is that of the run, as
    :meth:`~dalembert.study.run.folder.RunFolder.state` returns it. ``document``, the study of the run, is not changed.
    """
    best = (state.get("best") or {}).get("values") or {}
    findings = state.get("findings") or []
    advised = [change for one in findings for change in changes(one["code"], one["values"], document, best)]
    return list({change.label: change for change in reversed(advised)}.values())[::-1]


def changes(code: str, values: Values, document: TOMLDocument, best: Best) -> list[Change]:
    """Return the changes that a finding advises; none where its advice is no change to this study. ``values`` are those
    of the finding. ``best`` has identified values by the names of their parameters, in SI units.
    """
    advise = _ADVICE.get(code)
    return [] if advise is None else [Change(code, *made) for made in advise(values, document, best)]


def start_from_best(document: TOMLDocument, best: Best) -> bool:
    """Make identified values the first guesses of parameters that have bounds; return whether there are any."""
    parameters = table_at(document, "parameters")
    known = {name: value for name, value in best.items() if name in parameters}
    for name, value in known.items():
        put(parameters, name, start=first_guess(value, parameters[name]))
    return bool(known)


def _advises(*codes: str) -> Callable[[Advice], Advice]:
    """Register what the findings with these codes advise."""

    def register(advise: Advice) -> Advice:
        _ADVICE.update(dict.fromkeys(codes, advise))
        return advise

    return register


@_advises("integration-bias", "integration-bias-unknown", "rough-misfit")
def _finer(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    solver = table_at(document, "solver")
    step = number_of(solver.get("step"))
    if step is not None:
        yield _set_step(solver["step"], step / 2, "half the step")
    for key in ("tolerance", "rtol", "atol"):
        if isinstance(solver.get(key), float):
            yield f"Use a tenth of {key}, {solver[key] / 10:g}", _setting("solver", **{key: solver[key] / 10})


@_advises("skipped-samples")
def _as_samples(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    solver = table_at(document, "solver")
    if number_of(solver.get("step")) is not None:
        yield _set_step(solver["step"], float(values["apart"]), "the distance of the samples as step")


@_advises("slip-rate")
def _slip(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    setting = "slip_rate" if "slip_rate" in values else "slip_velocity"
    for place, joint in enumerate(table_at(document, "model").get("joint", ())):
        if joint.get("name") == values["joint"] and values["proposed"] != values[setting]:
            text = like(joint.get(setting), values["proposed"])
            yield (
                f"Set {setting} to {text}",
                lambda document, place=place, text=text: put(document["model"]["joint"], place, **{setting: text}),
            )  # type: ignore[index]
    step = table_at(document, "solver").get("step")
    if "step" in values and values["step"] < (number_of(step) or 0.0):
        yield _set_step(step, float(values["step"]), "a smaller step")


@_advises("correlated-residuals", "model-misfit", "not-converged", "misfit-above-noise")
def _more_starts(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    table = table_at(document, "identify")
    if "identify" in document:
        method = table.get("method", "least-squares")
        kind = method if isinstance(method, str) else method.get("kind")
        starts = 2 * int(table.get("starts", 3 if table.get("shooting") else _STARTS.get(kind, 1)))
        yield f"Use {starts} starts", _setting("identify", starts=starts)


@_advises("errors-grow")
def _shooting(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    table = table_at(document, "identify")
    if "identify" in document and not table.get("shooting") and "validation" not in table and "sensors" not in document:
        yield "Use multiple shooting", _setting("identify", shooting=True)


@_advises("unidentifiable-parameter", "weakly-identifiable-parameter")
def _fix(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    yield from _fixed([values["parameter"]], document, best)


@_advises("unidentifiable-combination", "indistinguishable-parameters", "partly-converged")
def _fix_one(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    yield from _fixed(str(values["parameters"]).split(", "), document, best)


def _fixed(names: list[str], document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    """Give parameters equal bounds, one a change; at least one other parameter must be left."""
    parameters = table_at(document, "parameters")
    for name in names:
        if name in parameters and name in best and len(parameters) > 1:
            table = parameters[name]
            text = like(table.get("lower"), best[name], table)
            gone = dict.fromkeys(("start", "deviation", "log"))
            yield f"Fix {name} at {text}", _entry("parameters", name, lower=text, upper=text, **gone)


@_advises("parameter-at-bound", "interval-at-bound")
def _widen(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    parameters, name, side = table_at(document, "parameters"), values["parameter"], values["side"]
    table = parameters.get(name, {})
    lower, upper = (number_of(table.get(key)) for key in ("lower", "upper"))
    if lower is None or upper is None:
        return
    wider = upper + (upper - lower) if side == "upper" else lower - (upper - lower)
    if side == "lower" and lower >= 0 and wider < 0:  # what is positive may have to be
        if lower == 0:
            return
        wider = lower / 10
    text = like(table[side], wider, table)
    yield f"Set the {side} bound of {name} to {text}", _entry("parameters", name, **{side: text})


@_advises("suspect-delay")
def _delay(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    channel, most = values["channel"], float(f"{2 * values['delay']:.1g}")
    if channel and most > 0 and channel not in table_at(document, "sensors"):
        label = f"Identify the delay of {channel}, up to {most:g} s"
        yield label, _entry("sensors", channel, delay=[0.0, most])


@_advises("search-stopped")
def _more_runs(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    most = 4 * int(values["most_runs"])
    if "propagate" in document:
        yield f"Allow {most} simulations", _method("propagate", "chebyshev", most_runs=most)


@_advises("sampled-bounds", "linear-bounds")
def _optimise(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    if "propagate" in document:
        yield "Use the method optimise", _setting("propagate", method="optimise")


@_advises("unknown-error")
def _compare(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    table = table_at(document, "propagate")
    if "propagate" in document and "compare" not in table and table.get("method", "chebyshev") != "chebyshev":
        yield "Compare with the method chebyshev", _setting("propagate", compare=["chebyshev"])


@_advises("few-harmonics", "stability-near-fold")
def _more_harmonics(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    most = 2 * int(values["harmonics"]) + 1
    if table_at(document, "harmonic_balance").get("harmonics") != "auto":
        yield f"Keep {most} harmonics", _setting("harmonic_balance", harmonics=most)
        if "error" in values:
            yield "Choose the harmonics by the truncation error", _setting("harmonic_balance", harmonics="auto")
    elif "error" in values:
        yield f"Allow {most} harmonics", _setting("harmonic_balance", most_harmonics=most)
    else:
        yield f"Keep at least {most} harmonics", _setting("harmonic_balance", least_harmonics=most)


@_advises("beam-locking")
def _structural(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    for place, body in enumerate(table_at(document, "model").get("body", ())):
        if body.get("name") == values["body"]:
            yield (
                "Use the structural formulation",
                lambda document, place=place: put(document["model"]["body"], place, formulation="structural"),
            )  # type: ignore[index]


@_advises("late-samples")
def _from_first(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    if "start" not in table_at(document, "data") and "data" in document:
        yield "Start the motion with the record", _setting("data", start="first")


@_advises("paving-unfinished")
def _coarser(values: Values, document: TOMLDocument, best: Best) -> Iterator[tuple[str, Apply]]:
    most = table_at(document, "identify_set").get("most_boxes")
    if most is not None:
        yield f"Allow {4 * int(most)} boxes", _setting("identify_set", most_boxes=4 * int(most))


def _set_step(given: object, step: float, words: str) -> tuple[str, Apply]:
    text = like(given, step)
    return f"Use {words}, {text}{'' if units_of(text) else ' s'}", _setting("solver", step=text)


def _setting(name: str, **entries: Any) -> Apply:
    """Set entries of a table of the document."""
    return lambda document: put(document, name, **entries)


def _entry(table: str, name: str, **entries: Any) -> Apply:
    """Set entries of a table within a table of the document."""

    def apply(document: TOMLDocument) -> None:
        if table not in document:
            put(document, table)
        put(document[table], name, **entries)

    return apply


def _method(task: str, default: str, **entries: Any) -> Apply:
    """Set entries of a task's method, which may be given by its name alone."""

    def apply(document: TOMLDocument) -> None:
        method = document[task].get("method", default)  # type: ignore[union-attr]
        given = {"kind": method} if isinstance(method, str) else {}
        put(document[task], "method", **given, **entries)

    return apply
