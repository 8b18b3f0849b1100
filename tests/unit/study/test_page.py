"""The page about study files: its example runs, and it leaves nothing out."""

import re
from pathlib import Path

import pytest

from dalembert.study import json_schema, load, run_study

PAGE = (Path(__file__).parents[3] / "docs/how-to/study-files.md").read_text(encoding="utf-8")
WORDS = set(re.findall(r"[A-Za-z]\w+|\b[a-z]\b", PAGE))


def test_the_example_runs(tmp_path):
    (example,) = re.findall(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
    path = tmp_path / "example.toml"
    path.write_text(example)
    folder, outcome = run_study(load(path), tmp_path / "run")
    assert folder.path.is_dir()
    assert outcome.success


@pytest.mark.parametrize("name", sorted(json_schema()["$defs"]))
def test_every_kind_and_key_is_on_the_page(name):
    table = json_schema()["$defs"][name]
    kind = table.get("properties", {}).get("kind", {}).get("const", "kind")
    assert kind in PAGE
    assert set(table.get("properties", {})) <= WORDS
