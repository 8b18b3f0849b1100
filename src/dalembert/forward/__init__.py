"""The protocol that every model fulfils, models made of plain functions, and what sensors see of a model."""

from dalembert.forward.checkpoint import Checkpoint
from dalembert.forward.cluster import Executor, connected, takes_executor
from dalembert.forward.complex_steps import check_derivatives
from dalembert.forward.distributed import Distributed, on_cluster
from dalembert.forward.ensemble import ensemble
from dalembert.forward.model import Channel, Coordinate, ForwardModel
from dalembert.forward.prefetch import prefetched
from dalembert.forward.python_model import PythonModel
from dalembert.forward.recorded import Recorded
from dalembert.forward.refinement import Refinable, Refinement, error_factor, refined
from dalembert.forward.responses import Responses
from dalembert.forward.restart import Restartable, StateChart, begun_later, restartable, restarted
from dalembert.forward.sensors import Sensor, Sensors
from dalembert.forward.wrapped import clock, findings_at, starting

__all__ = [
    "Channel",
    "Checkpoint",
    "Coordinate",
    "Distributed",
    "Executor",
    "ForwardModel",
    "PythonModel",
    "Recorded",
    "Refinable",
    "Refinement",
    "Responses",
    "Restartable",
    "Sensor",
    "Sensors",
    "StateChart",
    "begun_later",
    "check_derivatives",
    "clock",
    "connected",
    "ensemble",
    "error_factor",
    "findings_at",
    "on_cluster",
    "prefetched",
    "refined",
    "restartable",
    "restarted",
    "starting",
    "takes_executor",
]
