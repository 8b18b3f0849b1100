"""What was compiled from sources that have changed since is removed from the disk, and nothing else."""

from pathlib import Path

import pytest

import dalembert
from dalembert.stale import forget_stale

SOURCES = {
    "kernels/compiled.py": "def kernel(f): return f\n",
    "kernels/beam.py": "from dalembert.house.kernels.compiled import kernel\n",
    "kernels/spring.py": "from dalembert.house.kernels.compiled import kernel\n",
    "kernels/assembly.py": (
        "from dalembert.house.kernels import beam, spring\nfrom dalembert.house.kernels.compiled import kernel\n"
    ),
    "integrators/method.py": (
        "from dalembert.house.kernels.assembly import residual\nfrom dalembert.house.kernels.compiled import kernel\n"
    ),
    "integrators/several.py": (
        "from dalembert.house.kernels.compiled import (\n    kernel,\n)\n"
        "from dalembert.house.kernels.spring import SOFT, stretch\n"
        "from dalembert.house.kernels.assembly import residual\n"
    ),
    "settings.py": "from dalembert.house.kernels.assembly import residual\n",
}


@pytest.fixture
def house(tmp_path: Path) -> Path:
    house = tmp_path / "house"
    for name, text in SOURCES.items():
        path = house / name
        (path.parent / "__pycache__").mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    _forget(house)
    for name in SOURCES:
        _cached(house, name).touch()
    return house


def _forget(house: Path) -> None:
    forget_stale(house, house / "kernels" / "compiled.py")


def _cached(house: Path, name: str) -> Path:
    return (house / name).parent / "__pycache__" / f"{Path(name).stem}.function-1.nbi"


def _kept(house: Path) -> set[str]:
    return {name for name in SOURCES if _cached(house, name).exists()}


def _edit(house: Path, name: str) -> None:
    (house / name).write_text(SOURCES[name] + "# edited\n")
    _forget(house)


def test_unchanged_sources_keep_all(house: Path) -> None:
    _forget(house)
    assert _kept(house) == set(SOURCES)


def test_a_kernel_takes_its_callers_with_it(house: Path) -> None:
    _edit(house, "kernels/beam.py")
    assert _kept(house) == {"kernels/compiled.py", "kernels/spring.py", "settings.py"}


def test_a_method_stands_alone(house: Path) -> None:
    _edit(house, "integrators/method.py")
    assert _kept(house) == set(SOURCES) - {"integrators/method.py"}


def test_what_holds_no_compiled_function_is_not_looked_at(house: Path) -> None:
    _edit(house, "settings.py")
    assert _kept(house) == set(SOURCES)


def test_the_options_of_compilation_concern_all(house: Path) -> None:
    _edit(house, "kernels/compiled.py")
    assert _kept(house) == {"settings.py"}


def test_a_broken_stamp_is_as_none(house: Path) -> None:
    (house / "kernels" / "__pycache__" / "sources.json").write_text('{"kern')
    _forget(house)
    assert _kept(house) == {"settings.py"}


def test_of_many_imports_each_counts(house: Path) -> None:
    """One that stands under another, and one that stands over a further one."""
    _edit(house, "kernels/spring.py")
    assert _kept(house) == {"kernels/compiled.py", "kernels/beam.py", "settings.py"}


@pytest.mark.parametrize("package", sorted(path.name for path in Path(dalembert.__file__).parent.iterdir()))
def test_a_package_whose_compiled_functions_call_each_other_forgets(package: str) -> None:
    """Numba itself sees the edits of a file; two need us."""
    texts = [path.read_text() for path in (Path(dalembert.__file__).parent / package).glob("**/*.py")]
    decorated = [text for text in texts if "\n@compiled" in text or "\n@kernel" in text]
    assert len(decorated) < 2 or any("\nforget_stale(" in text for text in texts)
