"""Pictures of models as SVG, for pages, notebooks and documentation."""

from dalembert.report.pictures.model import picture

__all__ = ["picture"]
