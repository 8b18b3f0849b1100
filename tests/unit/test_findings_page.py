"""The page of findings lists every code of the sources, with its severities."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SEVERITIES = {"note", "warning", "error"}
ROW = re.compile(r"^\| `([a-z-]+)` \| ([a-z, ]+) \|", re.MULTILINE)


def made(text: str) -> Iterator[tuple[str, set[str]]]:
    """Codes of the findings that a source makes, and their severities.

    A finding that is read from a file or hands on the code of another one makes no new code.
    """
    for call in ast.walk(ast.parse(text)):
        if not (isinstance(call, ast.Call) and ast.unparse(call.func).split(".")[-1] == "Finding"):
            continue
        if any(keyword.arg is None for keyword in call.keywords):
            continue
        given = dict(zip(("code", "severity"), call.args, strict=False))
        given |= {keyword.arg: keyword.value for keyword in call.keywords}
        code, severity = given["code"], given["severity"]
        if isinstance(code, ast.Attribute) and code.attr == "code":
            continue
        branches = (severity.body, severity.orelse) if isinstance(severity, ast.IfExp) else (severity,)
        words = {ast.literal_eval(branch) for branch in branches}
        assert words <= SEVERITIES
        yield ast.literal_eval(code), words


def findings_of_sources() -> dict[str, set[str]]:
    codes = defaultdict(set)
    for path in sorted((ROOT / "src").rglob("*.py")):
        for code, words in made(path.read_text(encoding="utf-8")):
            codes[code] |= words
    return codes


def differences(page: str, codes: Mapping[str, set[str]]) -> dict[str, tuple[set[str], set[str]]]:
    """Severities of the page and of the sources, for each code for which they differ."""
    rows = ROW.findall(page)
    listed = {code: set(words.split(", ")) for code, words in rows}
    assert len(listed) == len(rows), "a code is listed twice"
    pairs = {code: (listed.get(code, set()), codes.get(code, set())) for code in {*listed, *codes}}
    return {code: pair for code, pair in pairs.items() if pair[0] != pair[1]}


def test_the_page_lists_the_codes_and_severities_of_the_sources():
    page = (ROOT / "docs" / "how-to" / "findings.md").read_text(encoding="utf-8")
    assert differences(page, findings_of_sources()) == {}


def test_a_code_is_missing_too_many_or_of_another_severity():
    page = "| `kept` | note, warning | a | b |\n| `gone` | note | a | b |\n| `worse` | note | a | b |\n"
    codes = {"kept": {"note", "warning"}, "new": {"error"}, "worse": {"error"}}
    assert differences(page, codes) == {
        "gone": ({"note"}, set()), "new": (set(), {"error"}), "worse": ({"note"}, {"error"}),
    }  # fmt: skip


@pytest.mark.parametrize(
    "source",
    ["Finding('a', 'note' if x else 'error', {}, '')", "f.Finding(code='a', severity='note')\nFinding('a', 'error')"],
    ids=["either", "keywords"],
)
def test_sources_make_codes(source):
    codes = list(made(source))
    assert {code for code, _ in codes} == {"a"}
    assert set.union(*(words for _, words in codes)) == {"note", "error"}


@pytest.mark.parametrize("source", ["Finding(**stored)", "Finding(seen.code, seen.severity, {}, '')"])
def test_findings_that_are_handed_on_make_none(source):
    assert list(made(source)) == []


@pytest.mark.parametrize("source", ["Finding(name, 'note', {}, '')", "Finding('a', severity, {}, '')"])
def test_a_code_or_severity_that_cannot_be_read_is_refused(source):
    with pytest.raises(ValueError, match="malformed"):
        list(made(source))


def keys_of_sources() -> dict[str, set[str]]:
    """Keys of the values of findings whose code and values are literals, by code."""
    found = defaultdict(set)
    for path in sorted((ROOT / "src").rglob("*.py")):
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not (isinstance(call, ast.Call) and ast.unparse(call.func) == "Finding" and len(call.args) > 2):
                continue
            code, _, values = call.args[:3]
            if isinstance(code, ast.Constant) and isinstance(values, ast.Dict):
                found[code.value] |= {key.value for key in values.keys if isinstance(key, ast.Constant)}
    return {code: keys for code, keys in found.items() if keys}


def test_the_page_lists_the_keys_of_the_values():
    page = (ROOT / "docs" / "how-to" / "findings.md").read_text(encoding="utf-8")
    rows = [row.split("|")[1:3] for row in page.partition("\n## Keys of `values`\n")[2].splitlines() if "| `" in row]
    listed = {
        code: set(re.findall("`([^`]+)`", keys)) for codes, keys in rows for code in re.findall("`([^`]+)`", codes)
    }
    known = keys_of_sources()
    assert len(known) > 40
    assert {
        code: keys - listed.get(code, set()) for code, keys in known.items() if keys - listed.get(code, set())
    } == {}
    assert set(listed) <= set(findings_of_sources())
