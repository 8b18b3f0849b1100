"""Evidence: numbers that tests compare with published ones, kept for the validation page."""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import ArrayLike


@dataclass(frozen=True)
class Evidence:
    """One row of the validation page; values of more than one entry are kept as their number of entries."""

    topic: str
    quantity: str
    unit: str
    source: str
    published: float | int
    ours: float | None
    difference: float
    tolerance: float | None
    relative: bool
    noisy: bool


def compare(
    quantity: str,
    published: ArrayLike,
    ours: ArrayLike,
    *,
    tolerance: float | None,
    topic: str,
    source: str,
    unit: str = "",
    relative: bool = False,
    noisy: bool = False,
) -> Evidence:
    """Evidence that ``ours`` lies within ``tolerance`` of ``published``; AssertionError where it does not.

    Without a tolerance the numbers only stand beside each other, as where the published model is not described whole.

    Parameters
    ----------
    published, ours : array-like of the same shape
    tolerance : float or None
        Largest allowed absolute difference; with ``relative``, as a part of the largest published magnitude.
    noisy : bool
        The difference is rounding noise, which another machine need not repeat: the page prints no digit of it.
    """
    expected, given = np.asarray(published, dtype=float), np.asarray(ours, dtype=float)
    assert expected.shape == given.shape, f"{quantity}: shapes {expected.shape} (published) and {given.shape} (ours)"
    difference = float(np.max(np.abs(given - expected))) / (float(np.max(np.abs(expected))) if relative else 1.0)
    assert tolerance is None or difference <= tolerance, (
        f"{quantity}: ours {given} and the published {expected} differ by {difference:.3g}"
        f"{' relative' if relative else ''}; allowed: {tolerance:g} ({source})"
    )
    single = expected.ndim == 0
    return Evidence(
        topic,
        quantity,
        unit,
        source,
        float(expected) if single else expected.size,
        float(given) if single else None,
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
    """Assert and record: ``record_evidence(quantity, published, ours, tolerance=..., topic=..., source=...)``."""

    def record(*args: object, **options: object) -> None:
        row = compare(*args, **options)  # type: ignore[arg-type]
        request.node.user_properties.append(("evidence", json.dumps(asdict(row))))  # text passes between processes

    return record
