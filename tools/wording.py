"""Phrases that the glossary replaces, in pages, messages, docstrings and names: ``python tools/wording.py``.

``docs/glossary.md`` is the list: the last column of its tables has the phrases, the first one the term to use. Pages
must not contain them. ``tools/limits.toml`` has how many messages, docstrings and names may still contain.
"""

import ast
import re
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from code_measures import names, words

ROOT = Path(__file__).parents[1]
GLOSSARY = ROOT / "docs" / "glossary.md"
ROW = re.compile(r"^\| ([^|]+) \| [^|]+ \| ([^|]+) \|$", re.MULTILINE)
NO_PROSE = re.compile(r"^(```|:::).*?^\1|`[^`\n]*`|\$\$.*?\$\$|\$[^$\n]*\$|(?<=\])\([^)]*\)", re.MULTILINE | re.DOTALL)
"""Code, equations and targets of links."""
NO_DOCUMENTATION = re.compile(r"``[^`]*``|`[^`]*`|^\s*(?:>>>|\.\.\.) .*$", re.MULTILINE)
"""Code and examples in docstrings."""
LIMITS = ROOT / "tools" / "limits.toml"


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


@cache
def pattern(listed: tuple[str, ...]) -> re.Pattern[str]:
    """Any of the phrases, as whole words, over ends of lines."""
    longest_first = sorted(listed, key=len, reverse=True)
    spaced = (re.escape(phrase).replace(r"\ ", r"\s+") for phrase in longest_first)
    return re.compile(rf"\b(?:{'|'.join(spaced)})\b", re.IGNORECASE)


def uses(text: str, known: dict[str, str]) -> Iterator[Use]:
    """Phrases in a text.

    >>> list(uses("The data\\ntell it.", {"data tell": "identifiable"}))
    [Use(line=1, phrase='data tell', term='identifiable')]
    """
    for match in pattern(tuple(known)).finditer(text):
        phrase = " ".join(match[0].lower().split())
        yield Use(text.count("\n", 0, match.start()) + 1, phrase, known[phrase])


def prose(page: str, code: re.Pattern[str] = NO_PROSE) -> str:
    """A page in Markdown with blanks in place of code, equations and targets of links."""
    return code.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), page)


def messages_and_docstrings(tree: ast.Module) -> tuple[list[tuple[int, str]], list[tuple[int, str]]]:
    """Line and text of each string that is no docstring, and of each docstring without its code.

    >>> messages_and_docstrings(ast.parse('"Of `x`."' + chr(10) + "raise ValueError('A message.')"))
    ([(2, 'A message.')], [(1, 'Of    .')])
    """
    nodes = list(ast.walk(tree))
    statements = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    messages, docstrings = [], []
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            if id(node) in statements:
                docstrings.append((node.lineno, prose(node.value, NO_DOCUMENTATION)))
            else:
                messages.append((node.lineno, node.value))
    return messages, docstrings


def in_pages(known: dict[str, str], root: Path = ROOT) -> dict[Path, list[Use]]:
    """Phrases in the README, in the guide for contributors and in the pages of docs, by file."""
    pages = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
    pages = [page for page in pages if page != GLOSSARY and "_build" not in page.parts]
    return {page: list(uses(prose(page.read_text(encoding="utf-8")), known)) for page in pages}


def in_sources(known: dict[str, str], root: Path = ROOT) -> dict[str, dict[Path, list[Use]]]:
    """Phrases in the messages, the docstrings and the names of the package, by file."""
    phrases_in: dict[str, dict[Path, list[Use]]] = {"messages": {}, "docstrings": {}, "names": {}}
    for file in sorted((root / "src").rglob("*.py")):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        messages, docstrings = messages_and_docstrings(tree)
        named = [(line, " ".join(words(name))) for line, name in names(tree)]
        for part, texts in (("messages", messages), ("docstrings", docstrings), ("names", named)):
            phrases_in[part][file] = [
                use._replace(line=line + use.line - 1) for line, text in texts for use in uses(text, known)
            ]
    return phrases_in


def limits() -> dict[str, int]:
    """How many phrases messages, docstrings and names may contain."""
    return tomllib.loads(LIMITS.read_text(encoding="utf-8"))["wording"]


def main() -> int:
    known = phrases(GLOSSARY.read_text(encoding="utf-8"))
    parts = {"pages": in_pages(known), **in_sources(known)}
    allowed = {"pages": 0, **limits()}
    exceeded = False
    for part, by_file in parts.items():
        total = sum(map(len, by_file.values()))
        exceeded |= total > allowed[part]
        for file, listed in by_file.items():
            for line, phrase, term in listed:
                print(f"{file.relative_to(ROOT)}:{line}: '{phrase}' in {part}: use '{term}'")
        print(f"{part}: {total} phrases to replace; allowed: {allowed[part]}")
    return int(exceeded)


if __name__ == "__main__":
    sys.exit(main())
