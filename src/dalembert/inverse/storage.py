"""A fit as a labelled dataset, and in a NetCDF file."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.data import Measurements
from dalembert.files import read_dataset, write_dataset
from dalembert.forward import Coordinate
from dalembert.inverse.events import StartEnd, Step
from dalembert.inverse.fit import Fit
from dalembert.parameters import Parameter, Parameters

if TYPE_CHECKING:
    from xarray import Dataset

FORMAT = "dalembert fit 1"


def to_xarray(fit: Fit) -> "Dataset":
    """Dataset over parameter, sample coordinate, channel, step and start; what is not an array stands in attributes."""
    from xarray import Dataset

    along, data, history, starts = fit.data.coordinate, fit.data, fit.history, fit.starts
    p = len(fit.parameters)
    variables: dict[str, Any] = {
        "values": ("parameter", fit.values),
        "deviations": ("parameter", fit.deviations),
        "correlation": (("parameter", "parameter_"), fit.correlation),
        "singular_values": ("combination", fit.singular_values),
        "directions": (("combination", "parameter"), fit.directions),
        "response": (("sample", "channel"), fit.response),
        "data": (("sample", "channel"), data.values),
        "residuals": (("sample", "channel"), fit.residuals),
        "weights": (("sample", "channel"), fit.weights),
        "step_start": ("step", np.array([step.start for step in history], dtype=np.int64)),
        "step_iteration": ("step", np.array([step.iteration for step in history], dtype=np.int64)),
        "step_simulations": ("step", np.array([step.simulations for step in history], dtype=np.int64)),
        "step_best": ("step", np.array([step.best for step in history], dtype=float)),
        "step_values": (("step", "parameter"), np.array([step.values for step in history]).reshape(-1, p)),
        "start_values": (("start", "parameter"), np.array([start.start for start in starts]).reshape(-1, p)),
        "end_values": (("start", "parameter"), np.array([start.end for start in starts]).reshape(-1, p)),
        "end_fitness": ("start", np.array([start.fitness for start in starts], dtype=float)),
        "start_simulations": ("start", np.array([start.simulations for start in starts], dtype=np.int64)),
    }
    if data.deviations is not None:
        variables["data_deviations"] = ("channel", data.deviations)
    coordinates = {
        "parameter": ("parameter", list(fit.parameters.names)),
        "channel": ("channel", list(data.channels)),
        "coordinate": ("sample", along.values, {"long_name": along.name, "units": along.unit}),
    }
    told = {
        "parameters": [asdict(item) for item in fit.parameters],
        "ends": [{"success": start.success, "message": start.message} for start in starts],
        "provenance": fit.provenance,
    }
    attributes = {
        "format": FORMAT,
        "method": fit.method,
        "status": fit.status,
        "success": int(fit.success),
        "fitness": fit.fitness,
        "simulations": fit.simulations,
        "settings": json.dumps(told, sort_keys=True),
    }
    return Dataset(variables, coordinates, attributes)


def save(fit: Fit, path: str | Path) -> None:
    """Write a fit to a NetCDF-4 file, whole or not at all."""
    write_dataset(path, to_xarray(fit))


def load(path: str | Path) -> Fit:
    """Read a fit from a NetCDF-4 file."""
    return from_xarray(read_dataset(path, form=FORMAT, expected="a fit written by Fit.save"))


def from_xarray(dataset: "Dataset") -> Fit:
    """The fit that :func:`to_xarray` turned into a dataset."""
    told = json.loads(dataset.attrs["settings"])
    a = {str(name): variable.values for name, variable in dataset.variables.items()}
    along = dataset["coordinate"]
    history = zip(
        a["step_start"], a["step_iteration"], a["step_simulations"], a["step_best"], a["step_values"], strict=True
    )
    starts = zip(
        a["start_values"], a["end_values"], a["end_fitness"], told["ends"], a["start_simulations"], strict=True
    )
    samples = along.size
    return Fit(
        parameters=Parameters(tuple(Parameter(**item) for item in told["parameters"])),
        values=a["values"],
        deviations=a["deviations"],
        correlation=a["correlation"],
        singular_values=a["singular_values"],
        directions=a["directions"],
        fitness=float(dataset.attrs["fitness"]),
        response=a["response"],
        data=Measurements(
            Coordinate(along.attrs["long_name"], along.attrs["units"], a["coordinate"]),
            tuple(map(str, a["channel"])),
            a["data"],
            a.get("data_deviations"),
        ),
        weights=a["weights"],
        history=tuple(
            Step(int(start), int(iteration), int(simulations), float(best), values, samples)
            for start, iteration, simulations, best, values in history
        ),
        starts=tuple(
            StartEnd(start, end, float(fitness), bool(how["success"]), str(how["message"]), int(simulations))
            for start, end, fitness, how, simulations in starts
        ),
        success=bool(dataset.attrs["success"]),
        status=str(dataset.attrs["status"]),
        method=str(dataset.attrs["method"]),
        simulations=int(dataset.attrs["simulations"]),
        provenance=told["provenance"],
    )
