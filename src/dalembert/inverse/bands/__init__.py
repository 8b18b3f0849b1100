"""Intervals of parameters from bands of a response."""

from dalembert.inverse.bands.band_fit import BandFit
from dalembert.inverse.bands.global_surrogate import GlobalSurrogate
from dalembert.inverse.bands.identify_bands import identify_bands
from dalembert.inverse.bands.nested import Nested

__all__ = ["BandFit", "GlobalSurrogate", "Nested", "identify_bands"]
