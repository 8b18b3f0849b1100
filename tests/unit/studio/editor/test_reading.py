"""What a text is as a study, and the places in it."""

import pytest

from dalembert.studio.editor.lines import line_of, lines_of, place_at, table_of
from dalembert.studio.editor.reading import mistake, read
from dalembert.study.template import templates

TEXT = templates()["motion"].text


def mistakes_of(tmp_path, text: str) -> list[tuple[str, str]]:
    """Lines that mistakes are told at, and their sentences."""
    found = read(tmp_path / "study.toml", text)
    assert found.study is None
    assert found.does == ""
    return [(text.splitlines()[one.line - 1], one.sentence) for one in found.mistakes]


def test_a_study_in_order(tmp_path):
    found = read(tmp_path / "study.toml", TEXT)
    assert found.study is not None
    assert found.study.task == "simulate"
    assert found.does == "It simulates the motion to 4 s: 1 simulation."
    assert found.mistakes == ()


def test_a_mistake_stands_at_its_line(tmp_path):
    wrong = TEXT.replace('mass = "1.5 kg"', 'mass = "1.5 m"').replace("viscous", "viscus")
    found = mistakes_of(tmp_path, wrong)
    assert [line for line, _ in found] == ['mass = "1.5 m"', 'viscus = "drag"']
    assert found[1][1] == "[[model.joint]] 'pin': unknown key 'viscus'; did you mean 'viscous'?"


def test_a_mistake_that_names_its_table_stands_there(tmp_path):
    for right, wrong in (('b = "rod.start"', 'b = "rood.start"'), ('b = "rod.start"', 'b = "rod.strat"')):
        ((line, sentence),) = mistakes_of(tmp_path, TEXT.replace(right, wrong))
        assert line == wrong
        assert sentence.startswith("[[model.joint]] 'pin', b: ")


def test_what_is_no_toml_stands_at_its_line(tmp_path):
    for wrong in ('length "800 mm"', 'length = "800 mm" x'):
        ((line, sentence),) = mistakes_of(tmp_path, TEXT.replace('length = "800 mm"', wrong))
        assert line == wrong
        assert sentence.startswith("no valid TOML: ")


@pytest.mark.parametrize(
    ("right", "wrong", "sentence"),
    [
        ('mass = "1.5 kg"', 'mass = "1.5 m"', "[[model.body]] 'rod', mass: "),
        ('b = "rod.start"', 'b = "rod.strat"', "[[model.joint]] 'pin', b: "),
        ('drag = "0.2 N*m*s"', 'drag = "0.2 N*m*"', "[constants]: drag: "),
        ("[model]", "[model", ""),
        ("[model]", "[data]\n[model]", ""),
        ("[model]", "[modell]", ""),
    ],
)
def test_a_mistake_of_a_model_file_stands_where_the_file_is_named(tmp_path, right, wrong, sentence):
    title, _, rest = TEXT.partition("[constants]")
    model, _, task = f"[constants]{rest}".partition("[simulate]")
    (tmp_path / "pendulum.toml").write_text(model.partition("[solver]")[0].replace(right, wrong))
    solver = f"[solver]{model.partition('[solver]')[2]}" if "[solver]" in model else ""
    study = f'{title}[model]\nfile = "pendulum.toml"\n{solver}[simulate]{task}'
    ((line, said),) = mistakes_of(tmp_path, study)
    assert line == 'file = "pendulum.toml"'
    assert said.startswith(f"pendulum.toml: {sentence}" if sentence else "[model], file: pendulum.toml: ")


def test_a_line_of_another_file_is_no_line_of_the_study():
    assert mistake("a = 1\nb = 2\nc = 3\n", (), "data.csv, line 3: a number is missing").line == 1


def test_places_in_the_text():
    text = 'a = 1\n[model]\n[[model.body]]\nname = "A"\n[[model.body]]\n"b c".d = 2\n[parameters]\nx = { lower = 1 }\n'
    assert line_of(text, ("a",)) == 1
    assert line_of(text, ("model", "body", 0)) == 3
    assert line_of(text, ("model", "body", 1, "b c", "d")) == 6
    assert line_of(text, ("parameters", "x", "lower")) == 8
    assert line_of("", ("x",)) == 1


def test_a_line_belongs_to_a_key_in_a_table():
    text = "# a study\n[model]\n[[model.body]]\nmass = [\n  1,\n]\n\n[[model.body]]\n# light\nmass = 2\n"
    assert place_at(text, 1) == ()
    assert [place_at(text, line) for line in (2, 3, 5)] == [
        ("model",),
        ("model", "body", 0),
        ("model", "body", 0, "mass"),
    ]
    assert table_of(text, ("model", "body", 1, "mass")) == ("model", "body", 1)
    assert table_of(text, ("solver",)) == ()
    assert list(lines_of(text, ("model", "body", 0))) == [3, 4, 5, 6]
    assert list(lines_of(text, ("model", "body", 1))) == [8, 9, 10]
    assert list(lines_of(text, ("model", "body", 2))) == []
