"""A disk without room, and folders that may not be written to: a sentence that says what to do, and nothing is lost."""

import errno
import os
from pathlib import Path

import pytest

from dalembert import files
from dalembert.errors import StorageError, unchanged
from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.reading import read
from dalembert.studio.workspace import Workspace
from dalembert.study.template import templates

TEXT = templates()["motion"].text
DO = "what was there before is unchanged: see that the disk has room and that the folder may be written to, and try again"


@pytest.fixture
def workspace(tmp_path):
    return Workspace(tmp_path)


@pytest.fixture
def full(monkeypatch):
    """Let no file be written any more."""

    def refuse(path: Path, *_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))

    def fill() -> None:
        monkeypatch.setattr(Path, "write_text", refuse)
        monkeypatch.setattr(Path, "write_bytes", refuse)
        monkeypatch.setattr(files.tempfile, "TemporaryDirectory", lambda: refuse(Path("/tmp/x")))

    return fill


def test_a_save_without_room_keeps_text_and_file(workspace, full):
    path = workspace.study(workspace.create("mine", TEXT))
    draft = Draft(path)
    draft.set_text("# mine\n" + TEXT)
    full()
    with pytest.raises(StorageError) as raised:
        draft.save()
    assert unchanged(raised.value) == f"{path} cannot be written: No space left on device; {DO}"
    assert (draft.is_saved, draft.text[:6], path.read_text()) == (False, "# mine", TEXT)
    assert sorted(entry.name for entry in path.parent.iterdir()) == ["study.schema.json", "study.toml"]


def test_a_text_is_checked_without_workspace(workspace, full):
    path = workspace.study(workspace.create("mine", TEXT))
    full()
    assert read(path, TEXT).study is not None
    assert read(path, "a = [").mistakes


def test_a_new_study_is_there_whole_or_not_at_all(workspace, full, tmp_path):
    (tmp_path / "studies").mkdir()
    full()
    with pytest.raises(StorageError, match="cannot be written: No space left on device"):
        workspace.create("mine", TEXT)
    assert not list((tmp_path / "studies").iterdir())


def test_a_file_that_was_there_outlives_an_upload_without_workspace(workspace, full):
    study = workspace.create("mine", TEXT)
    placed = workspace.put(study, "data.csv", b"t,x\n")
    full()
    with pytest.raises(StorageError, match="cannot be written: No space left on device"):
        workspace.put(study, "data.csv", b"t,y\n")
    assert placed.read_bytes() == b"t,x\n"


def test_a_folder_that_may_not_be_made_is_a_sentence():
    error = PermissionError(errno.EACCES, "Permission denied", "/w/studies/mine")
    assert unchanged(error) == f"/w/studies/mine cannot be written or read: Permission denied; {DO}"


@pytest.mark.parametrize(
    "error",
    [
        OSError(28, "Can't write data (file write failed: errno = 28, error message = 'No space left on device')"),
        RuntimeError("Can't decrement id ref count (unable to close: errno = 28, error message = 'No space left')"),
    ],
)
def test_the_words_of_hdf5_become_the_system_s(error, tmp_path):
    sentence = r"^\S+result\.nc cannot be written: No space left on device; "
    with pytest.raises(StorageError, match=sentence), files.replacing(tmp_path / "result.nc"):
        raise error
