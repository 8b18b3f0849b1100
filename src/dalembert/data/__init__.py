"""Measured data in."""

from dalembert.data.csv_file import read_csv
from dalembert.data.measurements import Measurements

__all__ = ["Measurements", "read_csv"]
