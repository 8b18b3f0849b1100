"""What was compiled from sources that have changed since is removed from the disk, and nothing else."""

from pathlib import Path

import pytest

from dalembert.multibody.kernels import stale

SOURCES = {
    "kernels/compiled.py": "def compiled(f): return f\n",
    "kernels/beam.py": "from dalembert.multibody.kernels.compiled import kernel\n",
    "kernels/spring.py": "from dalembert.multibody.kernels.compiled import kernel\n",
    "kernels/assembly.py": (
        "from dalembert.multibody.kernels import beam, spring\n"
        "from dalembert.multibody.kernels.compiled import kernel\n"
    ),
    "integrators/method.py": (
        "from dalembert.multibody.kernels.assembly import residual\n"
        "from dalembert.multibody.kernels.compiled import kernel\n"
    ),
    "settings.py": "from dalembert.multibody.kernels.assembly import residual\n",
}


@pytest.fixture
def house(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(stale, "_MULTIBODY", tmp_path)
    for name, text in SOURCES.items():
        path = tmp_path / name
        (path.parent / "__pycache__").mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    stale.forget_stale()
    for name in SOURCES:
        _cached(tmp_path, name).touch()
    return tmp_path


def _cached(house: Path, name: str) -> Path:
    return (house / name).parent / "__pycache__" / f"{Path(name).stem}.function-1.nbi"


def _kept(house: Path) -> set[str]:
    return {name for name in SOURCES if _cached(house, name).exists()}


def _edit(house: Path, name: str) -> None:
    (house / name).write_text(SOURCES[name] + "# edited\n")
    stale.forget_stale()


def test_unchanged_sources_keep_all(house: Path) -> None:
    stale.forget_stale()
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
    stale.forget_stale()
    assert _kept(house) == {"settings.py"}
