"""Hysteretic damping, which is defined for harmonic motions alone."""

from dalembert.errors import InputError
from dalembert.structure import Structure


def require_viscous(structure: Structure, what: str) -> None:
    """Refuse a structure with hysteretic damping where motions are not periodic of a given frequency.

    Parameters
    ----------
    structure : Structure
    what : str
        What is not defined with it, in the plural.

    Raises
    ------
    InputError
    """
    if structure.loss is not None and abs(structure.loss).max() > 0:
        raise InputError(
            f"the structure has hysteretic damping (loss), which is defined for harmonic motions only; {what} are not "
            "defined with it. Use viscous damping instead, such as Modal(loss factor / 2)"
        )
