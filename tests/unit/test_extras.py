"""Every extra can be installed with the pinned versions."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]


@pytest.fixture
def bench_constraints(tmp_path: Path) -> Path:
    """The pinned versions, but for those of packages that the benchmarks' peers need otherwise."""
    others = (ROOT / "benchmarks" / "constraints.txt").read_text()
    names = {line.partition("==")[0] for line in others.splitlines() if "==" in line}
    kept = [
        line for line in (ROOT / "constraints.txt").read_text().splitlines() if line.partition("==")[0] not in names
    ]
    path = tmp_path / "constraints.txt"
    path.write_text("\n".join([*kept, others]))
    return path


@pytest.mark.slow
@pytest.mark.parametrize("extra", EXTRAS)
def test_an_extra_resolves(extra: str, bench_constraints: Path) -> None:
    constraints = bench_constraints if extra == "bench" else ROOT / "constraints.txt"
    command = [
        sys.executable, "-m", "pip", "install", "--quiet", "--dry-run", "--ignore-installed", "--no-build-isolation",
        "--constraint", str(constraints), f"{ROOT}[{extra}]",
    ]  # fmt: skip
    run = subprocess.run(command, check=False, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr[-2000:]
