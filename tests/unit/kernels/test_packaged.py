"""The object file of a wheel."""

import json
import platform
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from dalembert.kernels import everything, packaged
from small_kernels import both, weighted


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    if platform.machine() not in packaged.FAMILIES:
        pytest.skip("no object is made for this processor")
    folder = tmp_path_factory.mktemp("object")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(everything, "package_kernels", lambda **_: [weighted, both])
        everything.build(folder)
    return folder


def test_it_needs_nothing_but_mathematical_functions(folder: Path) -> None:
    undefined = subprocess.run(["nm", "-u", folder / "kernels.o"], capture_output=True, text=True, check=True).stdout
    assert undefined == ""


def test_it_is_used_where_sources_and_processor_fit(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packaged, "source_digest", lambda: json.loads((folder / "kernels.json").read_text())["sources"])
    monkeypatch.setattr(packaged, "HERE", folder)
    find = packaged.packaged.__wrapped__
    assert find().symbols == {weighted.symbol, both.symbol}
    monkeypatch.setattr(packaged, "source_digest", lambda: "others")
    assert find() is None


def test_a_processor_without_the_features_gets_none(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packaged.ll, "get_host_cpu_features", dict)
    assert packaged.family() is None


def test_the_digest_is_that_of_the_sources() -> None:
    assert packaged.source_digest() == packaged.source_digest()
    assert len(packaged.source_digest()) == 64


def test_a_checkout_contains_no_compiled_file() -> None:
    assert not (Path(packaged.__file__).parent / "kernels.o").exists()
