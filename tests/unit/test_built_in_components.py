"""A component, an integrator, a swarm, a sampling and a format of data become part of the package, one file each."""

import hashlib
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import public_names
from own_components import FILES, METHODS, STUDY

PLACES = {
    "components/planar/own_gears": "OwnGears",
    "components/planar/own_pull": "OwnPull",
    "components/planar/own_disc": "OwnDisc",
    "integrators/own_alpha": "OwnAlpha",
}
IN_SPACE = "components/spatial/own_pull"
KINDS = {"joint": "OwnGears", "load": "OwnPull", "body": "OwnDisc", "solver": "OwnAlpha"}
CODE = """
import dalembert as da
from dalembert.component_index import KINDS
from dalembert.study import load
from dalembert.study.tables.catalogue import ROLES, kinds_of

for role, name in {kinds}.items():
    assert name in KINDS[ROLES[role]] and name in dir(da) and getattr(da, name).__name__ == name
    assert getattr(da, name) in kinds_of(role)
study = load("study.toml")
print([type(component).__name__ for component in study.system().bodies], type(study.solver).__name__)
"""

PULL_IN_SPACE = '''"""One more."""

__all__ = ["OwnPull"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.orientation import Orientation
from dalembert.multibody.components.spatial.spatial_pairs import push_pair, separation
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.vectors import times


@inlined
def residual(x, v, a, p, m, inputs, r):
    push_pair(p, m, times(p.stiffness, separation(x, p, m)), r)


PULL = pair_kind("own_pull_in_space", __name__, ("stiffness",), residual=residual)


@dataclass(frozen=True)
class OwnPull(Load):
    """A force that grows with the distance."""

    a: Side
    b: Side
    stiffness: Number = number("N/m")
    turned: Orientation = Orientation()

    kind = PULL

    def lower(self, lowering):
        pair = lowering.pair(self.a, self.b, self.name)
        lowering.add(PULL, pair.slots, [*pair.data, self.stiffness], pair.integers, self.name)
'''
IN_SPACE_STUDY = """
[model]
space = true
[[model.body]]
kind = "PointMass"
name = "ball"
mass = "2 kg"
[[model.load]]
kind = "OwnPull"
name = "pull"
a = "ground(0, 0, 0)"
b = "ball.centre"
stiffness = "20 N/mm"
turned = { axes = "z", angles = "90 deg" }
[solver]
step = "1 ms"
[simulate]
end = "10 ms"
"""
IN_SPACE_CODE = """
from dalembert.component_index import KINDS, SPATIAL_KINDS
from dalembert.multibody.spatial import OwnPull
from dalembert.study import load
(pull,) = load("space.toml").system().loads
assert "OwnPull" in SPATIAL_KINDS["Load"] and isinstance(pull, OwnPull)
print(pull.stiffness, pull.turned.matrix.round().tolist())
"""

METHODS_CODE = """
import numpy as np
import dalembert as da
from dalembert.data import read
from dalembert.study import load
from dalembert.study.tables.catalogue import swarms
from dalembert.uncertainty import propagate

times = np.linspace(0.0, 1.0, 3)
model = da.PythonModel(lambda a, b: (a - b) * times, {"a": (0.0, 1.0), "b": (0.0, 1.0)}, ["y"], times)
print(propagate(model, {"a": (0.5, 1.0), "b": (0.0, 1.0)}, "diagonal").upper.max())
print(read("data.lines", columns={"y": "y"}).values[:, 0].tolist(), read("data.lines", format="lines").values.shape)
load("methods.toml")
print(swarms()["slow-swarm"](particles=7).particles)
"""
METHODS_STUDY = """
[parameters]
a = { lower = 0.0, upper = 1.0 }
[model]
forward = "own.py:own"
[data]
file = "data.lines"
columns = { y = "y" }
[identify]
method = { kind = "slow-swarm", particles = 7 }
"""


LAW = '''
"""A spring that softens."""

from dataclasses import dataclass, field

from dalembert.vibration.laws.contacts import Number
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.law import law


@law
def soft(u, v, z, numbers, force):
    force[0] = numbers[0] * u[0] / (1.0 + u[0] ** 2)


@dataclass(frozen=True)
class SoftSpring(LawElement):
    """A spring that softens."""

    name: str
    first: str
    second: str | None = None
    stiffness: Number = field(kw_only=True, metadata={"unit": "N/m"})

    law = soft
'''
LAW_STUDY = """
[[model.mass]]
name = "m"
mass = 1.0
[[model.spring]]
kind = "SoftSpring"
name = "soft"
first = "m"
stiffness = "2 kN/m"
[frequency_response]
frequencies = [1.0, 2.0]
"""
LAW_CODE = """
from dalembert.study import load
(spring,) = load("law.toml").system().elements
print(type(spring).__name__, spring.stiffness)
"""
TASK = '''
"""The task ``[nothing]``."""

from dalembert.study.text.table import StudyTable
from dalembert.study.tasks.task import Task


class Nothing(Task):
    """The task ``[nothing]``."""

    name = "nothing"

    def table(self):
        return StudyTable

    def wrong(self, file):
        return []

    def plan(self, study):
        return "computes nothing: no simulation"

    def effort(self, study):
        raise NotImplementedError

    def run(self, study, emit):
        raise NotImplementedError

    def load(self, study, path):
        raise NotImplementedError
'''
OTHERS = {"vibration/laws/soft_spring": LAW, "study/tasks/nothing": TASK}


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


def test_one_file_is_enough_for_a_component_in_space(sources: Path) -> None:
    """Also with the name of a planar one."""
    path = sources / "dalembert" / "multibody" / f"{IN_SPACE}.py"
    path.write_text(PULL_IN_SPACE)
    before = digests(sources)
    subprocess.run([sys.executable, public_names.__file__, sources], capture_output=True, check=True)
    after = digests(sources)
    changed = {name for name in after if after[name] != before.get(name)}
    assert changed <= {"dalembert/component_index.py", "dalembert/multibody/spatial.pyi"}
    (sources / "space.toml").write_text(IN_SPACE_STUDY)
    run = subprocess.run(
        [sys.executable, "-c", IN_SPACE_CODE],
        cwd=sources,
        env={**os.environ, "PYTHONPATH": str(sources)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout == "20000.0 [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]\n"


def test_one_file_is_enough_for_a_swarm_a_sampling_and_a_format(sources: Path) -> None:
    for place, text in METHODS.items():
        (sources / "dalembert" / f"{place}.py").write_text(text)
    (sources / "methods.toml").write_text(METHODS_STUDY)
    (sources / "data.lines").write_text("t 0.0 0.5 1.0\ny 1.0 2.0 3.0\n")
    (sources / "own.py").write_text(
        "import dalembert as da, numpy as np\n"
        "def own(parameters): return da.PythonModel(lambda a: a * np.ones(3), parameters, ['y'], np.linspace(0, 1, 3))\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", METHODS_CODE],
        cwd=sources,
        env={**os.environ, "PYTHONPATH": str(sources)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout.splitlines() == ["0.5", "[1.0, 2.0, 3.0] (3, 1)", "7"]


def test_one_file_is_enough_for_a_law_and_for_a_task(sources: Path) -> None:
    for place, text in OTHERS.items():
        (sources / "dalembert" / f"{place}.py").write_text(text)
    (sources / "law.toml").write_text(LAW_STUDY)
    run = subprocess.run(
        [sys.executable, "-c", f"{LAW_CODE}\nfrom dalembert.study.tasks import TASKS\nprint(list(TASKS)[-1])"],
        cwd=sources,
        env={**os.environ, "PYTHONPATH": str(sources)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout == "SoftSpring 2000.0\nnothing\n"


def test_the_guide_names_the_folder_of_each_file() -> None:
    guide = (public_names.SOURCES.parent / "CONTRIBUTING.md").read_text(encoding="utf-8")
    table = guide.partition("## Where to add what")[2].partition("\n## ")[0]
    folders = set(re.findall(r"`src/dalembert/([\w/]+)/NAME\.py`", table))
    added = [*(f"multibody/{place}" for place in (*PLACES, IN_SPACE)), *METHODS, *OTHERS]
    assert folders == {str(Path(place).parent) for place in added}


def test_a_name_that_two_modules_list_is_refused(sources: Path) -> None:
    copy = sources / "dalembert" / "multibody" / "components" / "planar" / "second_spring.py"
    copy.write_text('__all__ = ["Spring"]\n')
    with pytest.raises(SystemExit, match=r"^Spring is in __all__ of .*\.second_spring and of .*\.spring; give each"):
        public_names.generated(sources)
    copy.unlink()
