"""Doors from a result to what shows it: names that resolve late, so that no layer imports one above it."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

from dalembert.errors import require_known

ENTRIES = {
    "figures": "dalembert.report:figures",
    "report": "dalembert.report:report",
}
"""Where each door leads, as ``module:function``; the module is imported when the door is used."""


def hook(name: str) -> Callable[..., Any]:
    """The function behind a door.

    Parameters
    ----------
    name : {"figures", "report"}
        ``figures(result) -> dict of str to plotly Figure``; ``report(result, path)`` writes an HTML report.

    Raises
    ------
    InputError
        For an unknown name.

    Examples
    --------
    >>> hook("figure")
    Traceback (most recent call last):
    dalembert.errors.InputError: unknown hook 'figure'; did you mean 'figures'?
    """
    require_known("hook", name, ENTRIES)
    module, function = ENTRIES[name].split(":")
    return getattr(import_module(module), function)
