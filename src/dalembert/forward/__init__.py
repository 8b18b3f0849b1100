"""The protocol that every model fulfils, and models made of plain functions."""

from dalembert.forward.model import Channel, Coordinate, ForwardModel
from dalembert.forward.python_model import PythonModel
from dalembert.forward.responses import Responses

__all__ = ["Channel", "Coordinate", "ForwardModel", "PythonModel", "Responses"]
