"""Measured data in."""

from dalembert.data.bands import Bands
from dalembert.data.bands_file import read_bands
from dalembert.data.columns import Columns
from dalembert.data.derivative import Derivative, derivative
from dalembert.data.format import Format, Request
from dalembert.data.measurements import Measurements, merged
from dalembert.data.readers import read, read_trials

__all__ = [
    "Bands",
    "Columns",
    "Derivative",
    "Format",
    "Measurements",
    "Request",
    "derivative",
    "merged",
    "read",
    "read_bands",
    "read_trials",
]
