"""Files of a release state the same version, authors and commands as the project itself."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml

import dalembert

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
GITHUB = ROOT / ".github"
WORKFLOWS = sorted((GITHUB / "workflows").glob("*.yml"))
MAKE_TARGETS = set(re.findall(r"^([\w-]+):(?!=)", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))


def loaded(path: Path) -> dict:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def test_the_citation_agrees_with_the_project():
    citation = loaded(ROOT / "CITATION.cff")
    assert citation["version"] == dalembert.__version__
    assert [author["name"] for author in citation["authors"]] == [author["name"] for author in PROJECT["authors"]]
    assert citation["license"] == PROJECT["license"]
    assert citation["abstract"].rstrip(".") == PROJECT["description"]
    assert citation["keywords"] == PROJECT["keywords"]


def test_the_changelog_has_the_version_in_at_most_100_lines():
    lines = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8").splitlines()
    assert len(lines) <= 100
    releases = [line.split()[1] for line in lines if line.startswith("## ")]
    assert releases[0] == dalembert.__version__


@pytest.mark.parametrize("page", ["RELEASE.md", "CONTRIBUTING.md", ".github/PULL_REQUEST_TEMPLATE.md"])
def test_pages_name_existing_targets_of_make(page: str):
    text = (ROOT / page).read_text(encoding="utf-8")
    named = set(re.findall(r"(?:`|^)make ([\w-]+)", text, re.MULTILINE))
    assert named
    assert named <= MAKE_TARGETS


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_workflows_only_call_make(path: Path):
    steps = [step for job in loaded(path)["jobs"].values() for step in job["steps"]]
    commands = [step["run"] for step in steps if "run" in step]
    assert commands
    for command in commands:
        program, target, *_ = command.split()
        assert program == "make"
        assert target in MAKE_TARGETS
    assert "://" not in path.read_text(encoding="utf-8")


def test_the_tests_run_on_three_systems_from_the_oldest_python():
    matrix = loaded(GITHUB / "workflows" / "test.yml")["jobs"]["test"]["strategy"]["matrix"]
    assert len(matrix["system"]) == 3
    assert f">={matrix['python'][0]}" == PROJECT["requires-python"]


def test_hooks_before_a_commit_call_tools_of_the_environment():
    (repository,) = loaded(ROOT / ".pre-commit-config.yaml")["repos"]
    assert repository["repo"] == "local"
    for hook in repository["hooks"]:
        program, *arguments = hook["entry"].split()
        assert Path(program).parent == Path(".venv/bin")
        assert all((ROOT / argument).exists() for argument in arguments if argument.endswith(".py"))


@pytest.mark.parametrize("path", sorted((GITHUB / "ISSUE_TEMPLATE").glob("*.md")), ids=lambda path: path.stem)
def test_templates_of_issues_have_a_name_and_a_purpose(path: Path):
    _, header, body = path.read_text(encoding="utf-8").split("---\n", 2)
    assert set(yaml.safe_load(header)) == {"name", "about", "labels"}
    assert body.strip()
