"""Flexible and rigid planar mechanisms in time.

The names are imported where they are first used; ``__init__.pyi``, which ``make names`` writes, says the same to type
checkers and editors. Components and integrators list theirs in their modules.
"""

from dalembert.component_index import HOMES
from dalembert.lazy import lazy_names

_NAMES = {
    "campbell_diagram": "campbell",
    "compare_integrators": "WorkPrecision work_precision",
    "drawing": "Drawing",
    "kernels.debugging": "in_python",
    "kernels.kind": "Kind",
    "simulation": "simulate",
    "small_vibrations": "Modes modes",
    "statics": "Equilibrium equilibrium",
    "system": "System",
    "time_response": "TimeResponse",
    "trajectory": "Trajectory",
}
_HOMES = {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
_HOMES |= {name: f"{__name__}.{module}" for name, module in HOMES.items()}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
