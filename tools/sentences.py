"""Sentences over 20 words in the pages of the documentation: ``python tools/sentences.py [PAGE ...]``.

Code and a formula count as one word, the target of a link as none. Items of lists and cells of tables are
sentences if they end as one or are long.
"""

import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
MOST_WORDS = 20
BLOCK = re.compile(r"^( *)(```|:::).*?^\1\2", re.MULTILINE | re.DOTALL)
TITLE = re.compile(r"^\(\S+\)=$", re.MULTILINE)
DISPLAYED = re.compile(r"\$\$.*?\$\$", re.DOTALL)
ONE_WORD = re.compile(r"(\{[\w:]+\})?`[^`]*`|\$[^$\n]*\$")
TARGET = re.compile(r"(?<=\])\([^)]*\)")
START = re.compile(r"^\s*([-*+] |\d+\. |#+ |: |\||$)")
END = re.compile(r"(?<=[.!?])[)\"”'*]*\s+")
STOP = re.compile(r"[.!?][)\"”'*]*\s*$")
WORD = re.compile(r"\w")


class Sentence(NamedTuple):
    """A sentence: the line where its paragraph begins, its words, its text."""

    line: int
    words: int
    text: str


def sentences(page: str) -> Iterator[Sentence]:
    """Return the sentences of a page in Markdown.

    >>> [words for _, words, _ in sentences("# Title\\n\\nOne `two three` four\\nfive. Six [seven](eight)!\\n- Nine.")]
    [4, 2, 1]
    """
    for line, paragraph in _paragraphs(page):
        for text in END.split(paragraph):
            words = sum(bool(WORD.search(word)) for word in _shortened(text).split())
            if words > MOST_WORDS or STOP.search(text):
                yield Sentence(line, words, text.strip())


def _paragraphs(page: str) -> Iterator[tuple[int, str]]:
    """Return first line and text of each paragraph, item, heading and cell, without blocks of code."""
    for pattern in (BLOCK, DISPLAYED, TITLE):
        page = pattern.sub(lambda match: "\n" * match[0].count("\n"), page)
    first, lines = 1, []
    for number, line in enumerate([*page.splitlines(), ""], 1):
        if START.match(line) and lines:
            yield first, " ".join(lines)
            lines = []
        if line.lstrip().startswith("|"):
            yield from ((number, cell) for cell in re.split(r"(?<!\\)\|", line))
        elif line.strip():
            first = first if lines else number
            lines.append(re.sub(r"^\s*([-*+:]|\d+\.|#+) ", "", line).strip())


def _shortened(text: str) -> str:
    return TARGET.sub("", ONE_WORD.sub("x", text))


def pages(root: Path = ROOT) -> dict[str, list[Path]]:
    """Return the pages of each folder of the documentation, and those beside the README."""
    files = sorted(page for page in (root / "docs").rglob("*.md") if "_build" not in page.parts)
    folders: dict[str, list[Path]] = {".": sorted(root.glob("*.md"))}
    for page in files:
        folders.setdefault(str(page.parent.relative_to(root)), []).append(page)
    return folders


def long_share(files: list[Path]) -> float:
    """Return the share of the sentences of pages that have more than 20 words."""
    counts = Counter(
        sentence.words > MOST_WORDS for file in files for sentence in sentences(file.read_text(encoding="utf-8"))
    )
    return counts[True] / max(1, counts.total())


def main(arguments: list[str]) -> None:
    for argument in arguments:
        for line, words, text in sentences(Path(argument).read_text(encoding="utf-8")):
            if words > MOST_WORDS:
                print(f"{argument}:{line}: {words} words: {text}")
    for folder, files in pages().items():
        print(f"{folder}: {100 * long_share(files):.1f} % of the sentences have more than {MOST_WORDS} words")


if __name__ == "__main__":
    main(sys.argv[1:])
