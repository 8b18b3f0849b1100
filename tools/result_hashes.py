"""Hashes of the results of studies and test models: ``python tools/result_hashes.py hashes.json [part ...]``.

Run it before and after a change of the code that must not change results, on the same machine, and compare the files.
A hash covers the bits of all stored numbers, whatever their names are: renaming a variable leaves it as it is. Numbers
that measure time are left out.
"""

import hashlib
import json
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
MEASURED = ("seconds", "cpu", "duration", "wall")
"""Parts of names of variables that hold times of a computer."""


def digest(arrays: Iterable[np.ndarray]) -> str:
    """Hash of the bits and shapes of arrays, in any order."""
    each = sorted(
        hashlib.sha256(f"{array.shape}{array.dtype.str}".encode() + np.ascontiguousarray(array).tobytes()).hexdigest()
        for array in arrays
    )
    return hashlib.sha256("".join(each).encode()).hexdigest()[:16]


def numbers_in(path: Path) -> Iterator[np.ndarray]:
    """All numeric data sets of an HDF5 file but measured times."""
    import h5py

    arrays: list[np.ndarray] = []

    def visit(name: str, item: object) -> None:
        timed = any(word in name.lower() for word in MEASURED)
        if isinstance(item, h5py.Dataset) and item.dtype.kind in "biufc" and not timed:
            arrays.append(np.asarray(item))

    with h5py.File(path) as file:
        file.visititems(visit)
    yield from arrays


def studies() -> Iterator[Path]:
    """Study files that have a task."""
    from dalembert.study.tasks import TASKS

    for path in sorted((ROOT / "studies").glob("*/*.toml")):
        if TASKS.keys() & tomllib.loads(path.read_text(encoding="utf-8")).keys():
            yield path


def of_study(path: Path) -> str:
    """Hash of the stored result of a study."""
    from dalembert.study import load, run_study

    with tempfile.TemporaryDirectory() as folder:
        run_study(load(path), Path(folder) / "run")
        return digest(numbers_in(Path(folder) / "run" / "result.nc"))


def models() -> Iterator[tuple[str, object]]:
    """Test models: response and sensitivities of each planar and spatial scene."""
    sys.path.insert(0, str(ROOT / "tests"))
    import planar_scenes
    import spatial_scenes

    for kind, (build, fields) in planar_scenes.SCENES.items():
        if planar_scenes.numbers_of(fields):
            yield f"planar {kind.__name__}", planar_scenes.response(build, fields)
    for name, (build, fields) in spatial_scenes.SCENES.items():
        yield f"spatial {name}", _spatial(build, fields)


def _spatial(build, fields: dict):
    import spatial_scenes
    from dalembert import multibody as mb
    from dalembert.parameter import Parameter

    parameters = {
        name: Parameter(name, value - abs(value) / 2, value + abs(value) / 2, scale=abs(value))
        for name, value in spatial_scenes.numbers_of(fields).items()
    }
    system = build(**fields)
    channels = [f"{body.name}.{body.point_names[-1]}.{entry}" for body in system.bodies for entry in ("x", "vy", "az")]

    def rebuilt(**numbers: float):
        return build(**spatial_scenes.fields_of(fields, numbers))

    return mb.TimeResponse(rebuilt, parameters, channels, np.linspace(0, 0.1, 11), mb.GeneralizedAlpha(step=1e-3))


def of_model(model) -> str:
    """Hash of the response and the Jacobian of a model at its start."""
    vector = model.parameters.start
    response, jacobian = model.linearise(vector)
    return digest([np.asarray(response), np.asarray(jacobian)])


def hashes(parts: list[str]) -> Iterator[tuple[str, str]]:
    """Hash of each study and model whose name has one of the parts, or what stopped it."""
    for path in studies():
        name = path.relative_to(ROOT).as_posix()
        if not parts or any(part in name for part in parts):
            yield name, _or_error(of_study, path)
    for name, model in models():
        if not parts or any(part in name for part in parts):
            yield name, _or_error(of_model, model)


def _or_error(function, argument) -> str:
    try:
        return function(argument)
    except Exception as error:  # the others count too
        return f"{type(error).__name__}: {error}"


def main() -> None:
    """Write the hashes, after each study what is known so far."""
    target, parts = Path(sys.argv[1]), sys.argv[2:]
    known: dict[str, str] = {}
    for name, value in hashes(parts):
        known[name] = value
        print(value, name, flush=True)
        target.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
