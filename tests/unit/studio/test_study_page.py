"""What the page of a study says about its text."""

from dalembert.studio.lines import line_of
from dalembert.studio.study_page import _read
from dalembert.study.template import templates

TEXT = templates()["motion"].text


def lines_of(tmp_path, text: str) -> list[tuple[str, str]]:
    """Lines that mistakes are told at, and their sentences."""
    study, does, mistakes = _read(tmp_path / "study.toml", text)
    assert study is None
    assert does == ""
    return [(text.splitlines()[line - 1], sentence) for line, sentence in mistakes]


def test_a_study_in_order(tmp_path):
    study, does, mistakes = _read(tmp_path / "study.toml", TEXT)
    assert study is not None
    assert study.task == "simulate"
    assert does == "It simulates the motion to 4 s: 1 simulation."
    assert mistakes == []


def test_a_mistake_stands_at_its_line(tmp_path):
    wrong = TEXT.replace('mass = "1.5 kg"', 'mass = "1.5 m"').replace("viscous", "viscus")
    found = lines_of(tmp_path, wrong)
    assert [line for line, _ in found] == ['mass = "1.5 m"', 'viscus = "drag"']
    assert found[1][1] == "[[model.joint]] 'pin': unknown key 'viscus'; did you mean 'viscous'?"


def test_what_is_no_toml_stands_at_its_line(tmp_path):
    for wrong in ('length "800 mm"', 'length = "800 mm" x'):
        ((line, sentence),) = lines_of(tmp_path, TEXT.replace('length = "800 mm"', wrong))
        assert line == wrong
        assert sentence.startswith("no valid TOML: ")


def test_places_in_the_text():
    text = 'a = 1\n[model]\n[[model.body]]\nname = "A"\n[[model.body]]\n"b c".d = 2\n[parameters]\nx = { lower = 1 }\n'
    assert line_of(text, ("a",)) == 1
    assert line_of(text, ("model", "body", 0)) == 3
    assert line_of(text, ("model", "body", 1, "b c", "d")) == 6
    assert line_of(text, ("parameters", "x", "lower")) == 8
    assert line_of("", ("x",)) == 1
