import ast
import subprocess
import sys
from pathlib import Path

import pytest

import dalembert


def test_importing_the_package_loads_nothing_beyond_the_standard_library() -> None:
    code = "import sys; before = set(sys.modules); import dalembert; print(*set(sys.modules) - before)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    packages = {name.partition(".")[0] for name in run.stdout.split()}
    assert packages - sys.stdlib_module_names == {"dalembert"}


def test_the_stub_for_type_checkers_hands_on_the_same_names_from_the_same_modules() -> None:
    stub = ast.parse((Path(dalembert.__file__).parent / "__init__.pyi").read_text())
    imports = [node for node in stub.body if isinstance(node, ast.ImportFrom)]
    homes = {alias.name: str(node.module) for node in imports for alias in node.names}
    lazy = {name: f"dalembert.{home}" for name, home in dalembert._HOME.items()}
    assert homes == lazy | dict.fromkeys(dalembert._MODULES, "dalembert")


@pytest.mark.parametrize("name", dir(dalembert))
def test_every_public_name_is_there(name: str) -> None:
    assert getattr(dalembert, name) is not None


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match=r"^module 'dalembert' has no attribute 'Sistem'$"):
        dalembert.Sistem  # noqa: B018
