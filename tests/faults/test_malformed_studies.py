"""Study files with anything wrong in them give sentences, never a traceback."""

import tomllib
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dalembert.errors import InputError
from dalembert.study import load
from study_documents import ODD, places, toml

STUDIES = Path(__file__).parents[2] / "studies"
TEXTS = [path.read_text(encoding="utf-8") for path in sorted(STUDIES.glob("*/*.toml")) if path.name != "expected.toml"]
QUIET = settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))


def read(folder: Path, content: bytes) -> None:
    """Load a study: it is understood, or there is an InputError that says something."""
    path = folder / "study.toml"
    path.write_bytes(content)
    message = "understood"
    try:
        load(path)
    except InputError as error:
        message = str(error)
    assert message
    assert "Input should" not in message, "a sentence of pydantic's, not ours"


@pytest.fixture
def folder(tmp_path):
    for path in (STUDIES / "flexible-pendulum").iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    return tmp_path


@QUIET
@given(data=st.data())
def test_letters_changed(folder, data):
    text = data.draw(st.sampled_from(TEXTS)).encode()
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text) - 1))
        text = text[:at] + data.draw(st.binary(max_size=3)) + text[at + data.draw(st.integers(0, 3)) :]
    read(folder, text)


@QUIET
@given(data=st.data())
def test_values_changed(folder, data):
    document = tomllib.loads(data.draw(st.sampled_from(TEXTS)))
    for _ in range(data.draw(st.integers(1, 3))):
        *path, last = data.draw(st.sampled_from(places(document)))
        holder = document
        for step in path:
            holder = holder[step]
        match data.draw(st.integers(0, 2)), holder:
            case 0, dict():
                del holder[last]
            case 1, dict():
                holder[data.draw(st.text(max_size=6))] = holder.pop(last)
            case _:
                holder[last] = data.draw(ODD)
        if not places(document):
            break
    read(folder, "\n".join(f"{toml(key)} = {toml(value)}" for key, value in document.items()).encode())
