"""Phrases that the glossary replaces, in pages and in messages: ``python tools/wording.py``.

``docs/glossary.md`` is the list: the last column of its tables has the phrases, the first one the term to use.
"""

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
GLOSSARY = ROOT / "docs" / "glossary.md"
ROW = re.compile(r"^\| ([^|]+) \| [^|]+ \| ([^|]+) \|$", re.MULTILINE)
NO_PROSE = re.compile(r"^(```|:::).*?^\1|`[^`\n]*`|\$\$.*?\$\$|\$[^$\n]*\$|(?<=\])\([^)]*\)", re.MULTILINE | re.DOTALL)
"""Code, equations and targets of links."""


class Use(NamedTuple):
    """A phrase to replace: its line, the phrase, the term of the glossary."""

    line: int
    phrase: str
    term: str


def phrases(glossary: str) -> dict[str, str]:
    """Term of each phrase of a glossary, the phrase in lower case.

    >>> phrases("| term | meaning | not |\\n|---|---|---|\\n| residual | a difference | rest, what is left |")
    {'rest': 'residual', 'what is left': 'residual'}
    """
    rows = [row for row in ROW.findall(glossary) if row[1] != "not" and set(row[1]) != {"-"}]
    return {phrase: term for term, cell in rows for phrase in cell.split(", ")}


def pattern(known: dict[str, str]) -> re.Pattern[str]:
    """Any of the phrases, as whole words, over ends of lines."""
    longest_first = sorted(known, key=len, reverse=True)
    spaced = (re.escape(one).replace(r"\ ", r"\s+") for one in longest_first)
    return re.compile(rf"\b(?:{'|'.join(spaced)})\b", re.IGNORECASE)


def uses(text: str, known: dict[str, str]) -> Iterator[Use]:
    """Phrases in a text.

    >>> list(uses("The data\\ntell it.", {"data tell": "identifiable"}))
    [Use(line=1, phrase='data tell', term='identifiable')]
    """
    for found in pattern(known).finditer(text):
        phrase = " ".join(found[0].lower().split())
        yield Use(text.count("\n", 0, found.start()) + 1, phrase, known[phrase])


def prose(page: str) -> str:
    """A page in Markdown with blanks in place of code, equations and targets of links."""
    return NO_PROSE.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), page)


def messages(source: str) -> Iterator[tuple[int, str]]:
    """Line and text of each string of Python code that is no docstring.

    >>> list(messages('"Docstring."' + chr(10) + "raise ValueError('A message.')"))
    [(2, 'A message.')]
    """
    tree = ast.parse(source)
    statements = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in statements:
            yield node.lineno, node.value


def in_pages(known: dict[str, str], root: Path = ROOT) -> dict[Path, list[Use]]:
    """Phrases in the README, in the guide for contributors and in the pages of docs, by file."""
    pages = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
    pages = [page for page in pages if page != GLOSSARY and "_build" not in page.parts]
    return {page: list(uses(prose(page.read_text(encoding="utf-8")), known)) for page in pages}


def in_messages(known: dict[str, str], root: Path = ROOT) -> dict[Path, list[Use]]:
    """Phrases in the messages of the package, by file."""
    files = sorted((root / "src").rglob("*.py"))
    return {
        file: [
            use._replace(line=line + use.line - 1)
            for line, text in messages(file.read_text(encoding="utf-8"))
            for use in uses(text, known)
        ]
        for file in files
    }


def main() -> int:
    known = phrases(GLOSSARY.read_text(encoding="utf-8"))
    by_file = in_pages(known) | in_messages(known)
    for file, found in by_file.items():
        for line, phrase, term in found:
            print(f"{file.relative_to(ROOT)}:{line}: '{phrase}': use '{term}'")
    return int(any(by_file.values()))


if __name__ == "__main__":
    sys.exit(main())
