"""Branches of components on numbers: samples side by side share them, so that all such columns have to be known."""

import re
from pathlib import Path

import dalembert.multibody.components as components
from dalembert.multibody.kernels.declaration import SWITCHES


def test_components_branch_on_known_columns_alone() -> None:
    sources = [path.read_text() for path in Path(components.__file__).parent.rglob("*.py")]
    asked = {name for source in sources for name in re.findall(r"is_zero\((?:p\.)?(\w+)\)", source)}
    assert asked == set(SWITCHES)
    # A comparison of a number with zero would be a branch that lanes do not share.
    assert not any(re.search(r"\bif p\.\w+ *[=!]=", source) for source in sources)
