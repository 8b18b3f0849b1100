"""The state of an open study: text, history, values, selection, and what happened to its file."""

import os

import pytest

from dalembert.errors import InputError
from dalembert.studio.editor.draft import ChangedOnDiskError, Draft
from dalembert.studio.editor.reading import read
from dalembert.study.template import templates
from support import says

IDENTIFY = templates()["identify"]


@pytest.fixture
def path(tmp_path):
    folder = tmp_path / "studies" / "drag"
    folder.mkdir(parents=True)
    for name, text in IDENTIFY.files.items():
        (folder / name).write_text(text)
    (folder / "study.toml").write_text(IDENTIFY.text)
    return folder / "study.toml"


@pytest.fixture
def draft(path):
    clock = iter(range(0, 1000, 10))
    return Draft(path, clock=lambda: next(clock))


def followed(draft, *topics):
    """Topics in the order in which their followers were called."""
    heard = []
    for topic in topics:
        draft.follow(topic, lambda topic=topic: heard.append(topic))
    return heard


def written_elsewhere(path, text):
    """Another program writes the file, at a later time."""
    before = path.stat().st_mtime_ns
    path.write_text(text)
    os.utime(path, ns=(before + 10**9, before + 10**9))


def test_a_draft_is_the_study_that_its_text_is(draft):
    heard = followed(draft, "text", "study", "values", "selection", "disk")
    assert draft.study is None
    draft.check()
    assert draft.study.task == "identify"
    assert draft.name == "drag/study"
    assert heard == ["values", "study"]
    draft.set_text(draft.text.replace("[identify]", "[identyfy]"))
    draft.check()
    assert draft.study is None
    assert draft.good is not None
    assert "identyfy" in draft.mistakes[0].sentence
    assert heard == ["values", "study", "text", "study"]


def test_a_panel_can_find_mistakes_in_a_valid_text(draft):
    draft.check()
    heard = followed(draft, "study", "mistakes")
    draft.find("[[model.joint]] 'pin': it is not closed")
    draft.find("[[model.joint]] 'pin': it is not closed")
    assert [(one.place, draft.text.splitlines()[one.line - 1]) for one in draft.mistakes] == [
        (("model", "joint", 0), "[[model.joint]]")
    ]
    assert draft.study is not None
    assert heard == ["mistakes"]
    draft.check()
    assert draft.mistakes == ()


def test_a_reading_of_an_older_text_is_left_out(draft):
    old = read(draft.path, draft.text)
    draft.set_text("")
    draft.take(old)
    assert draft.study is None


def test_changes_are_undone_and_repeated(draft):
    first = draft.text
    draft.set_text("a")
    draft.set_text("b")
    draft.undo()
    assert (draft.text, draft.can_undo, draft.can_redo) == ("a", True, True)
    draft.undo()
    draft.undo()
    assert (draft.text, draft.can_undo, draft.is_saved) == (first, False, True)
    draft.redo()
    draft.set_text("c")
    draft.redo()
    assert (draft.text, draft.can_redo) == ("c", False)


def test_what_is_typed_without_a_pause_is_one_step(path):
    times = iter([0.0, 0.3, 0.6, 5.0])
    draft = Draft(path, clock=lambda: next(times))
    for text in ("a", "ab", "abc", "abc d"):
        draft.set_text(text, typed=True)
    draft.undo()
    assert draft.text == "abc"
    draft.undo()
    assert draft.text == IDENTIFY.text


def test_what_was_typed_too_late_is_found_by_undo(draft):
    draft.set_text("theirs")
    draft.recall("mine")
    assert draft.text == "theirs"
    draft.undo()
    assert draft.text == "mine"


def test_a_text_of_a_lost_page_is_shown_again(draft, path):
    draft.restore("mine = 1\n", IDENTIFY.text)
    assert (draft.text, draft.is_saved, draft.disk) == ("mine = 1\n", False, "same")
    draft.undo()
    assert draft.is_saved
    draft.redo()
    draft.save()
    assert path.read_text() == "mine = 1\n"


def test_a_text_of_a_lost_page_does_not_replace_what_others_wrote_meanwhile(draft, path):
    draft.restore("mine = 1\n", "before = 1\n")
    assert draft.disk == "changed"
    with pytest.raises(ChangedOnDiskError):
        draft.save()
    assert path.read_text() == IDENTIFY.text
    draft.undo()
    assert draft.text == IDENTIFY.text


def test_an_edit_keeps_comments_and_order(draft):
    draft.set_text("# mine\nb = 1 # one\na = 2\n")
    draft.edit(lambda document: document.update({"b": 3}))
    assert draft.text == "# mine\nb = 3 # one\na = 2\n"
    draft.undo()
    assert draft.text == "# mine\nb = 1 # one\na = 2\n"
    draft.set_text("a = = 1")
    with pytest.raises(
        InputError,
        match=says("The text is not valid TOML: Unexpected character: '=' at line 1 col 4. Correct it first."),
    ):
        draft.edit(lambda document: None)


def test_values_begin_at_the_start_and_stay_while_the_parameter_does(draft):
    draft.check()
    start = draft.values["drag"]
    heard = followed(draft, "values")
    draft.set_value("drag", 0.3)
    draft.set_value("drag", 0.3)
    draft.set_text(draft.text + "\n# more\n")
    draft.check()
    assert draft.values["drag"] == 0.3
    assert heard == ["values"]
    draft.edit(lambda document: document["parameters"]["drag"].update({"start": 0.25}))
    draft.check()
    assert draft.values["drag"] == 0.25 != start
    assert heard == ["values", "values"]
    with pytest.raises(InputError, match=r"unknown parameter 'drug'; did you mean 'drag'\?"):
        draft.set_value("drug", 1.0)


def test_a_selection_is_told_once(draft):
    heard = followed(draft, "selection")
    draft.select(("model", "body", 0))
    draft.select(("model", "body", 0))
    draft.select(None)
    assert heard == ["selection", "selection"]


def test_a_follower_can_end(draft):
    heard = []
    end = draft.follow("text", lambda: heard.append(1))
    draft.set_text("a")
    end()
    draft.set_text("b")
    assert heard == [1]


def test_a_file_that_somebody_else_changed_is_not_overwritten(draft, path):
    heard = followed(draft, "disk")
    draft.set_text("mine = 1\n")
    written_elsewhere(path, "theirs = 1\n")
    draft.check_disk()
    assert draft.disk == "changed"
    with pytest.raises(ChangedOnDiskError) as raised:
        draft.save()
    assert str(raised.value) == (
        "study.toml changed on disk and was not overwritten. Choose Reload, Keep mine or Save as a copy above the text."
    )
    assert path.read_text() == "theirs = 1\n"
    assert heard == ["disk"]


def test_a_change_without_a_new_time_is_noticed_when_saving(draft, path):
    stamp = path.stat()
    path.write_text(IDENTIFY.text.replace("0", "1"))
    os.utime(path, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    draft.check_disk()
    assert draft.disk == "same"
    with pytest.raises(ChangedOnDiskError):
        draft.save()


def test_reload_takes_the_file_and_undo_brings_back_the_text(draft, path):
    draft.set_text("mine = 1\n")
    written_elsewhere(path, "theirs = 1\r\n")
    draft.check_disk()
    draft.reload()
    assert (draft.text, draft.disk, draft.is_saved) == ("theirs = 1\n", "same", True)
    draft.undo()
    assert (draft.text, draft.is_saved) == ("mine = 1\n", False)


def test_keep_mine_lets_the_next_save_replace_the_file(draft, path):
    draft.set_text("mine = 1\n")
    written_elsewhere(path, "theirs = 1\n")
    draft.check_disk()
    draft.keep()
    assert (draft.text, draft.disk, draft.is_saved) == ("mine = 1\n", "same", False)
    draft.save()
    assert path.read_text() == "mine = 1\n"
    assert draft.is_saved


def test_a_copy_leaves_the_file_alone(draft, path):
    draft.set_text("mine = 1\n")
    written_elsewhere(path, "theirs = 1\n")
    copy = draft.save_copy()
    assert copy.name == "study-2.toml"
    assert copy.read_text() == "mine = 1\n"
    assert path.read_text() == "theirs = 1\n"


def test_a_file_that_is_gone_can_be_saved_again(draft, path):
    heard = followed(draft, "disk")
    path.unlink()
    draft.check_disk()
    assert draft.disk == "gone"
    draft.save()
    assert path.read_text() == IDENTIFY.text
    assert draft.disk == "same"
    assert heard == ["disk", "disk"]


def test_a_file_with_other_ends_of_lines_is_not_a_changed_one(path):
    path.write_bytes(b"a = 1\r\nb = 2\r\n")
    draft = Draft(path)
    assert (draft.text, draft.is_saved) == ("a = 1\nb = 2\n", True)
    draft.set_text("a = 2\n")
    draft.save()
    assert path.read_bytes() == b"a = 2\n"


def test_what_cannot_be_read_or_written_is_a_sentence(draft, path, monkeypatch):
    draft.set_text("#" * 10_000_001)
    with pytest.raises(InputError, match=says("The study has more than 10000000 bytes. Move data to files beside it.")):
        draft.save()
    path.write_bytes(b"\xff")
    with pytest.raises(InputError, match="the file is not UTF-8 text"):
        Draft(path)
    path.unlink()
    with pytest.raises(InputError, match=says("study.toml cannot be read: No such file or directory.")):
        Draft(path)


def test_changes_of_the_files_that_a_text_names_are_noticed(draft, path):
    data = path.with_name("motion.csv")
    content, heard = data.read_text(), followed(draft, "files")
    draft.check()
    draft.check_files()
    assert heard == []
    written_elsewhere(data, content + "\n")
    draft.check_files()
    draft.check_files()
    assert heard == ["files"]
    data.unlink()
    draft.check_files()
    draft.check()
    assert "motion.csv" in draft.mistakes[0].sentence
    data.write_text(content)
    draft.check_files()
    assert heard == ["files"] * 3
    draft.check()
    assert draft.study is not None


def test_the_repair_of_a_model_file_is_noticed(path):
    whole = path.read_text()
    head, _, rest = whole.partition("[model]")
    model, at, task = f"[model]{rest}".partition("[solver]")
    path.write_text(f'{head}[model]\nfile = "pendulum.toml"\n{at}{task}')
    other = path.with_name("pendulum.toml")
    other.write_text("[model")
    draft = Draft(path)
    draft.check()
    assert draft.study is None
    heard = followed(draft, "files")
    written_elsewhere(other, model)
    draft.check_files()
    assert heard == ["files"]
    draft.check()
    assert draft.mistakes == ()


def test_a_file_that_a_panel_shows_is_watched_too(draft, path):
    draft.check()
    other = path.with_name("other.csv")
    draft.watched_files.show(other)
    heard = followed(draft, "files")
    other.write_text("t,x\n")
    draft.check_files()
    draft.watched_files.show(other)
    draft.check_files()
    assert heard == ["files"]
