"""Kinds of other packages in the catalogue of study files."""

import sys
from types import ModuleType

import pytest

from dalembert import InputError
from dalembert.kinds import distinct


def defined(module: str, file: str, monkeypatch: pytest.MonkeyPatch) -> type:
    """A class named Disc of a module in a file."""
    monkeypatch.setitem(sys.modules, module, ModuleType(module))
    monkeypatch.setattr(sys.modules[module], "__file__", file, raising=False)
    return type("Disc", (), {"__module__": module})


def test_a_file_that_is_loaded_again_replaces_its_kinds(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = defined("discs", "discs.py", monkeypatch), defined("parts.discs", "discs.py", monkeypatch)
    assert [*distinct([first, second]).values()] == [second]


def test_a_cell_of_a_notebook_that_runs_again_replaces_its_kinds() -> None:
    first, second = (type("Disc", (), {"__module__": "a notebook"}) for _ in range(2))
    assert [*distinct([first, second]).values()] == [second]


def test_two_packages_with_the_same_name_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = defined("discs", "discs.py", monkeypatch), defined("wheels", "wheels.py", monkeypatch)
    with pytest.raises(InputError, match="two components are named 'Disc', in the modules 'discs' and 'wheels'"):
        distinct([first, second])
