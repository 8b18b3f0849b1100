"""A joint, a force element, a body and an integrator become part of the package, one file each."""

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import public_names
from own_components import FILES, STUDY

PLACES = {
    "components/planar/own_gears": "OwnGears",
    "components/planar/own_pull": "OwnPull",
    "components/planar/own_disc": "OwnDisc",
    "integrators/own_alpha": "OwnAlpha",
}
KINDS = {"joint": "OwnGears", "load": "OwnPull", "body": "OwnDisc", "solver": "OwnAlpha"}
CODE = """
import dalembert as da
from dalembert.component_index import KINDS
from dalembert.study import load
from dalembert.study.catalogue import ROLES, kinds_of

for role, name in {kinds}.items():
    assert name in KINDS[ROLES[role]] and name in dir(da) and getattr(da, name).__name__ == name
    assert getattr(da, name) in kinds_of(role)
study = load("study.toml")
print([type(component).__name__ for component in study.system().bodies], type(study.solver).__name__)
"""


def digests(sources: Path) -> dict[str, str]:
    """What the files of a source folder hold, by path."""
    return {
        str(path.relative_to(sources)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sources.rglob("*.py*")
        if path.suffix in (".py", ".pyi")
    }


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the sources."""
    copy = tmp_path_factory.mktemp("copy") / "src"
    shutil.copytree(public_names.SOURCES, copy)
    return copy


def test_one_file_each_and_the_generator_make_them_public(sources: Path) -> None:
    before = digests(sources)
    for place, name in PLACES.items():
        path = sources / "dalembert" / "multibody" / f"{place}.py"
        path.write_text(f'"""One more."""\n\n__all__ = ["{name}"]\n{FILES[path.stem]}')
    script = Path(public_names.__file__)
    command = [sys.executable, script, sources]
    assert subprocess.run([*command, "--check"], capture_output=True, check=False).returncode == 1
    subprocess.run(command, capture_output=True, check=True)
    subprocess.run([*command, "--check"], capture_output=True, check=True)

    after = digests(sources)
    new = {f"dalembert/multibody/{place}.py" for place in PLACES}
    generated = {"dalembert/component_index.py", "dalembert/__init__.pyi", "dalembert/multibody/__init__.pyi"}
    assert {path for path in after if after[path] != before.get(path)} == new | generated

    stub = (sources / "dalembert" / "__init__.pyi").read_text()
    assert all(f"from dalembert.multibody import {name} as {name}\n" in stub for name in KINDS.values())

    (sources / "study.toml").write_text(STUDY)
    (sources / "data.csv").write_text("t,y\n0.0,0.0\n1.0,1.0\n")
    run = subprocess.run(
        [sys.executable, "-c", CODE.format(kinds=KINDS)],
        cwd=sources,
        env={**os.environ, "PYTHONPATH": str(sources)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout == "['OwnDisc', 'OwnDisc', 'RigidBar'] OwnAlpha\n"


def test_a_name_that_two_modules_list_is_refused(sources: Path) -> None:
    copy = sources / "dalembert" / "multibody" / "components" / "planar" / "second_spring.py"
    copy.write_text('__all__ = ["Spring"]\n')
    with pytest.raises(SystemExit, match=r"^Spring is in __all__ of .*\.second_spring and of .*\.spring; give each"):
        public_names.generated(sources)
    copy.unlink()
