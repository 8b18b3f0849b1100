"""Results and models as HTML for notebooks, without scripts and without a network."""

from dalembert.report.notebook.summary import Summary, html_of, shown_in_notebook

__all__ = ["Summary", "html_of", "shown_in_notebook"]
