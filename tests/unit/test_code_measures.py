"""Measures of the sources stay within limits that may only fall."""

from pathlib import Path

import pytest

from code_measures import LIMITS, Source, circles, excess, imports, limits, measures, names, sources, tightened, words

CODE = '''
"""A module."""
from dalembert.b import first
from dalembert import c

class Own:
    def method(self, given=1):
        self.value = given  # why
        return [one for one in (1, 2)]

@inlined("f")
def _compiled(x):
    def inner(y): return y
    return inner(x)

def _once(a): return 1 if a and (a or 2) else _compiled(a)

def public():
    # a loop
    # of steps
    return _once(_once(1))  # fmt: skip
'''


@pytest.fixture(scope="module")
def results():
    return measures(sources())


@pytest.mark.parametrize("name", limits())
def test_a_measure_is_within_its_limit_and_the_limit_no_slacker_than_its_margin(results, name):
    limit = limits()[name]
    reserve = -excess(results[name].value, limit)
    assert reserve >= 0, "\n".join(results[name].cases)
    assert reserve <= limit["margin"], "lower the limit: python tools/code_measures.py --lower"


def source(path, text):
    return Source(Path(path), text)


def test_measures_of_a_small_package():
    files = [
        source("kernels/a.py", CODE),
        source("kernels/deep/a.py", "import dalembert.kernels.a\n"),
        source("b.py", "def first():\n    import dalembert.c\n"),
        source("c.py", "x = 1\n" * 401),
    ]
    values = {name: item.value for name, item in measures(files).items()}
    lines = CODE.count("\n")
    assert values == {
        "lines": lines + 1 + 2 + 401,
        "long_functions": 0,
        "complex_functions": 0,
        "long_files": 1,
        "median_lines": (lines + 2) / 2,
        "modules_in_circles": 0,
        "called_once_percent": 50.0,
        "vague_names_percent": 20.0,
        "files_of_shared_names": 2,
        "comments_per_1000_lines": round(1000 * 3 / 14, 2),
    }


def test_a_function_counts_as_long_and_complex_outside_kernels_alone():
    body = "def f(x):\n" + "    if x: pass\n" * 81
    files = [source("a.py", body), source("b.py", "@inlined\n" + body)]
    results = measures([*files, source("kernels/c.py", "x = 1\n"), source("d.py", "def _a(): pass\n")])
    assert results["long_functions"].cases == ["a.py:1: f has 82 lines"]
    assert results["complex_functions"].cases == ["a.py:1: f has complexity 82"]


def test_imports_when_a_module_is_loaded_are_counted_and_others_are_not():
    text = (
        "from typing import TYPE_CHECKING\nfrom dalembert.p import q, name\nimport numpy\n"
        "if TYPE_CHECKING:\n    import dalembert.typed\ntry:\n    import dalembert.tried\nexcept ImportError:\n    pass\n"
        "def f():\n    import dalembert.late\n"
    )
    modules = {f"dalembert.{name}" for name in ("p", "p.q", "typed", "tried", "late", "a")}
    assert imports(source("a.py", text), modules) == {"dalembert.p", "dalembert.p.q", "dalembert.tried"}
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}) == [["a", "b", "c"]]


def test_names_are_those_that_a_scope_defines():
    tree = source("a.py", CODE).tree
    defined = [name for _, name in names(tree)]
    assert sorted(defined) == sorted(
        ["Own", "_compiled", "_once", "public", "method", "self", "given", "value", "one", "x", "inner", "y", "a"]
    )  # fmt: skip
    assert words("_ownValue_XMLGiven") == ["own", "value", "xml", "given"]


def test_limits_are_lowered_and_never_raised():
    text = "[code_measures]\na = { most = 10, margin = 2 }\nb = { least = 5, margin = 1 }\n"
    assert tightened(text, {"a": 8, "b": 7.5}) == text.replace("10", "8").replace("5", "7.5", 1)
    assert tightened(text, {"a": 12, "b": 4}) == text
    assert LIMITS.is_file()
