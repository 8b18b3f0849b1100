"""Meshes of solids from files of other programs."""

import io
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.errors import DataError, InputError, told
from dalembert.structure.assembly import library

CORNERS = {"tetra10": "tetra", "hexahedron20": "hexahedron", "hexahedron27": "hexahedron", "triangle6": "triangle",
           "quad8": "quad", "quad9": "quad", "line3": "line"}  # fmt: skip
"""Kinds of cells of second order and those of their corners, which come first."""
VOLUMES = {"tetra": 4, "tetra10": 4, "hexahedron": 8, "hexahedron20": 8, "hexahedron27": 8, "pyramid": 5,
           "pyramid13": 5, "pyramid14": 5, "wedge": 6, "wedge15": 6, "wedge18": 6}  # fmt: skip
"""Kinds of cells with a volume, and their corners."""
FACES = (
    ((0, 4, 7, 3), (16, 15, 19, 11)), ((1, 2, 6, 5), (9, 18, 13, 17)), ((0, 1, 5, 4), (8, 17, 12, 16)),
    ((3, 7, 6, 2), (19, 14, 18, 10)), ((0, 3, 2, 1), (11, 10, 9, 8)), ((4, 5, 6, 7), (12, 13, 14, 15)),
)  # fmt: skip
"""Corners and middles of the edges of each face of a brick of 20 nodes, by the order of VTK's 27 nodes."""
BULK = (".bdf", ".nas", ".fem")
"""Endings of Nastran's bulk data."""


def read_mesh(path: str | Path) -> tuple[Any, np.ndarray, dict[str, np.ndarray]]:
    """Mesh of a file, its points (points, 3), and rows of these in the sets of nodes that it names."""
    library("meshio", "solid")
    if not Path(path).is_file():
        raise DataError(f"{path}: there is no such file")
    said = io.StringIO()
    try:
        with redirect_stdout(said), redirect_stderr(said):
            read = _read(Path(path))
            mesh = _mesh(read)
    except InputError as error:
        raise DataError(f"{path}: {error}") from error
    except (Exception, SystemExit) as error:  # meshio prints the reason and ends the process
        reason = told(error) if isinstance(error, Exception) else " ".join(said.getvalue().split())
        raise DataError(f"{path}: no mesh can be read from it: {reason}") from error
    sets = {name: np.unique(np.asarray(members, dtype=int)) for name, members in (read.point_sets or {}).items()}
    return mesh, read.points, sets


def _read(path: Path) -> Any:
    import meshio

    if path.suffix.lower() not in BULK:
        return meshio.read(path)
    text = path.read_text(encoding="utf-8", errors="replace")
    if any(line.strip().upper().startswith("BEGIN BULK") for line in text.splitlines()):
        return meshio.read(path)
    return meshio.read(io.StringIO(f"BEGIN BULK\n{text}\nENDDATA\n"), "nastran")  # a part that another file includes


def _mesh(read: Any) -> Any:
    """Mesh of scikit-fem; one of second order keeps its curved edges, and has the sets of its corners."""
    import meshio
    import skfem
    from skfem.io.meshio import from_meshio

    kinds = [kind for kind in read.cells_dict if kind in VOLUMES]
    if len(kinds) > 1:
        raise InputError(f"the mesh has cells of several kinds ({', '.join(kinds)}); expected one kind")
    if not kinds or kinds[0] not in CORNERS:
        return from_meshio(read)
    kind, cells = kinds[0], read.cells_dict[kinds[0]]
    points = read.points
    if kind == "hexahedron20":
        points, cells, kind = _with_27_nodes(points, cells)
    curved = from_meshio(meshio.Mesh(points, [(kind, cells)]))
    corners = from_meshio(_of_corners(read))
    assert isinstance(curved, skfem.MeshTet1 | skfem.MeshHex1)
    # Both number their corners in the order of the file, so that their facets have the same numbers.
    return replace(curved, _boundaries=corners.boundaries, _subdomains=corners.subdomains)


def _of_corners(read: Any) -> Any:
    import meshio

    sizes = {"triangle": 3, "quad": 4, "line": 2, **VOLUMES}
    blocks: list[Any] = [(CORNERS.get(block.type, block.type), block.data) for block in read.cells]
    blocks = [(kind, data[:, : sizes[kind]] if kind in sizes else data) for kind, data in blocks]
    used = np.unique(np.concatenate([data.ravel() for _, data in blocks]))
    place = np.zeros(len(read.points), dtype=int)
    place[used] = np.arange(len(used))
    return meshio.Mesh(
        read.points[used], [(kind, place[data]) for kind, data in blocks], cell_data=read.cell_data,
        field_data=read.field_data, cell_sets=read.cell_sets,
    )  # fmt: skip


def _with_27_nodes(points: np.ndarray, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray, str]:
    """Bricks of 20 nodes with the middles of their faces and their own, by the shape functions of the 20.

    At the middle of a face those of its corners are -1/4 and of its edges 1/2, at the brick's -1/4 and 1/4.
    """
    corners, edges = (cells[:, np.array([face[part] for face in FACES])] for part in (0, 1))  # (cells, 6, 4)
    _, first, place = np.unique(np.sort(corners, axis=2).reshape(-1, 4), axis=0, return_index=True, return_inverse=True)
    on_faces = points[edges].sum(axis=2) / 2 - points[corners].sum(axis=2) / 4
    inside = points[cells[:, 8:20]].sum(axis=1) / 4 - points[cells[:, :8]].sum(axis=1) / 4
    faces = len(points) + place.reshape(len(cells), 6)
    centres = len(points) + len(first) + np.arange(len(cells))[:, None]
    everywhere = np.vstack([points, on_faces.reshape(-1, 3)[first], inside])
    return everywhere, np.hstack([cells, faces, centres]), "hexahedron27"
