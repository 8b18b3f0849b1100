"""Components of mechanisms in space, for :class:`SpatialSystem`.

The names are imported where they are first used; ``spatial.pyi``, which ``make names`` writes, says the same to type
checkers and editors. Components list theirs in their modules.
"""

from dalembert.component_index import SPATIAL_HOMES
from dalembert.lazy import lazy_names

_NAMES = {"components.points": "Point", "model.spatial_system": "SpatialSystem"}
_HOMES = {name: f"dalembert.multibody.{module}" for module, names in _NAMES.items() for name in names.split()}
_HOMES |= {name: f"dalembert.multibody.{module}" for name, module in SPATIAL_HOMES.items()}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
