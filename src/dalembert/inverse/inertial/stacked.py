"""Regressors and torques along a motion: their shapes, checked."""

from collections.abc import Sequence

import numpy as np

from dalembert.errors import InputError, listed, repeated


def checked_regressor(regressor: np.ndarray, names: Sequence[str], where: str) -> np.ndarray:
    """Return a regressor (samples, joints, parameters)."""
    table = np.asarray(regressor, dtype=float)
    if table.ndim != 3 or table.shape[2] != len(names):
        raise InputError(
            f"{where}: the regressor has the shape {table.shape}; expected (samples, joints, {len(names)}) for "
            f"{len(names)} names"
        )
    if twice := repeated(names):
        raise InputError(f"{where}: {listed(list(map(repr, twice)))} is named twice. Give each parameter its own name")
    if not np.all(np.isfinite(table)):
        raise InputError(f"{where}: the regressor has a number that is not finite{_place(table)}. Remove this sample")
    rows = table.shape[0] * table.shape[1]
    if rows < len(names):
        raise InputError(
            f"{where}: the regressor has {rows} rows (samples x joints) for {len(names)} parameters. Give more samples"
        )
    return table


def checked_torques(torques: np.ndarray, regressor: np.ndarray, where: str) -> np.ndarray:
    """Return torques (samples, joints) that belong to a regressor."""
    table = np.asarray(torques, dtype=float)
    if table.shape != regressor.shape[:2]:
        raise InputError(
            f"{where}: the torques have the shape {table.shape}; expected {regressor.shape[:2]} (samples, joints), as "
            "the regressor"
        )
    if not np.all(np.isfinite(table)):
        raise InputError(f"{where}: the torques have a number that is not finite{_place(table)}. Remove this sample")
    return table


def checked_deviations(deviations: object, joints: int, where: str) -> np.ndarray:
    """Return standard deviations of torques (joints,), from one number or one a joint."""
    checked = np.asarray(deviations, dtype=float)
    if checked.shape not in ((), (joints,)) or not np.all(np.isfinite(checked)) or not np.all(checked > 0):
        raise InputError(
            f"{where}: deviations are {deviations}; expected a positive number, or {joints} of them, one for each joint"
        )
    return np.broadcast_to(checked, (joints,)).copy()


def _place(table: np.ndarray) -> str:
    sample, joint = np.argwhere(~np.isfinite(table))[0][:2]
    return f" (sample {sample}, joint {joint})"
