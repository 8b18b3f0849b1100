"""Figures, one function each, and a report that opens without a network; for notebooks and run folders alike."""

from dalembert.lazy import lazy_names

_NAMES = {
    "contents": "figures",
    "look": "dark",
    "page": "report",
    "player.animation": "Animation",
    "registry": "sections_of",
    "section": "ReportSection",
}
_ELSEWHERE = {"dalembert.tables": "Table cell"}
_HOMES = {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
_HOMES |= {name: module for module, names in _ELSEWHERE.items() for name in names.split()}
_MODULES = ("charts",)
__getattr__, __dir__ = lazy_names(__name__, _HOMES, _MODULES)
