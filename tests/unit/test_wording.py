"""Pages use the terms of the glossary; messages come closer to them."""

from collections import Counter
from pathlib import Path

import pytest

from wording import GLOSSARY, ROOT, in_messages, in_pages, phrases

MOST = Counter()
"""Phrases that messages still contain, by package or module. Numbers may only fall: lower them with the phrases."""


@pytest.fixture(scope="module")
def known() -> dict[str, str]:
    return phrases(GLOSSARY.read_text(encoding="utf-8"))


def test_the_glossary_has_one_row_a_term_and_replaces_no_term(known):
    rows = [line.split("|")[1].strip() for line in GLOSSARY.read_text().splitlines() if line.startswith("|")]
    terms = [row for row in rows if row not in ("term", "use") and not row.startswith("-")]
    assert len(terms) > 40
    assert len(set(terms)) == len(terms)
    assert not set(terms) & set(known)


def test_pages_use_the_terms_of_the_glossary(known):
    found = in_pages(known)
    assert len(found) > 40
    assert {page: uses for page, uses in found.items() if uses} == {}


def test_messages_contain_no_more_phrases_than_before(known):
    found = Counter()
    for file, uses in in_messages(known).items():
        found[file.relative_to(ROOT / "src" / "dalembert").parts[0]] += len(uses)
    assert found - MOST == Counter()


def test_a_phrase_is_found_in_pages_and_messages_and_not_in_code_or_docstrings(tmp_path: Path):
    for folder in ("docs", "src"):
        (tmp_path / folder).mkdir()
    (tmp_path / "README.md").write_text("The data\ntell `so many` things.\n```\nso many\n```\nSo  many.\n")
    (tmp_path / "CONTRIBUTING.md").write_text("Somany [so](so many)\n")
    (tmp_path / "src" / "a.py").write_text('"""So many."""\n\nLABEL = f"It has so many {1}."\n# so many\n')
    known = {"so many": "a number", "data tell": "identifiable"}
    pages, messages = in_pages(known, tmp_path), in_messages(known, tmp_path)
    assert [tuple(use) for use in pages[tmp_path / "README.md"]] == [
        (1, "data tell", "identifiable"),
        (6, "so many", "a number"),
    ]
    assert pages[tmp_path / "CONTRIBUTING.md"] == []
    assert [tuple(use) for use in messages[tmp_path / "src" / "a.py"]] == [(3, "so many", "a number")]
