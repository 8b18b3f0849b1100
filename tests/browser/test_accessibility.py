"""No page of the studio, and no report, violates the Web Content Accessibility Guidelines 2.2, levels A and AA."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Page

from browser.running_studio import ALIVE, running_studio
from browser.studio_pages import PAGES, Shown, filled
from browser.visitor import wait_until

axe = pytest.importorskip("axe_playwright_python.sync_playwright")
RULES = {
    "runOnly": {"type": "tag", "values": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]},
    "resultTypes": ["violations"],
    "iframes": False,  # reports are pages of their own here
}
FILES = ("report", "comparison")
SIZES = ((640, 400), (768, 1024), (1024, 768))
"""CSS pixels: 200 % zoom of 1280 x 800, and a tablet in both positions."""
OUT_OF_SIGHT = """() => {
    const found = [...document.querySelectorAll('h1, [role=heading], a, button, label, input, [role=tab], [role=status]')];
    const scrolls = (one) => one.closest('.ag-root, .cm-editor, .q-tabs, .overflow-x-auto, svg, .model-space');
    const wide = found.filter((one) => one.getBoundingClientRect().right > innerWidth + 1 && !scrolls(one));
    return [document.documentElement.scrollWidth > innerWidth && 'the page', ...wide.map((one) => one.outerHTML)];
}"""
QUICK = ("new", "no-study")


@pytest.fixture(scope="module")
def address(tmp_path_factory) -> Iterator[str]:
    """A studio with a study of each kind and runs in each state."""
    with filled(tmp_path_factory.mktemp("workspace")) as root, running_studio(root) as found:
        yield found


@pytest.fixture(scope="module", params=["light", "dark"])
def page(request, browser) -> Iterator[Page]:
    """A page that all tests of a colour scheme use."""
    context = browser.new_context(
        viewport={"width": 1280, "height": 800}, color_scheme=request.param, reduced_motion="reduce"
    )
    yield context.new_page()
    context.close()


@pytest.fixture(scope="module")
def empty(tmp_path_factory) -> Iterator[str]:
    """A studio for an empty folder."""
    with running_studio(tmp_path_factory.mktemp("empty")) as found:
        yield found


def violations(page: Page, address: str, shown: Shown) -> list[str]:
    """What is wrong with a page, and where."""
    page.set_viewport_size({"width": 1280, "height": 800})
    page.goto(address + shown.path, wait_until="domcontentloaded")
    if shown.name not in FILES:
        wait_until(page, ALIVE)
    shown.show(page)
    page.wait_for_timeout(400)  # until colours and places have changed
    found = axe.Axe().run(page, options=RULES).response["violations"]
    return [
        f"{rule['id']} at {node['target']}: {node['html'][:200]}; "
        + " ".join(one["message"] for one in node["any"] + node["all"] + node["none"])
        for rule in found
        for node in rule["nodes"]
    ]


@pytest.mark.slow
@pytest.mark.parametrize("shown", PAGES, ids=lambda shown: shown.name)
def test_no_page_violates_the_guidelines_or_is_cut_off(page, address, shown):
    assert violations(page, address, shown) == []
    for width, height in SIZES if shown.name not in FILES else ():
        page.set_viewport_size({"width": width, "height": height})
        for _ in range(20):  # figures follow the window after a while
            page.wait_for_timeout(200)
            if not any(page.evaluate(OUT_OF_SIGHT)):
                break
        assert [one for one in page.evaluate(OUT_OF_SIGHT) if one] == [], width


@pytest.mark.parametrize("shown", [one for one in PAGES if one.name in QUICK], ids=lambda shown: shown.name)
def test_simple_pages_violate_no_guideline(page, empty, shown):
    assert violations(page, empty, shown) == []
