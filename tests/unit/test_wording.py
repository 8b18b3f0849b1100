"""Pages use the terms of the glossary; messages, docstrings and names come closer to them."""

from pathlib import Path

import pytest

from wording import GLOSSARY, in_pages, in_sources, limits, phrases


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


def test_messages_docstrings_and_names_contain_no_more_phrases_than_allowed(known):
    numbers = {part: sum(map(len, by_file.values())) for part, by_file in in_sources(known).items()}
    allowed = limits()
    assert numbers.keys() == allowed.keys()
    assert {part: number for part, number in numbers.items() if number > allowed[part]} == {}, (
        "python tools/wording.py lists them"
    )


def test_a_phrase_is_found_in_pages_and_sources_and_not_in_code(tmp_path: Path):
    for folder in ("docs", "src"):
        (tmp_path / folder).mkdir()
    (tmp_path / "README.md").write_text("The data\ntell `so many` things.\n```\nso many\n```\nSo  many.\n")
    (tmp_path / "CONTRIBUTING.md").write_text("Somany [so](so many)\n")
    (tmp_path / "src" / "a.py").write_text(
        '"""So many, ``so many``.\n\n>>> so many\n"""\n\nLABEL = f"It has so many {1}."\nso_many = 1  # so many\n'
    )
    known = {"so many": "a number", "data tell": "identifiable"}
    pages, sources = in_pages(known, tmp_path), in_sources(known, tmp_path)
    assert [tuple(use) for use in pages[tmp_path / "README.md"]] == [
        (1, "data tell", "identifiable"),
        (6, "so many", "a number"),
    ]
    assert pages[tmp_path / "CONTRIBUTING.md"] == []
    lines = {
        part: [(use.line, use.phrase) for use in by_file[tmp_path / "src" / "a.py"]]
        for part, by_file in sources.items()
    }
    assert lines == {"messages": [(6, "so many")], "docstrings": [(1, "so many")], "names": [(7, "so many")]}
