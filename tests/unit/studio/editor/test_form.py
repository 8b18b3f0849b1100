"""Forms of tables, and what can be added by them."""

import tomllib

import pytest

from dalembert.errors import InputError
from dalembert.studio.editor.additions import added, additions
from dalembert.studio.editor.fields import child, field_at
from dalembert.studio.editor.form import form_at, with_row
from dalembert.studio.editor.reading import Mistake, read
from dalembert.study.tables.catalogue import kinds_of, structure_parts
from dalembert.study.tasks import TASKS
from dalembert.study.template import templates

TEXT = templates()["motion"].text


def addition(text, label):
    return next(one for one in additions(text) if one.label == label)


def test_the_form_of_a_table_has_its_values():
    form = form_at(TEXT, ("model", "joint", 0, "viscous"))
    assert (form.place, form.title, form.meaning) == (
        ("model", "joint", 0),
        "joint 'pin'",
        "A pin: both points coincide.",
    )
    rows = {row.field.key: row for row in form.rows}
    assert (rows["viscous"].text, rows["b"].text, rows["coulomb"].text) == ("drag", "rod.start", "")
    assert [key for key, row in rows.items() if row.is_usual] == ["kind", "name", "a", "b", "viscous"]
    assert form_at(TEXT, ("solver",)).meaning.startswith("Generalized-alpha")
    assert form_at(TEXT, ("constants", "drag")).rows[0].text == "0.2 N*m*s"
    assert form_at(TEXT, None) is None
    assert form_at(TEXT, ("simulate", "times"), inner=("times",)).rows[1].text == "4 s"


def test_a_parameter_in_one_line_has_a_form():
    text = "[parameters]\nd = { lower = 0, upper = 1 }\n"
    form = form_at(text, ("parameters", "d"))
    assert (form.title, form.rows[1].text) == ("parameters, d", "1")
    assert [row.field.key for row in form_at(text, ("parameters",)).rows] == ["d"]


def test_mistakes_stand_at_their_keys(tmp_path):
    wrong = TEXT.replace('mass = "1.5 kg"\nangle', 'mass = "1.5 m"\nlenght = 2\nangle').replace(
        'length = "800 mm"\n', ""
    )
    mistakes = read(tmp_path / "study.toml", wrong).mistakes
    form = form_at(wrong, ("model", "body", 0), mistakes)
    assert [row.mistakes for row in form.rows if row.field.key == "mass"] == [
        ("'1.5 m' was given; expected a mass such as '500 g' or 0.5 in kg",)
    ]
    assert sorted(form.mistakes) == [
        "[[model.body]] 'rod': the key 'length' is missing",
        "[[model.body]] 'rod': unknown key 'lenght'; did you mean 'length'?",
    ]
    assert form_at(wrong, ("model", "joint", 0), (Mistake((), 1, "no"),)).mistakes == ()


def test_what_is_written_is_read():
    place = ("model", "body", 0)
    mass = field_at(tomllib.loads(TEXT), (*place, "mass"))
    assert child(tomllib.loads(with_row(TEXT, place, mass, "2.5")), (*place, "mass")) == 2.5
    assert "mass" not in child(tomllib.loads(with_row(TEXT, place, mass, " ")), place)
    assert with_row(TEXT, place, mass, "1.5 kg") == TEXT
    adaptive = field_at(tomllib.loads(TEXT), ("solver", "adaptive"))
    assert tomllib.loads(with_row(TEXT, ("solver",), adaptive, "true"))["solver"]["adaptive"] is True
    with pytest.raises(InputError, match="is not valid TOML"):
        with_row(TEXT, place, mass, "[1")


def test_a_value_that_becomes_a_table():
    text = '[[model.load]]\nkind = "Force"\nname = "push"\nx = 2.0  # N\n'
    place = ("model", "load", 0, "x")
    kind = form_at(text, place[:3], inner=("x",)).rows[0].field
    changed = with_row(text, place, kind, "Harmonic")
    assert child(tomllib.loads(changed), place) == {"kind": "Harmonic"}
    form = form_at(changed, place[:3], inner=("x",))
    assert form.title == "load 'push', x"
    assert "amplitude" in form.keys


def test_parts_can_be_added_until_the_study_is_valid(tmp_path):
    """From nothing to a study, without any text but names and values."""
    text = ""
    text, body = added(text, addition(text, "Body"), "PointMass")
    text, joint = added(text, addition(text, "Joint"), "DistanceJoint")
    text, task = added(text, addition(text, "Task"), "simulate")
    text, solver = added(text, addition(text, "Table"), "solver")
    text, parameter = added(text, addition(text, "Parameter"), "m")
    text, _ = added(text, addition(text, "Constant"), "L")
    written = [
        (body, "mass", "m"), (body, "position", "[0.6, 0]"), (joint, "a", "ground(0, 0)"), (joint, "b", "body1.centre"),
        (joint, "length", "L"), (task, "end", "1 s"), (solver, "step", "1 ms"), (("constants",), "L", "600 mm"),
        (parameter, "lower", "0.1"), (parameter, "upper", "0.3 kg"),
    ]  # fmt: skip
    for place, key, value in written:
        text = with_row(text, place, field_at(tomllib.loads(text), (*place, key)), value)
    reading = read(tmp_path / "study.toml", text)
    assert reading.mistakes == ()
    assert reading.study is not None
    assert reading.study.parameters.names == ("m",)


def test_everything_that_there_is_can_be_added():
    planar, structure, spatial = TEXT, "[[model.mass]]\n", "[model]\nspace = true\n"
    for label, role in (("Body", "body"), ("Joint", "joint"), ("Force", "load")):
        assert set(addition(planar, label).kinds) >= {
            kind.__name__ for kind in kinds_of(role) if kind.__module__.startswith("dalembert.")
        }
        assert set(addition(spatial, label).kinds) >= {
            kind.__name__ for kind in kinds_of(role, space=True) if kind.__module__.startswith("dalembert.")
        }
    for key, kinds in structure_parts().items():
        assert set(addition(structure, key.capitalize()).kinds) == {
            kind.__name__ for kind in kinds if kind.__module__.startswith("dalembert.")
        }
    assert set(addition(planar, "Task").kinds) == set(TASKS) - {"simulate"}
    for text in (planar, structure, spatial):
        for one in additions(text):
            for kind in one.kinds or ("new",):
                changed, place = added(text, one, kind)
                assert child(tomllib.loads(changed), place) is not None
                assert one.place == ("constants",) or form_at(changed, place) is not None


def test_another_task_replaces_the_first():
    text, place = added(TEXT, addition(TEXT, "Task"), "identify")
    assert place == ("identify",)
    assert "simulate" not in tomllib.loads(text)


@pytest.mark.parametrize(
    ("model", "where"),
    [('file = "pendulum.toml"', "are in pendulum.toml"), ('function = "model.py:arm"', "The function model.py:arm")],
)
def test_parts_of_a_model_are_not_added_beside_the_file_or_function_that_has_them(model, where):
    text = f"[model]\n{model}\n[simulate]\n"
    for label in ("Body", "Joint", "Force"):
        assert where in addition(text, label).elsewhere
    assert addition(text, "Parameter").elsewhere == ""
    form = form_at(text, ("model",))
    assert form is not None
    assert set(form.keys) in ({"file"}, {"function", "forward", "arguments"})


def test_the_form_of_a_model_has_the_keys_of_its_kind():
    form = form_at("[model]\n[[model.body]]\n", ("model",))
    assert form is not None
    assert "gravity" in form.keys
    assert not {"contact", "structure", "file"} & set(form.keys)


def test_the_components_of_a_force_are_shown_at_once():
    form = form_at('[[model.load]]\nkind = "Force"\n', ("model", "load", 0))
    assert form is not None
    assert [row.field.key for row in form.rows if row.is_usual] == ["kind", "name", "at", "x", "y"]
