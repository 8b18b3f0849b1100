"""Measured data in."""

from dalembert.lazy import lazy_names

_NAMES = {
    "bands": "Bands",
    "bands_file": "read_bands",
    "columns": "Columns",
    "derivatives": "Derivative derivative",
    "format": "Format Request",
    "measurements": "Measurements merged",
    "readers": "read read_trials",
}
_HOMES = {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
__getattr__, __dir__ = lazy_names(__name__, _HOMES)
