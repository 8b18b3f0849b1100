"""Unstructured grids of VTK, one or a series in time, written by meshio."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from dalembert.errors import InputError, unwritable
from dalembert.files import replacing, write_text


@dataclass(frozen=True, eq=False)
class Mesh:
    """Points, cells between them, and fields. ``points`` (points, 3): m; ``cells``: kind as meshio calls it
    (``"vertex"``, ``"line"``, ``"triangle"`` or ``"quad"``), and corners (cells, corners); ``fields`` (points,) or
    (points, 3); ``marks``: numbers of the cells, an array (cells,) for each entry of ``cells``.
    """

    points: np.ndarray
    cells: list[tuple[str, np.ndarray]]
    fields: dict[str, np.ndarray]
    marks: dict[str, list[np.ndarray]] = field(default_factory=dict)


def write_mesh(path: Path, mesh: Mesh) -> Path:
    """One file, there whole or not at all."""
    library = _meshio()
    with replacing(path) as temporary:
        library.Mesh(mesh.points, mesh.cells, mesh.fields, mesh.marks).write(temporary, file_format="vtu")
    return path


def write_series(path: Path, instants: Iterable[tuple[float, Mesh]]) -> Path:
    """A file an instant, in a folder beside, then the one that lists them with their times in s."""
    _meshio()
    folder = path.with_suffix("")
    try:
        folder.mkdir(exist_ok=True)
    except FileNotFoundError:
        raise InputError(
            f"{path} cannot be written: there is no folder {path.parent}; make it, or choose another path"
        ) from None
    except OSError as error:
        raise unwritable(folder, error.strerror) from None
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1", byte_order="LittleEndian")
    listed = ElementTree.SubElement(root, "Collection")
    for number, (time, mesh) in enumerate(instants):
        file = write_mesh(folder / f"{number:05d}.vtu", mesh)
        ElementTree.SubElement(
            listed, "DataSet", timestep=repr(float(time)), part="0", file=f"{folder.name}/{file.name}"
        )
    ElementTree.indent(root)
    write_text(path, '<?xml version="1.0"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n")
    return path


def chosen(count: int, most: int | None) -> np.ndarray:
    """Numbers of at most ``most`` of ``count`` instants, evenly from the first to the last; all without ``most``."""
    if most is None or most >= count:
        return np.arange(count)
    return np.linspace(0, count - 1, most).round().astype(int)


def _meshio() -> Any:
    try:
        return import_module("meshio")
    except ImportError:
        raise InputError("export_vtk: meshio is needed and not installed; run: pip install 'dalembert[vtk]'") from None
