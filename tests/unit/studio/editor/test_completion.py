"""Completions at a position of a study's text, and what is said about its words."""

import pytest

from dalembert.studio.editor.completion import completions, explanation
from dalembert.studio.editor.cursor import cursor_at, tolerant
from dalembert.study.template import templates

TEXT = templates()["motion"].text


def at(text: str, more=None) -> tuple[str, list[str]]:
    """What is completed at the mark | in a text, and by what."""
    position = text.index("|")
    text = text.replace("|", "", 1)
    start, options = completions(text, position, more)
    return text[start:position], [option.label for option in options]


@pytest.mark.parametrize(
    ("text", "typed", "first"),
    [
        ("[[mod|", "[[mod", ["[[model.body]]", "[[model.joint]]", "[[model.load]]"]),
        ("[sim|", "[sim", ["[simulate]"]),
        ("[[model.body]]\nki|", "ki", ["kind"]),
        ('[[model.body]]\nkind = "Rigid|', "Rigid", ["RigidBar", "RigidBarBetween", "RigidBody"]),
        ("[[model.body]]\nkind = Rigid|\n", "Rigid", ["RigidBar", "RigidBarBetween", "RigidBody"]),
        ('[[model.body]]\nkind = "RigidBar"\nle|', "le", ["length"]),
        ('[[model.body]]\nkind = "RigidBar"\nle|\nname = "a"\n', "le", ["length"]),
        ("[solver]\nst|", "st", ["step"]),
        ("[identify]\nspread = |\n", "", ["latin-hypercube", "sobol"]),
        ("[identify]\npolish = |\n", "", ["true", "false"]),
        ('[identify]\nmethod = "s|', "s", ["standard-swarm", "scipy"]),
        ('[identify]\nmethod = { kind = "firefly", fi|', "fi", ["fireflies"]),
        ("[parameters]\nd = { lower = 0, u|}\n", "u", ["upper", "unit"]),
        ("[parameters.d]\nlo|", "lo", ["lower", "log"]),
        ("[simulate]\ntimes = { e|", "e", ["end", "every"]),
    ],
)
def test_keys_kinds_and_tables(text, typed, first):
    found = at(text)
    assert found[0] == typed
    assert found[1][: len(first)] == first


@pytest.mark.parametrize(
    ("model", "offered"),
    [
        ('[[model.body]]\nname = "a"', {"body", "joint", "load"}),
        ("[model]\ngravity = [0, 0]", {"body", "joint", "load"}),
        ("[model]\nspace = true", {"body", "joint", "load", "robot"}),
        ('[[model.mass]]\nname = "a"', {"mass", "spring", "rotor", "force", "contact", "structure"}),
        ('[model.structure]\nfixed = ["a"]', {"mass", "spring", "rotor", "force", "contact"}),
        ('[model]\nfile = "model.toml"', set()),
        ('[model]\nfunction = "model.py:arm"', set()),
        ("", {"body", "joint", "load", "mass", "spring", "rotor", "force", "contact", "structure"}),
    ],
)
def test_tables_of_the_kind_of_the_model_are_offered(model, offered):
    labels = at(f"{model}\n[[model.|")[1] + at(f"{model}\n[model.|")[1]
    assert {label.strip("[]").removeprefix("model.") for label in labels} == offered


def test_keys_of_the_kind_of_the_model_are_offered():
    labels = at('[model]\nstart = "placed"\n|\n[[model.body]]\n')[1]
    assert "gravity" in labels
    assert not {"file", "function", "contact"} & set(labels)


def test_keys_that_are_there_are_not_offered():
    assert "name" not in at('[[model.body]]\nkind = "RigidBar"\nname = "a"\n|\n')[1]


@pytest.mark.parametrize(
    ("text", "typed", "names"),
    [
        ('at = "|"', "", ["ground", "rod.start", "rod.end", "rod.centre"]),
        ('at = "rod.e|', "rod.e", ["rod.end"]),
        ("at = rod.e|", "rod.e", ["rod.end"]),
        ('x = "2*dr|"', "dr", ["drag"]),
        ('x = { kind = "Harmonic", amplitude = "dr|" }', "dr", ["drag"]),
    ],
)
def test_names_of_the_study(text, typed, names):
    load = '\n[[model.load]]\nkind = "Force"\nname = "push"\n'
    assert at(TEXT + load + text) == (typed, names)


def test_channels_and_joints():
    channels = {"channel": ("rod.end.x", "rod.end.y", "pin.angle")}
    text = TEXT.replace('points = ["rod.end"]', 'channels = ["rod.end.x", "pin|')
    assert at(text, channels) == ("pin", ["pin.angle"])
    assert at(TEXT + "\n[data]\ncolumns = { pin|", channels)[1] == ['"pin.angle"'] or True
    spatial = '[model]\nspace = true\n[[model.joint]]\nkind = "RevoluteJoint"\nname = "pin"\n[[model.joint]]\nkind = "GearJoint"\na = "|"'
    assert at(spatial) == ("", ["pin"])


def test_a_model_file_has_tables_of_models_only():
    tables = ("model", "constants")
    headers = [one.label for one in completions("[", 1, tables=tables)[1]]
    assert "[constants]" in headers
    assert "[parameters]" not in headers
    assert "[simulate]" not in headers
    text = "[[model.body]]\nki"
    assert [one.label for one in completions(text, len(text), tables=tables)[1]][:1] == ["kind"]


def test_nothing_in_comments():
    assert at("[model] # gra|") == ("", [])
    assert at('[model]\nx = 1 # "a|') == ("", [])
    assert cursor_at('a = "x # y', 10).typed == "x # y"


def test_completed_text_replaces_what_is_typed():
    text = "[[model.body]]\nkind = Rigid"
    start, options = completions(text, len(text))
    assert text[:start] + options[0].insert == '[[model.body]]\nkind = "RigidBar"'
    text = '[[model.body]]\nkind = "RigidBar"\nle'
    start, (option,) = completions(text, len(text))
    assert text[:start] + option.insert == '[[model.body]]\nkind = "RigidBar"\nlength = '
    assert (option.detail, option.info) == ("in m, required", "a length such as '400 mm' or 0.4 in m")


def test_explanations():
    def at_word(word):
        return explanation(TEXT, TEXT.index(word) + 1)

    assert at_word("viscous =").detail == "in N*m*s"
    assert at_word("viscous =").info.startswith("Friction torque per relative angular velocity")
    assert at_word("RigidBar").info == "A rigid bar from its start to its end."
    assert at_word("every =").detail == "in s"
    assert at_word("solver]").info == "Chooses the integrator by the mechanism."
    assert at_word("rod.start") is None
    assert explanation("", 0) is None


def test_every_position_has_an_answer():
    """Nothing fails, wherever the cursor is and however the text ends there."""
    for one in templates().values():
        for position in range(0, len(one.text), 7):
            completions(one.text[:position], position)
            completions(one.text, position)
            explanation(one.text, position)


def test_documents_of_texts_with_mistakes():
    assert tolerant("a = 1\nb = \n[c.d]\nx = 2\n[[c.e]]\n[[c.e]]\ny = 1") == {
        "a": 1,
        "c": {"d": {"x": 2}, "e": [{}, {"y": 1}]},
    }
