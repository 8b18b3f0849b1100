"""Figures, one function each, and a report that opens without a network; for notebooks and run folders alike."""

from dalembert.report import charts
from dalembert.report.gather import figures
from dalembert.report.look import dark
from dalembert.report.page import report

__all__ = ["charts", "dark", "figures", "report"]
