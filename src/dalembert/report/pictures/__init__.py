"""Pictures of models as SVG, for pages, notebooks and documentation."""

from dalembert.report.pictures.canvas import message_picture
from dalembert.report.pictures.model import picture

__all__ = ["message_picture", "picture"]
