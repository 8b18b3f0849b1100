"""Pictures of models as SVG, for pages, notebooks and documentation."""

from dalembert.lazy import lazy_names

_NAMES = {"canvas": "message_picture", "model": "picture"}
_HOMES = {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
__getattr__, __dir__ = lazy_names(__name__, _HOMES)
