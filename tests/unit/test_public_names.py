import ast
import dataclasses
import inspect
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType
from typing import Any

import pytest

import dalembert
import public_names
from dalembert import component_index, data, forward, multibody, report, study
from dalembert.multibody import spatial
from dalembert.study.tables.catalogue import ROLES, kinds_of

LAZY = [dalembert, data, forward, multibody, report, spatial, study]


def loaded_by(code: str) -> set[str]:
    """Modules that are loaded once some code has run in a new process."""
    code = f"import sys; before = set(sys.modules); {code}; print(*set(sys.modules) - before)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_importing_the_package_loads_nothing_beyond_the_standard_library() -> None:
    packages = {name.partition(".")[0] for name in loaded_by("import dalembert")}
    assert packages - sys.stdlib_module_names == {"dalembert"}


def test_listing_the_components_imports_none() -> None:
    loaded = loaded_by("from dalembert import component_index, multibody; dir(multibody); component_index.KINDS")
    ours = {name for name in loaded if name.startswith("dalembert")}
    assert ours == {"dalembert", "dalembert.component_index", "dalembert.lazy", "dalembert.multibody"}


def test_components_in_space_are_imported_where_they_are_used() -> None:
    loaded = loaded_by("from dalembert.multibody import RigidBody, spatial; dir(spatial)")
    assert "dalembert.multibody.components.planar.rigid_body" in loaded
    assert not [name for name in loaded if name.startswith("dalembert.multibody.components.spatial")]


def test_the_generated_files_are_up_to_date() -> None:
    assert not public_names.outdated(public_names.SOURCES), "run `make names`"


@pytest.mark.parametrize("package", LAZY, ids=lambda package: package.__name__)
def test_the_stub_for_type_checkers_hands_on_the_same_names_from_the_same_modules(package: ModuleType) -> None:
    stub = ast.parse(Path(str(package.__file__)).with_suffix(".pyi").read_text())
    imports = [node for node in stub.body if isinstance(node, ast.ImportFrom)]
    homes = {alias.name: str(node.module) for node in imports for alias in node.names}
    modules = dict.fromkeys(getattr(package, "_MODULES", ()), package.__name__)
    assert homes == package._HOMES | modules


@pytest.mark.parametrize("package", LAZY, ids=lambda package: package.__name__)
def test_no_name_is_hidden_by_a_module_of_the_package(package: ModuleType) -> None:
    assert not {entry.name for entry in iter_modules(getattr(package, "__path__", []))} & package._HOMES.keys()


@pytest.mark.parametrize("name", [f"{package.__name__} {name}" for package in LAZY for name in dir(package)])
def test_every_public_name_is_there(name: str) -> None:
    package, name = name.split()
    assert getattr(import_module(package), name) is not None


@pytest.mark.parametrize(
    ("package", "homes", "index"),
    [
        (multibody, component_index.HOMES, component_index.KINDS),
        (spatial, component_index.SPATIAL_HOMES, component_index.SPATIAL_KINDS),
    ],
    ids=["plane", "space"],
)
def test_the_index_lists_the_public_kinds_that_derive_from_a_base(
    package: Any, homes: dict[str, str], index: dict[str, tuple[str, ...]]
) -> None:
    public = [getattr(package, name) for name in homes]
    for base, names in index.items():
        kinds = [kind for kind in public if inspect.isclass(kind) and getattr(package, base) in kind.__mro__[1:]]
        assert sorted(kind.__name__ for kind in kinds) == list(names)
        assert all(dataclasses.is_dataclass(kind) and not inspect.isabstract(kind) for kind in kinds)
        (role,) = (role for role, own in ROLES.items() if own == base)
        assert set(kinds) <= set(kinds_of(role, space=package is spatial))


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match=r"^module 'dalembert' has no attribute 'Sistem'$"):
        dalembert.Sistem  # noqa: B018
