"""Kernels compiled beforehand, on all cores."""

import io
from pathlib import Path

import pytest

from dalembert.kernels import objects, preparation
from dalembert.kernels.kernel import find
from dalembert.kernels.preparation import observed, prepare
from dalembert.multibody.components.planar.point_mass import POINT_MASS
from dalembert.multibody.components.planar.sensor import SENSOR


def kernels() -> list:
    return [*POINT_MASS.all_kernels(), *SENSOR.all_kernels()]


@pytest.mark.parametrize("cores", [1, 2])
def test_what_is_missing_is_compiled_and_kept(
    nothing_compiled: Path, monkeypatch: pytest.MonkeyPatch, cores: int
) -> None:
    monkeypatch.setattr(preparation, "_cores", lambda: cores)
    monkeypatch.setattr(preparation, "_few", lambda: 2)
    seen: list[tuple[int, int]] = []
    with observed(lambda count, total, symbol: seen.append((count, total))):
        prepare(kernels())
        prepare(kernels())
    assert seen == [(count, len(kernels())) for count in range(1, len(kernels()) + 1)]
    assert {path.name for path in nothing_compiled.glob("*.o")} == {
        f"{kernel.symbol}-{kernel.digest}.o" for kernel in kernels()
    }


def test_objects_do_not_depend_on_the_process_that_compiles(
    nothing_compiled: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(preparation, "_few", lambda: 2)

    def contents(cores: int) -> dict[str, bytes]:
        monkeypatch.setattr(preparation, "_cores", lambda: cores)
        monkeypatch.setattr(preparation.OBJECTS, "_codes", {})
        with observed(lambda *_: None):
            prepare(kernels())
        codes = {path.name: path.read_bytes() for path in nothing_compiled.glob("*.o")}
        for path in nothing_compiled.glob("*.o"):
            path.unlink()
        return codes

    assert contents(1) == contents(2)


def test_a_folder_that_cannot_be_written_is_no_error(nothing_compiled: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(preparation, "_cores", lambda: 2)
    monkeypatch.setattr(preparation, "_few", lambda: 2)
    monkeypatch.setattr(preparation, "is_writable", lambda: False)
    monkeypatch.setattr(objects, "keep", lambda *_: None)
    with observed(lambda *_: None):
        prepare(kernels())
    assert preparation.OBJECTS.missing(kernels()) == []


def test_an_interruption_ends_the_workers_too(nothing_compiled: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(preparation, "_cores", lambda: 2)
    monkeypatch.setattr(preparation, "_few", lambda: 2)
    made: list[str] = []
    real = preparation.OBJECTS.make

    def make(kernel) -> None:
        real(kernel)
        made.append(kernel.symbol)
        if len(made) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(preparation.OBJECTS, "make", make)
    with observed(lambda *_: None), pytest.raises(KeyboardInterrupt):
        prepare(kernels())
    assert len(list(nothing_compiled.glob("*.o"))) < len(kernels())


def test_progress_is_one_line_where_no_terminal_is(nothing_compiled: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    monkeypatch.setattr("sys.stderr", stream)
    prepare(POINT_MASS.all_kernels())
    count = len(POINT_MASS.all_kernels())
    assert stream.getvalue() == f"dalembert: compiling {count} kernels, once on this machine\n"


@pytest.mark.parametrize("kernel", kernels(), ids=lambda kernel: kernel.symbol)
def test_another_process_finds_the_kernel(kernel) -> None:
    assert find(kernel.origin) is kernel
