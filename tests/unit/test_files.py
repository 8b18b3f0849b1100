"""Files that are whole or not there."""

import pytest

from dalembert.errors import InputError
from dalembert.files import replacing, write_text


def test_a_failed_write_leaves_the_file_as_it_was(tmp_path):
    path = tmp_path / "a.txt"
    write_text(path, "before")

    def write_half() -> None:
        with replacing(path) as temporary:
            temporary.write_text("half")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_half()
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]


def test_a_write_replaces_the_whole_file(tmp_path):
    path = tmp_path / "a.txt"
    write_text(path, "a long text before")
    write_text(path, "ü\n")
    assert path.read_bytes() == "ü\n".encode()
    assert path.stat().st_mode & 0o777 == 0o644


def test_a_folder_that_is_not_there_is_named(tmp_path):
    folder = tmp_path / "nowhere"
    with pytest.raises(InputError) as error:
        write_text(folder / "a.txt", "text")
    assert str(error.value) == (
        f"{folder / 'a.txt'} cannot be written: there is no folder {folder}; make it, or choose another path"
    )
