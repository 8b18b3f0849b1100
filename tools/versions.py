"""Run the README's examples and all templates with the lowest or the newest versions of all dependencies.

``python tools/versions.py lowest newest`` makes the environments ``build/versions/lowest``, with the lowest version of
each package that ``pyproject.toml`` allows, and ``build/versions/newest``. Without an argument, both. README
and templates need no extra, so extras are not installed.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "build" / "versions"
BLOCK = re.compile(r"^```(python|toml)\n(.*?)^```", re.MULTILINE | re.DOTALL)
SAVE_DATA = """
np.savetxt("motion.csv", np.column_stack([times, motion]), delimiter=",", header="t,x,y", comments="")
"""
"""The file of measurements that the README's study reads, after its first example."""


def lowest(dependencies: list[str]) -> list[str]:
    """Return constraints to the lowest allowed version of each dependency.

    >>> lowest(["numba>=0.62,<0.69", "numpy>=2.0"])
    ['numba==0.62', 'numpy==2.0']
    """
    constraints = []
    for requirement in map(Requirement, dependencies):
        (bound,) = (part.version for part in requirement.specifier if part.operator == ">=")
        constraints.append(f"{requirement.name}=={bound}")
    return constraints


def examples(readme: str) -> tuple[str, str]:
    """Return the Python code of the README, which also saves the data of its study, and the study.

    >>> examples("```python\\na = 1\\n```\\n```toml\\nb = 2\\n```\\n```python\\nc = 3\\n```\\n")[1]
    'b = 2\\n'
    """
    first, *others = (code for language, code in BLOCK.findall(readme) if language == "python")
    (study,) = (code for language, code in BLOCK.findall(readme) if language == "toml")
    return "".join([first, SAVE_DATA, *others]), study


def environment(name: str, project: dict, python: str) -> Path:
    """Install the package into a new environment, and return its folder of programs."""
    folder = FOLDER / name
    subprocess.run([python, "-m", "venv", "--clear", folder], check=True)
    programs = folder / ("Scripts" if os.name == "nt" else "bin")
    constraints = folder / "constraints.txt"
    constraints.write_text("\n".join(lowest(project["dependencies"]) if name == "lowest" else []), encoding="utf-8")
    install = [programs / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*install, "hatchling"], check=True)
    subprocess.run([*install, "--no-build-isolation", "--constraint", constraints, ROOT], check=True)
    return programs


def check(programs: Path) -> list[str]:
    """Run all examples and templates in an empty folder, and return the commands that failed."""
    code, study = examples((ROOT / "README.md").read_text(encoding="utf-8"))
    templates = sorted((ROOT / "src/dalembert/study/templates").iterdir())
    names = [folder.name.partition("-")[2] for folder in templates if folder.is_dir()]
    commands = [["python", "readme.py"], ["dalembert", "run", "readme.toml"]]
    for name in names:
        commands += [["dalembert", "new", name, name], ["dalembert", "run", f"{name}/{name}.toml"]]
    failed = []
    with tempfile.TemporaryDirectory() as empty:
        Path(empty, "readme.py").write_text(code, encoding="utf-8")
        Path(empty, "readme.toml").write_text(study, encoding="utf-8")
        variables = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        for program, *arguments in commands:
            run = subprocess.run(
                [programs / program, *arguments], check=False, cwd=empty, env=variables, capture_output=True, text=True
            )
            line = " ".join([program, *arguments])
            print(f"{'passed' if run.returncode == 0 else 'FAILED'}: {line}", flush=True)
            if run.returncode:
                failed.append(line)
                print(f"{run.stdout[-2000:]}\n{run.stderr[-2000:]}", flush=True)
    return failed


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("versions", nargs="*", default=["lowest", "newest"], metavar="lowest|newest")
    parser.add_argument("--python", default=sys.executable, help="the Python of the environments")
    parser.add_argument("--programs", type=Path, help="use this environment's folder of programs instead of making one")
    arguments = parser.parse_args()
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    failed = []
    for name in arguments.versions:
        print(f"The {name} versions:", flush=True)
        failed += check(arguments.programs or environment(name, project, arguments.python))
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main())
