"""Published numbers for the verification tests."""

import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent / "references"


@pytest.fixture(scope="session")
def reference() -> Callable[[str], dict]:
    """Reads references/<name>.toml."""
    return lambda name: tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
