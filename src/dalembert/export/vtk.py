"""Motions and shapes for ParaView and whatever else reads VTK's files."""

import os
from pathlib import Path

from dalembert.errors import InputError
from dalembert.export.mechanism import motion
from dalembert.export.shapes import harmonics, modes, period
from dalembert.export.vtu import write_mesh, write_series
from dalembert.multibody import Trajectory
from dalembert.structure import EigenModes, ModeShapes
from dalembert.vibration import Deformation

SERIES, SINGLE = ".pvd", ".vtu"
PERIOD = 48
"""Default number of instants of a period."""


def export_vtk(
    result: Trajectory | Deformation | ModeShapes,
    path: str | os.PathLike[str],
    *,
    frames: int | None = None,
    points: int = 8,
) -> Path:
    """Write a motion as a series in time (``.pvd``), or shapes as one file (``.vtu``).

    Places are in m, displacements in m, velocities in m/s, all with x, y and z.

    ===========  ========  =======================================================================================
    result       suffix    content
    ===========  ========  =======================================================================================
    Trajectory   ``.pvd``  bodies and joints where they are, the triangles of the bodies' shapes in space,
                           ``displacement`` since the first instant, ``velocity``,
                           and the section's ``height`` and ``width``, 0 without one; of each cell the numbers of its
                           ``body`` and ``joint`` in the system, from 0, or -1
    Deformation  ``.pvd``  the structure at rest over a period: ``displacement``, ``velocity``, and at the contacts
                           ``state`` (0 separated, 1 stuck, 2 slipping; -1 elsewhere) and ``dissipated`` (J a period)
    Deformation  ``.vtu``  ``mean``, and of each harmonic the ``real`` and ``imaginary`` part of the amplitude
    ModeShapes   ``.vtu``  a displacement a mode; of complex shapes the ``real`` and the ``imaginary`` part
    ===========  ========  =======================================================================================

    The amplitude :math:`U` of harmonic :math:`h` moves as :math:`\\mathrm{Re}(U e^{\\mathrm{i} h \\omega t})`.

    Parameters
    ----------
    result : Trajectory, Deformation or ModeShapes
        For :class:`~dalembert.structure.EigenModes` see :func:`~dalembert.structure.mode_shapes`.
    path : path
        The files of a series, one an instant, lie in a folder of the same name beside it.
    frames : int, optional
        Largest number of instants, evenly over the motion; all output times of a trajectory and 48 of a period if not
        given.
    points : int
        Pieces that a beam element is drawn with.

    Returns
    -------
    pathlib.Path
        The file written.

    Raises
    ------
    InputError
        For another result, a suffix that does not fit, a number below 1, or if meshio is not installed.
    StorageError
        If there is no room, or no right to write.

    Examples
    --------
    >>> import tempfile
    >>> import dalembert as da
    >>> square = da.plate((0.4, 0.4), 2e-3, da.Material(210e9, 0.3, 7800.0), (4, 4)).fixed("edge")
    >>> shapes = da.mode_shapes(square, da.eigenmodes(square, 2))
    >>> path = export_vtk(shapes, Path(tempfile.mkdtemp()) / "plate.vtu")
    >>> import meshio
    >>> sorted(meshio.read(path).point_data)
    ['mode 1 (112.635 Hz)', 'mode 2 (231.263 Hz)']
    """
    path = Path(path)
    for name, number in (("frames", frames), ("points", points)):
        if number is not None and not (isinstance(number, int) and number >= 1):
            raise InputError(f"export_vtk: {name} is {number!r}; expected a whole number, at least 1")
    if isinstance(result, Trajectory):
        _expect(path, SERIES, "a motion")
        return write_series(path, motion(result, frames, points))
    if isinstance(result, Deformation):
        _expect(path, (SERIES, SINGLE), "a deformed shape")
        if path.suffix == SINGLE:
            return write_mesh(path, harmonics(result))
        return write_series(path, period(result, frames or PERIOD))
    if isinstance(result, ModeShapes):
        _expect(path, SINGLE, "mode shapes")
        return write_mesh(path, modes(result))
    hint = "; mode_shapes(structure, modes) makes what is drawn" if isinstance(result, EigenModes) else ""
    raise InputError(
        f"export_vtk: a {type(result).__name__} cannot be written; expected a Trajectory, a Deformation or ModeShapes"
        f"{hint}"
    )


def _expect(path: Path, suffixes: str | tuple[str, ...], what: str) -> None:
    if path.suffix not in ((suffixes,) if isinstance(suffixes, str) else suffixes):
        wanted = suffixes if isinstance(suffixes, str) else " (over the period) or ".join(suffixes) + " (harmonics)"
        raise InputError(f"export_vtk: {path.name!r} does not fit {what}; expected a name that ends with {wanted}")
