"""The headline of something identified."""

from collections.abc import Mapping

from dalembert.inverse import BandFit, Fit
from dalembert.report.headline import Headline


def identified(fit: Fit | BandFit, title: str, facts: Mapping[str, str]) -> Headline:
    """Headline of something identified, with what speaks against it."""
    doubts = tuple(doubt.message for doubt in fit.doubts) if fit.success else ()
    verdict = "not identified" if not fit.success else "identified, with doubts" if doubts else "identified"
    return Headline(title=title, verdict=verdict, success=fit.success, status=fit.status, facts=facts, doubts=doubts)
