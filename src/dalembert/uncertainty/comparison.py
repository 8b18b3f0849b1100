"""Bounds over the same box by several methods."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.contents import Contents
from dalembert.errors import ClusterError, DalembertError, InputError, StorageError
from dalembert.findings import Finding, stored_findings
from dalembert.forward import Executor, ForwardModel, on_cluster, takes_executor
from dalembert.results import EndedResult, stored_settings
from dalembert.tables import Table, cell, cells, counted
from dalembert.uncertainty.events import OnEvent
from dalembert.uncertainty.method import Method
from dalembert.uncertainty.methods import label, method_of
from dalembert.uncertainty.propagate import Intervals, box_of, propagate
from dalembert.uncertainty.propagation import Propagation

USUAL = ("vertex", "taylor", "latin-hypercube", "monte-carlo", "chebyshev", "optimise")


@dataclass(frozen=True)
class ComparedMethod:
    """One method in a comparison: mean width of its bands, and distance from the reference over all bounds.

    Width and distances are in the channels' units; ``largest`` and ``rms`` are zero for the reference itself.
    """

    method: str
    kind: str
    width: float
    largest: float
    rms: float
    runs: int
    seconds: float
    success: bool


@dataclass(frozen=True, eq=False)
class Comparison(EndedResult):
    """Bounds by several methods over the same box.

    Parameters
    ----------
    results : tuple of Propagation
    reference : str
        ``method`` of the result that the others are measured by.
    refused : tuple of (str, str)
        The methods that gave no bounds, and why not.
    """

    FORMAT: ClassVar[str] = "dalembert comparison 1"
    TITLE: ClassVar[str] = "Methods compared"
    VERDICTS: ClassVar[tuple[str, str]] = ("compared", "incomplete")

    results: tuple[Propagation, ...]
    reference: str
    refused: tuple[tuple[str, str], ...] = ()

    @property
    def rows(self) -> tuple[ComparedMethod, ...]:
        """A row a method, in the order of ``results``."""
        reference = self.reference_result
        rows = []
        for result in self.results:
            apart = np.abs([result.lower - reference.lower, result.upper - reference.upper])
            sizes = float(result.width.mean()), float(apart.max()), float(np.sqrt(np.mean(apart**2)))
            rows.append(ComparedMethod(result.method, result.kind, *sizes, result.runs, result.seconds, result.success))
        return tuple(rows)

    @property
    def success(self) -> bool:
        """Whether every method gave its bounds and came to its end."""
        return not self.refused and all(result.success for result in self.results)

    @property
    def outcome(self) -> tuple[Finding, ...]:
        """What is compared, and which methods failed."""
        failed = [result.method for result in self.results if not result.success]
        failed += [method for method, _ in self.refused]
        if failed:
            message = f"Not successful: {', '.join(failed)}. The table of methods has the reasons."
            return (Finding("methods-failed", "error", {"methods": ", ".join(failed)}, message),)
        message = f"Bounds of one response over one box. The error is the distance to {self.reference}."
        return (Finding("methods-compared", "note", {"reference": self.reference}, message),)

    @property
    def reference_result(self) -> Propagation:
        """The result that the others are compared with."""
        return next(result for result in self.results if result.method == self.reference)

    def facts(self) -> dict[str, str]:
        return {
            "methods": counted(len(self.results) + len(self.refused)),
            "reference": self.reference,
            "its runs": counted(self.reference_result.runs),
            "runs altogether": counted(sum(result.runs for result in self.results)),
        }

    def tables(self) -> tuple[Table, ...]:
        """Return the bounds of each method: their width, their distance from the reference, and their cost."""
        rows, reference = [], self.reference_result
        for row, result in zip(self.rows, self.results, strict=True):
            is_reference = result is reference
            errors = (np.nan, np.nan) if is_reference else (row.largest, row.rms)
            note = "the reference" if is_reference else "" if result.success else result.status
            cost = (row.runs, cell(row.seconds, digits=3), cell(note, mark=not result.success))
            rows.append((row.method, row.kind, row.width, *cells(errors, 3), *cost))
        rows += [(method, "none", *[np.nan] * 5, cell(reason, mark=True)) for method, reason in self.refused]
        names = ("method", "kind", "mean width", "largest error", "rms error", "runs", "time (s)", "note")
        caption = "Methods on the same box; errors are distances from the reference"
        return (Table.of_rows("methods", caption, names, rows),)

    def summary(self) -> str:
        """Return the methods as a table, then the status of each."""
        return "\n".join([super().summary(), *(f"{result.method}: {result.status}" for result in self.results)])

    def contents(self) -> Contents:
        """All results as arrays over the dimension ``method``; what a method does not know is NaN."""
        parts = [result.contents() for result in self.results]
        of_parts = [{"attributes": part.attributes, "variables": list(part.variables)} for part in parts]
        variables = {}
        for name, (over, like, *_) in {name: entry for part in parts for name, entry in part.variables.items()}.items():
            missing = ((), np.full(np.shape(like), np.nan))
            over = (over,) if isinstance(over, str) else over
            variables[name] = ("method", *over), np.stack([part.variables.get(name, missing)[1] for part in parts])
        coordinates = {**parts[0].coordinates, "method": ("method", [result.method for result in self.results])}
        settings = {
            "results": of_parts,
            "refused": self.refused,
            "findings": stored_findings(self.findings),
            "outcome": stored_findings(self.outcome),
        }
        facts = {"format": self.FORMAT, "status": self.status, "reference": self.reference}
        return Contents(variables, coordinates, facts | {"settings": json.dumps(settings, sort_keys=True)})

    @classmethod
    def from_xarray(cls, dataset: Any) -> "Comparison":
        """The comparison that :meth:`to_xarray` turned into a dataset."""
        settings = stored_settings(dataset)
        results = tuple(
            Propagation.from_xarray(
                dataset.isel(method=number)[settings_here["variables"]].assign_attrs(settings_here["attributes"])
            )
            for number, settings_here in enumerate(settings["results"])
        )
        return cls(results, str(dataset.attrs["reference"]), tuple(map(tuple, settings["refused"])))


@takes_executor
@takes_checked("seed", "reference")
def compare(
    model: ForwardModel,
    intervals: Intervals,
    methods: Sequence[Method | str] = USUAL,
    *,
    reference: Method | str = "optimise",
    seed: int = 0,
    on_event: OnEvent | None = None,
    executor: Executor = None,
) -> Comparison:
    """Bounds by several methods over the same box, and how far each lies from a reference.

    Parameters
    ----------
    model, intervals, seed, on_event
        As for :func:`propagate`.
    methods : sequence of str or settings
        The reference is added if it is not among them.
    reference : str or settings
    executor : str or distributed.Client, optional
        Address of a Dask cluster, such as ``"tcp://10.0.0.1:8786"``, or a client of one, to which batches go.

    Returns
    -------
    Comparison

    Raises
    ------
    InputError
        As :func:`propagate`; for a method that is given twice with the same settings.
    SolveError
        If the reference gives no bounds. Another method that gives none stands in ``refused`` with its reason.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.forward import PythonModel
    >>> bump = PythonModel(lambda x: np.array([1 - x**2]), {"x": (-2.0, 2.0)}, ["y"], np.zeros(1))
    >>> for row in compare(bump, {"x": (-1.0, 1.0)}, ["vertex", "taylor"], reference="scan").rows:
    ...     print(row.method, row.width, row.largest)
    vertex 0.0 1.0
    taylor 0.0 1.0
    scan 1.0 0.0
    """
    model = on_cluster(model, executor)
    chosen, known = [method_of(method) for method in methods], method_of(reference)
    chosen += [known] if known not in chosen else []
    labels = [label(method) for method in chosen]
    for name in labels:
        if labels.count(name) > 1:
            raise InputError(f"compare: method {name!r} is given {labels.count(name)} times; give each once")
    box = box_of(model, intervals)
    results, refused = [], []
    for method in chosen:
        try:
            results.append(propagate(model, box, method, seed=seed, on_event=on_event))
        except DalembertError as error:
            if method == known or isinstance(error, StorageError | ClusterError):
                raise
            refused.append((label(method), str(error)))
    return Comparison(tuple(results), label(known), tuple(refused))
