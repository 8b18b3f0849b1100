"""Changes of a study's text in place."""

import tomllib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dalembert.errors import InputError
from dalembert.studio.editor.editing import text_of, value_of, with_table, with_value, without
from dalembert.studio.editor.fields import TableField, child
from dalembert.studio.editor.lines import tables
from dalembert.study.template import templates

STUDIES = Path(__file__).parents[4] / "studies"
TEXT = """\
#:schema ./x.json
# head
[model]
gravity = [0.0, -9.81]  # g

[[model.body]]
kind = "RigidBar"   # a bar
name = "rod"

# the pin
[[model.joint]]
name = "pin"

[[model.body]]
name = "second"

# how it is solved
[solver]
step = "1 ms"

[simulate]
times = { end = "4 s", every = "20 ms" }  # t
"""


def lines_apart(before: str, after: str) -> tuple[list[str], list[str]]:
    """Lines that went, and lines that came, where all others stay in their order."""
    old, new = before.splitlines(), after.splitlines()
    gone = [line for line in old if old.count(line) > new.count(line)]
    come = [line for line in new if new.count(line) > old.count(line)]
    assert [line for line in old if line not in gone] == [line for line in new if line not in come]
    return gone, come


def test_a_value_is_changed_in_place():
    assert lines_apart(TEXT, with_value(TEXT, ("model", "body", 1, "name"), "third")) == (
        ['name = "second"'],
        ['name = "third"'],
    )
    assert lines_apart(TEXT, with_value(TEXT, ("simulate", "times", "every"), 0.5)) == (
        ['times = { end = "4 s", every = "20 ms" }  # t'],
        ['times = { end = "4 s", every = 0.5 }  # t'],
    )
    assert lines_apart(TEXT, with_value(TEXT, ("model", "gravity"), [0, "1 m/s^2"]))[1] == [
        'gravity = [0, "1 m/s^2"]  # g'
    ]


def test_a_key_is_added_after_the_others():
    text = with_value(TEXT, ("model", "body", 0, "start"), "ground")
    assert lines_apart(TEXT, text) == ([], ['start = "ground"'])
    assert text.index("start =") < text.index("# the pin")
    text = with_value(TEXT, ("model", "body", 0, "points", "a b"), [1.0, 0])
    assert tomllib.loads(text)["model"]["body"][0]["points"] == {"a b": [1.0, 0]}


def test_a_table_is_added_where_such_tables_stand():
    text, place = with_table(TEXT, ("model", "joint", 0), {"kind": "FixedJoint", "name": "weld"})
    assert place == ("model", "joint", 1)
    assert child(tomllib.loads(text), place) == {"kind": "FixedJoint", "name": "weld"}
    text, place = with_table(TEXT, ("model", "load", 7), {"name": "push"})
    assert place == ("model", "load", 0)
    assert text.index('name = "second"') < text.index("[[model.load]]") < text.index("# how it is solved")
    text, place = with_table(TEXT, ("parameters", "drag"), {"lower": 0.0, "upper": "1 N*m*s"})
    assert text.index('[parameters]\ndrag = { lower = 0.0, upper = "1 N*m*s" }') < text.index("[model]")
    text, _ = with_table("[parameters.d]\nlower = 1\n\n[model]\n", ("parameters", "e"), {"lower": 2})
    assert text == "[parameters.d]\nlower = 1\n\n[parameters.e]\nlower = 2\n\n[model]\n"
    text, _ = with_table(text, ("identify",), {})
    assert text.endswith("[identify]\n")
    text, place = with_table("[parameters]\na = { lower = 0, upper = 1 }  # a\n", ("parameters", "b"), {"lower": 0.5})
    assert text == "[parameters]\na = { lower = 0, upper = 1 }  # a\nb = { lower = 0.5 }\n"
    assert with_table("", ("model", "body", 0), {"name": "A"})[0] == '[[model.body]]\nname = "A"\n'


def test_keys_and_tables_are_removed():
    assert lines_apart(TEXT, without(TEXT, ("model", "gravity"))) == (["gravity = [0.0, -9.81]  # g"], [])
    text = without(TEXT, ("model", "body", 0))
    assert [body["name"] for body in tomllib.loads(text)["model"]["body"]] == ["second"]
    assert "# the pin" in text
    text = without(TEXT, ("simulate", "times", "every"))
    assert tomllib.loads(text)["simulate"] == {"times": {"end": "4 s"}}
    assert without(TEXT, ("identify",)) == TEXT


@pytest.mark.parametrize(
    "path",
    sorted(set(STUDIES.glob("*/*.toml")) - set(STUDIES.glob("*/expected.toml"))),
    ids=lambda path: f"{path.parent.name}-{path.stem}",
)
def test_every_table_of_every_study_can_be_changed_and_changed_back(path):
    text = path.read_text(encoding="utf-8")
    document, headers = tomllib.loads(text), {place for place, _ in tables(text)}
    places = [
        (table, number) for table, value in document.items() if isinstance(value, list) for number in range(len(value))
    ]
    places += [(table,) for table, value in document.items() if isinstance(value, dict)]
    places += [
        ("model", key, n)
        for key, value in document.get("model", {}).items()
        if isinstance(value, list)
        for n, one in enumerate(value)
        if isinstance(one, dict)
    ]
    for place in headers.intersection(places):
        changed = with_value(text, (*place, "x_new"), "1 m")
        assert child(tomllib.loads(changed), (*place, "x_new")) == "1 m"
        assert without(changed, (*place, "x_new")) in (text, f"{text}\n")


def test_invalid_text_and_stale_places_are_refused():
    with pytest.raises(InputError, match=r"The text is not valid TOML: .* Correct it first"):
        with_value("[model]\na = \nb = 1\n", ("model", "b"), 2)
    with pytest.raises(InputError, match="The text has changed meanwhile"):
        without("[model]\na = 1\n", ("model", "b"))


def test_values_of_texts():
    number, text = TableField("mass", "number"), TableField("at", "text")
    assert value_of(" 2 ", number) == 2
    assert value_of("2", text) == "2"
    assert value_of("[0.1, 0]", text) == [0.1, 0]
    assert value_of("{ kind = 'Step', value = 2.0 }", number) == {"kind": "Step", "value": 2.0}
    with pytest.raises(InputError, match=r"mass: \[1, is not valid TOML"):
        value_of("[1,", number)


VALUES = st.recursive(
    st.booleans() | st.integers(-9, 9) | st.floats(allow_nan=False, allow_infinity=False) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(min_size=1, max_size=4), inner, max_size=3),
    max_leaves=6,
)


@settings(max_examples=60, deadline=None)
@given(VALUES, st.text(min_size=1, max_size=6))
def test_any_value_is_written_and_read_back(value, key):
    text = with_value(TEXT, ("model", "body", 0, key), value)
    assert tomllib.loads(text)["model"]["body"][0][key] == value
    if isinstance(value, list | dict):
        assert value_of(text_of(value), TableField(key, "text")) == value


def test_templates_stay_as_they_are():
    for one in templates().values():
        assert with_value(one.text, ("study", "title"), tomllib.loads(one.text)["study"]["title"]) == one.text
