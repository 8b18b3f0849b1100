"""Flexible and rigid planar mechanisms in time.

The names are imported where they are first used; ``__init__.pyi``, which ``make names`` writes, says the same to type
checkers and editors. Components and integrators list theirs in their modules.
"""

from dalembert.component_index import HOMES
from dalembert.lazy import lazy_names

_NAMES = {
    "steady.campbell_diagram": "campbell",
    "motion.compare_integrators": "WorkPrecision work_precision",
    "model.drawing": "Drawing",
    "kernels.debugging": "in_python",
    "kernels.kind": "Kind",
    "motion.simulation": "simulate",
    "steady.small_vibrations": "Modes modes",
    "start.equilibrium_path": "equilibrium_path",
    "start.path_result": "CriticalPoint EquilibriumPath",
    "start.statics": "Equilibrium equilibrium",
    "model.system": "System",
    "motion.time_response": "TimeResponse",
    "motion.trajectory": "Trajectory",
}
_HOMES = {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
_HOMES |= {name: f"{__name__}.{module}" for name, module in HOMES.items()}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
