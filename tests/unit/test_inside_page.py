"""The page that follows a run through the code names only what exists."""

import re
from importlib import import_module
from pathlib import Path

import pytest

import dalembert

PAGE = Path(__file__).parents[2] / "docs" / "ten-minutes-inside.md"
NAMES = sorted(set(re.findall(r"`(dalembert(?:\.\w+)+)`", PAGE.read_text(encoding="utf-8"))))


def exists(name: str) -> bool:
    """Whether a dotted name leads to a module, a folder, or a part of a module."""
    parts = name.split(".")
    if Path(dalembert.__file__).parent.joinpath(*parts[1:]).is_dir():
        return True
    for count in range(len(parts), 0, -1):
        try:
            value = import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        for part in parts[count:]:
            value = getattr(value, part, None)
        return value is not None
    return False


@pytest.mark.parametrize("name", NAMES)
def test_each_name_on_the_page_exists(name: str):
    assert exists(name)


def test_a_name_that_does_not_exist_is_found():
    assert len(NAMES) > 25
    assert not exists("dalembert.study.loader.no_such_function")
    assert not exists("dalembert.no_such_module")
