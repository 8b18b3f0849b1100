"""What a result concludes, by the codes of its findings."""

from typing import Any

from dalembert.findings import Finding


def codes(result: Any) -> list[str]:
    """Return the codes of all findings of a result."""
    return [item.code for item in _all(result)]


def only(result: Any, code: str) -> Finding:
    """Return the only finding of a result that has a code."""
    (found,) = [item for item in _all(result) if item.code == code]
    return found


def _all(result: Any) -> tuple[Finding, ...]:
    return getattr(result, "conclusions", result.findings)
