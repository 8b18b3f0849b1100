"""The protocol that every model fulfils, models made of plain functions, and what sensors see of a model."""

from dalembert.lazy import lazy_names

_NAMES = {
    "adjoint": "Pull prefers_adjoint pullback",
    "checkpoint": "Checkpoint",
    "cluster": "Executor connected takes_executor",
    "complex_steps": "check_derivatives",
    "distributed": "Distributed on_cluster",
    "ensembles": "ensemble",
    "model": "Channel Coordinate ForwardModel",
    "prefetch": "prefetched",
    "python_model": "PythonModel",
    "recorded": "Recorded",
    "refinement": "Refinable Refinement error_factor refined",
    "responses": "Responses",
    "restart": "Restartable StateChart begun_later restartable restarted",
    "sensors": "Sensor Sensors",
    "wrapped": "clock findings_at starting",
}
_HOMES = {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
__getattr__, __dir__ = lazy_names(__name__, _HOMES)
