"""What benchmarks and studies import of the package exists: they run too rarely to show a name that is gone."""

import ast
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = sorted(path for folder in ("benchmarks", "studies", "docs") for path in (ROOT / folder).rglob("*.py"))


def imported(source: str) -> Iterator[tuple[str, str]]:
    """Modules of the package, and names that are taken from them."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and not node.level and (node.module or "").split(".")[0] == "dalembert":
            yield from ((str(node.module), alias.name) for alias in node.names)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_names_exist(path: Path) -> None:
    for module, name in imported(path.read_text()):
        if not hasattr(import_module(module), name):
            import_module(f"{module}.{name}")  # a module of the package, or an error that names both


def test_a_name_that_is_gone_is_an_error() -> None:
    assert list(imported("from dalembert.threads import gone, threads")) == [
        ("dalembert.threads", "gone"),
        ("dalembert.threads", "threads"),
    ]
