"""Intervals of parameters from bands of a response."""

from dalembert.inverse.bands.band_fit import BandFit

__all__ = ["BandFit"]
