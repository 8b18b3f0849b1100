"""Packages of the extra ``posterior``, imported where they are used."""

import warnings
from importlib import import_module
from typing import Any

from dalembert.errors import InputError


def package(name: str, what: str) -> Any:
    """Return a package that ``what`` needs."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FutureWarning)  # ArviZ announces its next version once a day
            return import_module(name)
    except ImportError:
        message = f"{what} needs {name}, which is not installed; run: pip install 'dalembert[posterior]'"
        raise InputError(message) from None
