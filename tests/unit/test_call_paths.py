"""Paths through the package change files no more often than before."""

from itertools import count

import pytest

from call_paths import PACKAGE, Counts, counted, files_of_calls, limits, measured

SLACK = 1.05
"""What a count may exceed its limit by: other versions of other packages call back more or less often."""


@pytest.fixture(scope="module")
def counts():
    return measured()


@pytest.mark.parametrize("path", limits())
def test_a_path_changes_files_no_more_often_than_its_limit(counts, path):
    limit = limits()[path]
    assert limit["most"] <= limit["first"]
    assert counts[path].changes <= SLACK * limit["most"]


def in_file(name, source):
    """Functions of a source text, as if it stood in a file of the package."""
    functions = {}
    exec(compile(source, f"{PACKAGE}/{name}", "exec"), functions)
    return functions


def test_calls_are_counted_and_neither_returns_nor_functions_of_other_packages():
    inner = in_file("inner.py", "def inner(): return twin()\ndef twin(): return sorted([2, 1])")["inner"]
    outer = in_file("outer.py", "def outer(inner):\n    inner()\n    inner()\n    last()\ndef last(): pass")["outer"]
    files = [name.rpartition("/")[2] for name in files_of_calls(lambda: outer(inner))]
    assert files == ["outer.py", *4 * ["inner.py"], "outer.py"]
    assert counted(lambda: outer(inner)) == Counts(changes=2, files=2)


def test_a_path_is_counted_once_its_caches_are_filled_and_a_random_path_never():
    steps = count()
    calls = in_file("calls.py", "def first(): pass")["first"], in_file("others.py", "def second(): pass")["second"]
    assert counted(lambda: [call() for call in (calls if next(steps) == 0 else calls[:1])]) == Counts(0, 1)
    with pytest.raises(RuntimeError, match="No two of 6 runs count the same"):
        counted(lambda: [call() for call in calls * next(steps)])
