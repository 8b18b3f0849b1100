"""Sentences of the pages become shorter."""

from pathlib import Path

import pytest

from sentences import long_share, pages, sentences

MOST = {
    ".": 0.16,
    "docs": 0.18,
    "docs/gallery": 0.0,
    "docs/how-to": 0.01,
    "docs/notebooks": 0.40,
    "docs/theory": 0.33,
    "docs/tutorials": 0.15,
    "docs/validation": 0.47,
}
"""Largest share of sentences of more than 20 words, by folder. Numbers may only fall: lower them with the sentences."""


def test_each_folder_of_pages_has_a_limit():
    assert set(pages()) == set(MOST)


@pytest.mark.parametrize("folder", MOST)
def test_no_folder_has_more_long_sentences_than_before(folder: str):
    assert long_share(pages()[folder]) <= MOST[folder]


def test_code_formulas_and_targets_of_links_are_not_counted():
    page = "```\nOne. Two.\n```\nSee [the page](a long target.md): `a = b + c` and $x + y$.\n\n$$ x = y. $$\n"
    assert [(line, words) for line, words, _ in sentences(page)] == [(4, 6)]


def test_items_and_cells_are_separate_sentences_and_short_labels_are_none():
    page = "# A title\n\n- First item\n  continues.\n- Second.\n\n| a label | A cell. Its second sentence. |\n\nterm\n: Its meaning."
    assert [words for _, words, _ in sentences(page)] == [3, 1, 2, 3, 2]


def test_a_long_item_without_a_full_stop_counts(tmp_path: Path):
    page = tmp_path / "page.md"
    page.write_text("- " + "word " * 21 + "\n\nShort. **Bold.** Short.\n")
    assert long_share([page]) == 0.25
