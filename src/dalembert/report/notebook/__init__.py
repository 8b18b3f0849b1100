"""Results and models as HTML for notebooks, without scripts and without a network."""

from dalembert.report.notebook.contents import html_of, shown_in_notebook
from dalembert.report.notebook.page import Summary

__all__ = ["Summary", "html_of", "shown_in_notebook"]
