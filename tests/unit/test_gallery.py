"""The gallery of studies in the documentation."""

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
import study_gallery

ROOT = Path(__file__).parents[2]
STUDIES = ROOT / "studies"


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    target = tmp_path_factory.mktemp("gallery")
    study_gallery.write(target, [STUDIES / name for name in ("duffing", "flexible-pendulum-moduli", "heavy-top")])
    return target


def test_each_study_has_a_page_with_its_picture_and_its_files(written):
    page = (written / "duffing.gallery").read_text()
    assert page.startswith("# Duffing oscillator: past the folds\n\n![Drawing of the model](pictures/duffing.svg)\n")
    assert re.findall(r"<code>([\w.-]+)</code>", page) == [
        "backbone.toml", "branches.toml", "fold.toml", "levels.toml", "model.toml", "track.toml"
    ]  # fmt: skip
    assert (STUDIES / "duffing" / "fold.toml").read_text().strip() in page
    for picture in written.glob("pictures/*.svg"):
        assert ET.fromstring(picture.read_text()).get("aria-label").startswith("Drawing of the model")
    assert len(list(written.glob("pictures/*.svg"))) == 3


def test_links_between_studies_lead_to_their_pages(written):
    page = (written / "flexible-pendulum-moduli.gallery").read_text()
    assert "](flexible-pendulum.gallery)" in page
    assert "README.md" not in page


def test_pages_of_former_builds_are_removed(written):
    (written / "gone.gallery").write_text("# Gone\n")
    study_gallery.write(written, [STUDIES / "duffing"])
    assert [page.name for page in written.glob("*.gallery")] == ["duffing.gallery"]


@pytest.mark.slow
def test_the_gallery_has_all_studies_in_groups():
    page = study_gallery.with_pictures((ROOT / "docs" / "gallery" / "index.md").read_text())
    assert all(f"## {group}\n" in page for group in study_gallery.GROUPS)
    assert sorted(re.findall(r":target: ([\w-]+)\.html", page)) == sorted(
        readme.parent.name for readme in STUDIES.glob("*/README.md")
    )


def test_the_first_page_has_pictures_of_studies_that_there_are():
    found = study_gallery.COMMENT.search((ROOT / "docs" / "index.md").read_text())
    assert len(found[1].split()) == 6
    assert all((STUDIES / name / "README.md").is_file() for name in found[1].split())
