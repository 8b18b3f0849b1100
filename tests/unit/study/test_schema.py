"""The JSON schema that editors complete and check study files by."""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from dalembert.study import schema_file
from dalembert.study.template import begin, templates
from json_schemas import fits

ROOT = Path(__file__).parents[3]
STUDIES = [path for path in sorted((ROOT / "studies").glob("*/*.toml")) if path.name != "expected.toml"]
PROGRAM = "from dalembert.study.schema import schema_text; print(schema_text(), end='')"


def test_the_schema_in_the_package_is_up_to_date():
    """In a process of its own, as other tests define kinds."""
    made = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, encoding="utf-8", check=True)
    assert made.stdout == schema_file.text(), "run `make schema`"


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_each_study_names_its_schema_and_fits_it(path):
    line = path.read_text(encoding="utf-8").partition("\n")[0]
    assert line.startswith("#:schema ")
    schema = json.loads((path.parent / line.removeprefix("#:schema ")).read_text(encoding="utf-8"))
    assert schema == schema_file.schema()
    assert fits(tomllib.loads(path.read_text(encoding="utf-8")), schema, schema)


@pytest.mark.parametrize("name", templates())
def test_each_template_has_its_schema_beside_it(name, tmp_path):
    path = begin(name, tmp_path / name)
    text = path.read_text(encoding="utf-8")
    assert text.startswith(f"{schema_file.LINE}\n")
    schema = json.loads((path.parent / schema_file.NAME).read_text(encoding="utf-8"))
    assert fits(tomllib.loads(text), schema, schema)
    assert not fits(tomllib.loads(text.replace("[model]", "[modell]", 1)), schema, schema)


def definition(name: str) -> dict:
    return schema_file.schema()["$defs"][name]["properties"]


def test_keys_have_meaning_unit_and_default():
    bar = definition("RigidBar")
    assert bar["angle"] == {
        "anyOf": [{"type": "number"}, {"type": "string"}],
        "default": 0.0,
        "description": "Initial angle from the x axis, rad. Expected: an angle such as '45 deg' or 0.785398 in rad.",
        "x-unit": "rad",
    }
    assert bar["start"]["x-names"] == "point"
    assert "default" not in bar["inertia"]
    assert definition("ParameterTable")["lower"]["description"] == "lower bound, such as 0.1 or '100 MPa'"


def test_nothing_may_be_null():
    """TOML has no null."""
    assert '"null"' not in schema_file.text()
