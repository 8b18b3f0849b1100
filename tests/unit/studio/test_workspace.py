"""The studio's folder: what may be written into it, and under which names."""

import pytest

from dalembert.errors import InputError
from dalembert.studio import workspace as module
from dalembert.studio.workspace import Workspace, as_text
from dalembert.study import load
from dalembert.study.template import templates
from support import says

BAD = [
    "",
    "..",
    ".",
    "../up",
    "a/b",
    "a\\b",
    "/etc/passwd",
    ".hidden",
    "-rf",
    "a\0b",
    "a\nb",
    "<script>",
    "x" * 101,
    "C:x",
    "ends in a dot.",
    " a",
    "a\u202eb",
    "摆" * 67,
    "a\udc80",
]
GOOD = [
    "Pendel (2)",
    "50 %",
    "a#b",
    "it's",
    "für & wider",
    "单摆",
    "a, b; c = d + 1",
    "नमस्ते",
    "x" * 100,
    "摆" * 66,
    "a..b",
]


@pytest.fixture
def workspace(tmp_path):
    return Workspace(tmp_path)


@pytest.mark.parametrize("name", BAD)
def test_names_that_lead_elsewhere_or_say_more_than_a_name_are_refused(workspace, name, tmp_path):
    study = workspace.create("mine", "")
    for refused in (
        lambda: workspace.create(name, ""),
        lambda: workspace.put(study, name, b""),
        lambda: workspace.new_run(name),
    ):
        with pytest.raises(InputError, match="cannot be a name here; expected at most 100 characters"):
            refused()
    assert [path.name for path in tmp_path.iterdir()] == ["studies"]


@pytest.mark.parametrize("name", GOOD)
def test_names_of_every_language_are_allowed(workspace, name):
    study = workspace.create(name, "[study]\n")
    assert workspace.studies() == [study]
    assert workspace.put(study, f"{name[:60]}.csv", b"t,x\n").read_bytes() == b"t,x\n"


def test_the_same_name_is_one_name_however_it_is_composed(workspace):
    assert workspace.create("fu\u0308r", "") == "f\u00fcr/study"
    with pytest.raises(InputError, match="there is a study"):
        workspace.create("f\u00fcr", "")


@pytest.mark.parametrize("name", ["../mine/study", "mine/../../x", "mine/nothing", "mine", ""])
def test_a_study_that_is_not_listed_is_not_read(workspace, name):
    workspace.create("mine", "")
    with pytest.raises(InputError, match="unknown study"):
        workspace.study(name)


def test_a_study_and_what_lies_beside_it(workspace, tmp_path):
    study = workspace.create("My study", "[study]\n")
    assert study == "My study/study"
    assert workspace.studies() == [study]
    assert workspace.put(study, "data.csv", b"t,x\n").read_bytes() == b"t,x\n"
    with pytest.raises(InputError, match=says("there is a study 'My study' already; choose another name")):
        workspace.create("My study", "")
    (tmp_path / "studies" / "My study" / "expected.toml").write_text("a = 1")
    assert workspace.studies() == [study]
    with pytest.raises(InputError, match=says("unknown run 'nothing'; known: none")):
        workspace.run("nothing")


STUDY = '[study]\ntitle = "A"\n[model]\nfile = "model.toml"\n[simulate]\n'
MODEL = '[constants]\ndrag = 1\n[model]\n[[model.body]]\nkind = "PointMass"\n'


@pytest.mark.parametrize(
    "text",
    [
        STUDY,
        STUDY.replace('"A"', '"A'),
        STUDY.replace("[simulate]", "[simulate"),
        STUDY.replace("[simulate]", ""),
        "[model]\n[simulat]\n",
        "[parameters]\n[identify]\nstarts = \n",
        "",
        "=",
    ],
)
def test_a_study_with_mistakes_in_a_file_of_any_name_stays_listed(tmp_path, text):
    file = tmp_path / "studies" / "mine" / "motion.toml"
    file.parent.mkdir(parents=True)
    file.write_text(text)
    assert Workspace(tmp_path).studies() == ["mine/motion"]
    assert Workspace(tmp_path).study("mine/motion") == file


@pytest.mark.parametrize(
    "text",
    [
        MODEL,
        MODEL.replace("drag = 1", "drag = "),
        '[project]\nname = "mine"\n[tool.ruff]\n',
        '[project]\nname = "mine\n',
        '["identify.toml"]\ndrag = 0.2\n',
        "[identify]\ndrag = 0.2\n[simulate]\n",
    ],
)
def test_other_toml_files_are_no_studies_until_they_are_opened_as_one(workspace, tmp_path, text):
    study = workspace.create("mine", STUDY)
    (tmp_path / "studies" / "mine" / "other.toml").write_text(text)
    assert workspace.studies() == [study]
    assert workspace.study("mine/other").name == "other.toml"
    assert workspace.studies() == ["mine/other", study]


def test_a_file_that_was_a_study_stays_listed(workspace, tmp_path):
    study = workspace.create("mine", STUDY)
    file = tmp_path / "studies" / "mine" / "motion.toml"
    file.write_text(STUDY)
    assert workspace.studies() == ["mine/motion", study]
    file.write_text(MODEL)
    assert workspace.studies() == ["mine/motion", study]
    file.unlink()
    assert workspace.studies() == [study]


def test_the_model_file_of_a_study(workspace, tmp_path):
    study = workspace.create("mine", STUDY)
    folder = tmp_path / "studies"
    assert workspace.model_of(study) == folder / "mine" / "model.toml"
    for file, found in (("../shared.toml", folder / "shared.toml"), ("../../other.toml", None), ("/etc/a.toml", None)):
        (folder / "mine" / "study.toml").write_text(STUDY.replace("model.toml", file))
        if found is not None:
            assert workspace.model_of(study) == found
            continue
        sentence = f"{file} is no TOML file in the folder of the studies; edit it with another program"
        with pytest.raises(InputError, match=says(sentence)):
            workspace.model_of(study)
    (folder / "mine" / "study.toml").write_text("[model]\n[simulate]\n")
    with pytest.raises(InputError, match=says("study.toml names no model file; its model is in the study itself")):
        workspace.model_of(study)


@pytest.mark.parametrize("name", ["model.py", "a.PY", "study.toml", "lib.so"])
def test_programs_and_studies_are_not_taken_for_data(workspace, name):
    study = workspace.create("mine", "")
    sentence = f"{name!r} is no data file; put programs and studies into the folder yourself"
    with pytest.raises(InputError, match=says(sentence)):
        workspace.put(study, name, b"")


def test_what_is_too_large_or_no_text_is_refused(workspace, monkeypatch):
    study = workspace.create("mine", "")
    monkeypatch.setattr(module, "MOST_BYTES", 3)
    with pytest.raises(InputError, match=says("'a.csv' has 4 bytes; expected at most 3")):
        workspace.put(study, "a.csv", b"1234")
    with pytest.raises(InputError, match=says("a.toml, line 2: the file is not UTF-8 text; save it as UTF-8")):
        as_text(b"a = 1\nb = '\xff'", "a.toml")
    monkeypatch.setattr(module, "LARGEST", 3)
    with pytest.raises(InputError, match=says("a.toml has more than 3 bytes; expected a study file")):
        as_text(b"1234", "a.toml")
    with pytest.raises(InputError, match=says("study.toml has more than 3 bytes; expected a study file")):
        workspace.create("other", "1234")


@pytest.mark.parametrize("one", templates().values(), ids=lambda one: one.name)
def test_a_template_is_a_study_in_order(workspace, one):
    study = workspace.create(one.name, one.text)
    assert workspace.free(one.name) == f"{one.name}-2"
    for name, content in one.files.items():
        workspace.put(study, name, content.encode())
    assert load(workspace.study(study)).title == one.title
