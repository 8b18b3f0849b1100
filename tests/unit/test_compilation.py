"""What is said where compilation takes a while."""

from types import SimpleNamespace

from dalembert.compilation import announce_compilation


def law() -> None:
    """Stands for a compiled function."""


def test_a_first_compilation_is_announced_once(tmp_path, capsys):
    function = dispatcher(tmp_path)
    announce_compilation(function, "its laws", "about half a minute")
    announce_compilation(function, "its laws", "about half a minute")
    said = "dalembert: compiling its laws, once on this machine; this takes about half a minute\n"
    assert capsys.readouterr().err == said


def test_what_is_on_disk_is_not_announced(tmp_path, capsys):
    (tmp_path / "test_compilation.law-10.py311.nbi").touch()
    announce_compilation(dispatcher(tmp_path), "its laws", "about half a minute")
    assert capsys.readouterr().err == ""


class Dispatcher(SimpleNamespace):
    __hash__ = object.__hash__


def dispatcher(folder) -> Dispatcher:
    return Dispatcher(_cache=SimpleNamespace(cache_path=str(folder)), py_func=law)
