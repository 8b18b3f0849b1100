"""Shapes of structures at their nodes."""

from collections.abc import Iterator

import numpy as np

from dalembert.export.vtu import Mesh
from dalembert.structure import ModeShapes
from dalembert.vibration import Deformation

NONE = -1
"""State of a place that is no contact."""


def modes(shapes: ModeShapes) -> Mesh:
    """All modes as fields, named by number and frequency."""
    fields = {}
    for number, (frequency, shape) in enumerate(zip(shapes.frequencies, shapes.shapes, strict=True), start=1):
        fields |= _parts(f"mode {number} ({frequency:.6g} Hz)", shape)
    return Mesh(shapes.places, _cells(shapes.places, shapes.faces), fields)


def harmonics(shape: Deformation) -> Mesh:
    """The mean, and the complex amplitude of each harmonic."""
    fields = {}
    for order, amplitude in _amplitudes(shape).items():
        fields |= _parts(f"harmonic {order}", amplitude) if order else {"mean": np.real(amplitude)}
    return Mesh(shape.places, _cells(shape.places, shape.faces), fields)


def period(shape: Deformation, frames: int) -> Iterator[tuple[float, Mesh]]:
    """Times and meshes over a period: the nodes at rest, then the contacts as vertices."""
    nodes, contacts = len(shape.places), len(shape.contacts)
    places = np.concatenate([shape.places, shape.contact_places])
    cells = _cells(shape.places, shape.faces)
    if contacts:
        cells.append(("vertex", nodes + np.arange(contacts)[:, None]))
    energies = np.concatenate([np.zeros(nodes), shape.energies])
    still = np.zeros((contacts, 3))
    phases = 2 * np.pi * np.arange(frames) / frames
    speed = 2 * np.pi * shape.frequency
    columns = np.arange(frames) * shape.states.shape[1] // frames
    amplitudes = _amplitudes(shape)
    for phase, column, displacement in zip(phases, columns, shape.motion(phases), strict=True):
        velocity = np.zeros((nodes, 3))
        for order, amplitude in amplitudes.items():
            velocity += (1j * order * speed * amplitude * np.exp(1j * order * phase)).real
        fields = {
            "displacement": np.concatenate([displacement, still]),
            "velocity": np.concatenate([velocity, still]),
            "state": np.concatenate([np.full(nodes, NONE), shape.states[:, column]]),
            "dissipated": energies,
        }
        yield float(phase / speed), Mesh(places, cells, fields)


def _amplitudes(shape: Deformation) -> dict[int, np.ndarray]:
    """Complex amplitudes (nodes, 3) by harmonic: a cosine's minus i times a sine's coefficients; the mean is real."""
    amplitudes, column = {}, 0
    for order in shape.orders:
        width = 2 if order else 1
        block = shape.coefficients[..., column : column + width]
        amplitudes[order] = block @ np.array([1.0, -1j][:width])
        column += width
    return amplitudes


def _parts(name: str, shape: np.ndarray) -> dict[str, np.ndarray]:
    if np.iscomplexobj(shape):
        return {f"{name} real": np.real(shape).copy(), f"{name} imaginary": np.imag(shape).copy()}
    return {name: shape}


def _cells(places: np.ndarray, faces: np.ndarray) -> list[tuple[str, np.ndarray]]:
    if len(faces):
        return [("triangle" if faces.shape[1] == 3 else "quad", faces)]
    return [("vertex", np.arange(len(places))[:, None])]
