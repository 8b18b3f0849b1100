"""Figures, one function each, and a report that opens without a network; for notebooks and run folders alike."""

from dalembert.report import charts
from dalembert.report.contents import figures
from dalembert.report.look import dark
from dalembert.report.page import report
from dalembert.report.registry import sections_of
from dalembert.report.section import Part
from dalembert.report.table import Table, cell

__all__ = ["Part", "Table", "cell", "charts", "dark", "figures", "report", "sections_of"]
