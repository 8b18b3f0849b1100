"""What a text is as the model of a study."""

import pytest

from dalembert.studio.editor.model_reading import model_reading
from dalembert.studio.worker import Kept
from dalembert.study.template import templates

HEAD, _, _REST = templates()["motion"].text.partition("[constants]")
MODEL, _, _TASK = f"[constants]{_REST}".partition("[solver]")
STUDY = f'{HEAD}[model]\nfile = "pendulum.toml"\n[solver]{_TASK}'


@pytest.fixture
def study(tmp_path):
    (tmp_path / "pendulum.toml").write_text("[model")
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path / "study.toml"


def test_a_model_in_order(study):
    found = model_reading(Kept(), study, MODEL)
    assert found.mistakes == ()
    assert found.study is not None
    assert "rod.end.x" in found.study.channels
    assert found.does == "As the model of study.toml, it simulates the motion to 4 s: 1 simulation."
    assert {path.name for path in found.files} == {"study.toml", "pendulum.toml"}


@pytest.mark.parametrize(
    ("right", "wrong", "sentence"),
    [
        ('mass = "1.5 kg"', 'mass = "1.5 m"', "[[model.body]] 'rod', mass: "),
        ('b = "rod.start"', 'b = "rod.strat"', "[[model.joint]] 'pin', b: "),
        ('name = "pin"', "name pin", "pendulum.toml: no valid TOML: "),
    ],
)
def test_a_mistake_of_the_model_stands_at_its_line(study, right, wrong, sentence):
    text = MODEL.replace(right, wrong)
    (found,) = model_reading(Kept(), study, text).mistakes
    assert text.splitlines()[found.line - 1] == wrong
    assert found.sentence.startswith(sentence)


def test_a_mistake_of_the_study_has_its_name(study):
    study.write_text(STUDY.replace("[simulate]", "[simulat]"))
    (found, *_) = model_reading(Kept(), study, MODEL).mistakes
    assert found.sentence.startswith("study.toml: ")
