"""Study files: read, checked, and run in separate folders; names are imported where they are first used."""

from dalembert.lazy import lazy_names

_NAMES = {
    "loader": "load",
    "run.folder": "RunFolder",
    "run.runner": "report_run resume_run run_study",
    "run.validation": "plan",
    "schema": "json_schema",
    "tables.study": "Study",
}
_HOMES = {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
# Lists of runs and the studio read folders of runs, and need no models.
__getattr__, __dir__ = lazy_names(__name__, _HOMES)
