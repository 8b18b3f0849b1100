"""Findings on a search: whether it converged, and which simulations failed."""

from collections.abc import Iterator

from dalembert.errors import counted
from dalembert.findings import Finding


def converged(success: bool, reason: str, message: str = "Converged.") -> Finding:
    """Return whether a search converged; ``reason`` is why it stopped."""
    if success:
        return Finding("converged", "note", {"reason": reason}, message)
    return Finding("not-converged", "error", {"reason": reason}, f"Not converged: {reason}.")


def failed_simulations(failures: list[str]) -> Iterator[Finding]:
    """Yield a finding if simulations failed; ``failures`` are their reasons."""
    if failures:
        failed = f"{counted(len(failures), 'simulation')} failed and {'were' if len(failures) > 1 else 'was'} left out"
        message = f"{failed}; the first: {failures[0]}."
        yield Finding("failed-simulations", "note", {"failures": len(failures), "first": failures[0]}, message)
