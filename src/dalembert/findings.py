"""What a method concludes about its result, as data: programs decide on codes, people read messages."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

Severity = Literal["note", "warning", "error"]


@dataclass(frozen=True)
class Finding:
    """One conclusion about a result.

    Parameters
    ----------
    code : str
        Identifies the conclusion for programs, for example ``"correlated-residuals"``. Later versions keep it.
    severity : {"note", "warning", "error"}
        A note informs. A warning is a reason to doubt the result. With an error, the result must not be used as it is.
    values : mapping of str to float, int, str or bool
        The numbers and names of the message, in SI units.
    message : str
        What the conclusion is, in one or two sentences.
    advice : str
        What to do, in one or two sentences; may be empty.

    Examples
    --------
    >>> found = Finding("few-samples", "warning", {"samples": 3}, "The record has 3 samples.", "Use a longer record.")
    >>> print(found)
    The record has 3 samples. Use a longer record.
    >>> found.doubtful
    True
    """

    code: str
    severity: Severity
    values: Mapping[str, Any] = field(hash=False)
    message: str
    advice: str = ""

    @property
    def doubtful(self) -> bool:
        """Return True if the finding is a reason to doubt the result."""
        return self.severity != "note"

    def __str__(self) -> str:
        return f"{self.message} {self.advice}".strip()


def stored_findings(findings: Iterable[Finding]) -> list[dict[str, Any]]:
    """Return findings as JSON can hold them; :func:`findings_of` reads them."""
    return [asdict(finding) for finding in findings]


def findings_of(stored: Iterable[Mapping[str, Any]]) -> tuple[Finding, ...]:
    """Return the findings that :func:`stored_findings` stored."""
    return tuple(Finding(**finding) for finding in stored)
