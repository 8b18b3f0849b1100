"""Measured data in."""

from dalembert.data.bands import Bands
from dalembert.data.csv_file import read_bands, read_csv
from dalembert.data.measurements import Measurements

__all__ = ["Bands", "Measurements", "read_bands", "read_csv"]
