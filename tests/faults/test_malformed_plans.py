"""Studies with one thing wrong, up to where they would run: an error of ours that names the place, or a study in order.

Load, build and first evaluation are tried in this process, and some by the real command.
"""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dalembert.errors import DalembertError
from dalembert.study import load, plan
from study_documents import ODD, places, toml

COMMAND = Path(sys.executable).with_name("dalembert")
ROOT = Path(__file__).parents[2]
STUDIES = ROOT / "studies"
FILES = [*STUDIES.glob("*/*.toml"), *(ROOT / "src" / "dalembert" / "study" / "templates").glob("*/*.toml")]
KEPT = {path: path.read_text(encoding="utf-8") for path in sorted(FILES) if path.name != "expected.toml"}
STUDY_FILES = [path for path, text in KEPT.items() if re.search(r"^\[model", text, re.M) and "[study]" in text]
QUICK = [path for path in STUDY_FILES if path.parent.name != "patched-plate"]
"""Without the plate: its own function makes any number of elements that it is told to."""

TWO = [pytest.param(20), pytest.param(250, marks=pytest.mark.slow)]
PLACE = re.compile(r"\[[a-z_.]+\]|'[^']*'|\.(csv|toml|py)\b|line \d+|sample \d+")
NUMBER = re.compile(r"\s*-?\d[\d.eE+-]*")
EXTREME = [-1, 0, 0.5, 1, 2, 1e-300, -1e300, 1e300, float("nan"), float("inf"), 2**62, True, "3"]


def whole(path: Path) -> dict:
    """A study's document, with its model in it and not in a file beside it."""
    document = tomllib.loads(KEPT[path])
    shared = document["model"].get("file")
    if shared is not None:
        other = tomllib.loads((path.parent / shared).read_text(encoding="utf-8"))
        document["model"] = other["model"]
        constants = other.get("constants", {}) | document.get("constants", {})
        document["constants"] = {key: constants[key] for key in constants if key not in document.get("parameters", {})}
    return document


def values(document: object, kind: type) -> list:
    """All values of a kind in a document."""
    inner = document.values() if isinstance(document, dict) else document if isinstance(document, list) else ()
    return [document] * isinstance(document, kind) + [found for entry in inner for found in values(entry, kind)]


def another(document: dict, value: object, data: st.DataObject) -> object:
    """What a user may write in the place of a value: another number or unit, another name, one entry less or more."""
    match value:
        case bool():
            return not value
        case int() | float():
            return data.draw(st.sampled_from([-value, value * 1e6, value * 1e-9, str(value), *EXTREME]))
        case str() if found := NUMBER.match(value):
            number = data.draw(st.sampled_from(["-1", "0", "1e-300", "1e300", "0.5", "nan", "inf", "1/0", ""]))
            return number + value[found.end() :]
        case str():
            texts = values(document, str)
            return data.draw(st.sampled_from([value[:-1], value + value, f"-({value})", f"1/({value})", *texts]))
        case list() if value:
            return data.draw(st.sampled_from([value[:-1], [*value, value[-1]], value[0], [value]]))
        case dict() if value:
            gone = data.draw(st.sampled_from(sorted(value)))
            return {key: entry for key, entry in value.items() if key != gone}
    return data.draw(ODD)


def misspelt(document: dict, data: st.DataObject) -> None:
    """Change one place: a value, or a key renamed, doubled in a table of its own, or taken out."""
    *path, last = data.draw(st.sampled_from(places(document)))
    holder = document
    for step in path:
        holder = holder[step]
    match data.draw(st.integers(0, 9)), holder:
        case 0, dict():
            holder[data.draw(st.sampled_from([f"{last}x", str(last)[:-1], "kind", "name"]))] = holder.pop(last)
        case 1, _:
            del holder[last]
        case 2, _:
            holder[last] = {str(last): holder[last]}
        case 3, _:
            holder[last] = [holder[last], holder[last]]
        case 4, _:
            holder[last] = data.draw(ODD)
        case _:
            holder[last] = another(document, holder[last], data)


def told(path: Path, folder: Path) -> None:
    """Load and plan a study: whatever is wrong with it, the sentence names the place."""
    try:
        study = load(path, folder=folder)
    except DalembertError as error:
        for line in str(error).splitlines():
            assert line.startswith((path.name, str(path), str(folder))) or ".toml: " in line, line
            assert PLACE.search(line), line
        return
    try:
        said = plan(study)
    except DalembertError as error:
        said = str(error) if PLACE.search(str(error)) else ""
    assert said, "neither a plan nor a place"


@pytest.mark.parametrize("examples", TWO)
def test_a_study_with_something_wrong_is_told_or_in_order(examples, tmp_path):
    @settings(max_examples=examples, deadline=None, suppress_health_check=list(HealthCheck))
    @given(data=st.data())
    def tried(data):
        origin = data.draw(st.sampled_from(QUICK))
        document = whole(origin)
        for _ in range(data.draw(st.integers(1, 2))):
            misspelt(document, data)
            if not places(document):
                return
        path = tmp_path / "study.toml"
        path.write_text("\n".join(f"{toml(key)} = {toml(value)}" for key, value in document.items()))
        told(path, origin.parent)

    tried()


@pytest.mark.parametrize("examples", TWO)
def test_a_study_with_letters_lost_is_told_or_in_order(examples, tmp_path):
    """The text itself: cut off, a line twice, lines exchanged, bytes that are no text."""

    @settings(max_examples=examples, deadline=None, suppress_health_check=list(HealthCheck))
    @given(data=st.data())
    def tried(data):
        origin = data.draw(st.sampled_from(QUICK))
        lines = KEPT[origin].encode().splitlines(keepends=True)
        one, other = (data.draw(st.integers(0, len(lines) - 1)) for _ in range(2))
        match data.draw(st.sampled_from(["cut", "twice", "exchanged", "flipped", "lost"])):
            case "cut":
                lines = [*lines[:one], lines[one][: data.draw(st.integers(0, len(lines[one])))]]
            case "twice":
                lines.insert(other, lines[one])
            case "exchanged":
                lines[one], lines[other] = lines[other], lines[one]
            case "flipped":
                at = data.draw(st.integers(0, len(lines[one]) - 1))
                byte = bytes([lines[one][at] ^ 1 << data.draw(st.integers(0, 7))])
                lines[one] = lines[one][:at] + byte + lines[one][at + 1 :]
            case _:
                del lines[one]
        path = tmp_path / "study.toml"
        path.write_bytes(b"".join(lines))
        told(path, origin.parent)

    tried()


WRONG = {
    "a word for a number": ('step = "0.5 ms"', 'step = "half a ms"'),
    "a table twice": ("[solver]", "[simulate]\n[solver]"),
    "a channel that there is not": ("[simulate]", '[simulate]\nchannels = ["lower.end.q"]'),
    "a point that there is not": ('points = ["lower.end"]', 'points = ["lower.tip"]'),
    "no number": ("drag = 0.02", "drag = nan"),
}


@pytest.mark.parametrize("mistake", WRONG)
def test_the_command_ends_with_the_code_for_what_is_wrong(mistake, tmp_path):
    origin = STUDIES / "chaotic-pendulum"
    (tmp_path / "pendulum.toml").write_text(KEPT[origin / "pendulum.toml"])
    text = KEPT[origin / "simulate.toml"]
    assert WRONG[mistake][0] in text
    (tmp_path / "study.toml").write_text(text.replace(*WRONG[mistake]))
    done = subprocess.run([COMMAND, "run", "study.toml"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2, done.stderr
    assert "Traceback" not in done.stderr
    assert PLACE.search(done.stderr)
