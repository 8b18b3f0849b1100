"""Evidence: numbers that tests compare with references, kept for the validation pages."""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import ArrayLike

KINDS = (
    "published",  # a number or a rule in a paper, a book, a benchmark collection
    "closed form",  # a formula
    "other code",  # a program that shares no code with dalembert
    "other method",  # another method for the same problem, of the test or of dalembert
    "conservation law",  # energy, momentum, constraints
    "known truth",  # data made with known parameters or noise
    "target",  # an accuracy or a cost that dalembert aims at
)
"""Kinds of references."""


@dataclass(frozen=True)
class Evidence:
    """One row of a validation page. Of several values it keeps the one with the largest reference, of zeros the worst."""

    topic: str
    quantity: str
    unit: str
    kind: str
    source: str
    count: int
    reference: float
    ours: float
    difference: float
    tolerance: float | None
    relative: bool
    noisy: bool


def compare(
    quantity: str,
    reference: ArrayLike,
    ours: ArrayLike,
    *,
    tolerance: float | None,
    topic: str,
    kind: str,
    source: str,
    unit: str = "",
    relative: bool = False,
    noisy: bool = False,
) -> Evidence:
    """Return the evidence that ``ours`` agrees with ``reference`` within ``tolerance``.

    Parameters
    ----------
    reference, ours : array-like of the same shape
    tolerance : float or None
        Largest allowed absolute difference; with ``relative``, relative to the largest magnitude of ``reference``. With
        None nothing is asserted, as where the published model is not fully described.
    kind : str
        Kind of the reference, one of ``KINDS``.
    noisy : bool
        The difference is rounding noise, which another machine need not repeat: the page shows "≤" and the tolerance.

    Raises
    ------
    AssertionError
        If the difference exceeds the tolerance, the shapes differ or the kind is unknown.
    """
    assert kind in KINDS, f"{quantity}: '{kind}' is not one of the kinds of references {KINDS}"
    expected, computed = np.asarray(reference, dtype=float), np.asarray(ours, dtype=float)
    assert expected.shape == computed.shape, (
        f"{quantity}: shapes {expected.shape} (reference) and {computed.shape} (ours)"
    )
    sizes = np.abs(expected if np.any(expected) else computed)
    largest = np.unravel_index(np.argmax(sizes), expected.shape)
    difference = float(np.max(np.abs(computed - expected))) / (float(np.abs(expected[largest])) if relative else 1.0)
    assert tolerance is None or difference <= tolerance, (
        f"{quantity}: ours {computed} and the reference {expected} differ by {difference:.3g}"
        f"{' relative' if relative else ''}; tolerance: {tolerance:g} ({kind}: {source})"
    )
    return Evidence(
        topic,
        quantity,
        unit,
        kind,
        source,
        expected.size,
        float(expected[largest]),
        float(computed[largest]),
        difference,
        tolerance,
        relative,
        noisy,
    )


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--evidence", type=Path, help="write the evidence of this run to this JSON file")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--evidence") is not None and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Collector(config.getoption("--evidence")))


class Collector:
    """Gathers the rows from the tests' reports, which come from this process or from several, and writes them."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.rows: list[object] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "teardown":
            self.rows += [json.loads(str(value)) for name, value in report.user_properties if name == "evidence"]

    def pytest_sessionfinish(self) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text(json.dumps(self.rows, indent=1))


@pytest.fixture
def record_evidence(request: pytest.FixtureRequest) -> Callable[..., None]:
    """Assert and record: ``record_evidence(quantity, reference, ours, tolerance=..., topic=..., kind=..., source=...)``."""

    def record(*args: object, **options: object) -> None:
        row = compare(*args, **options)  # type: ignore[arg-type]
        request.node.user_properties.append(("evidence", json.dumps(asdict(row))))  # text passes between processes

    return record
