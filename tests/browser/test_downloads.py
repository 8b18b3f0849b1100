"""Figures and tables of a report, saved from a real browser: from a file, and from the frame that the studio shows."""

import csv
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from functools import partial
from html import escape

import numpy as np
import pytest
from playwright.sync_api import Frame, Locator, Page

from browser.visitor import move_focus, wait_for_figures, wait_until
from dalembert.report import figures, report
from dalembert.report.look import DARK, LIGHT
from dalembert.vibration import Deformation
from stand_ins import fit, motion, stand_in

pytestmark = pytest.mark.slow
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return report(fit(), tmp_path_factory.mktemp("page") / "fit.html", motion(), title="Pendulum")


def _saved(page: Page, act: Callable[[], None], name: str) -> bytes:
    """Content of the file that an action saves by a name."""
    with page.expect_download() as download:
        act()
    assert download.value.suggested_filename == name
    return download.value.path().read_bytes()


def _button(page: Page | Frame, name: str, kind: str) -> Locator:
    return page.locator(f"[data-figure=figure-{name}]", has_text=kind)


def _size(png: bytes) -> tuple[int, int]:
    """Width and height of a PNG, after its signature and the head of its first chunk."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    return int.from_bytes(png[16:20]), int.from_bytes(png[20:24])


def _lines(svg: bytes) -> list[str]:
    return [
        line.get("d", "") for line in ElementTree.fromstring(svg).iter(f"{SVG}path") if line.get("class") == "js-line"
    ]


def test_every_figure_is_saved_as_svg_and_as_png(chromium, path):
    names = list(figures(fit(), motion()))
    assert 4 < len(names) <= 10
    saved: dict[str, bytes] = {}
    for kind in ("SVG", "PNG"):  # one page each: Chromium drops downloads of a page beyond ten per second
        page = chromium.open(path)
        for name in names:
            file = f"{name}.{kind.lower()}"
            saved[file] = _saved(page, _button(page, name, kind).click, file)
    assert chromium.complaints == []
    assert chromium.requests == 2 * [path.as_uri()]
    for name in names:
        root = ElementTree.fromstring(saved[f"{name}.svg"])
        assert root.tag == f"{SVG}svg"
        assert any(text.text for text in root.iter(f"{SVG}text"))
        width, height = _size(saved[f"{name}.png"])
        assert width >= 1999
        assert height / width == pytest.approx(float(root.get("height", "0")) / float(root.get("width", "1")), rel=0.01)


@pytest.mark.parametrize(("scheme", "palette"), [("light", LIGHT), ("dark", DARK)])
def test_a_picture_looks_as_the_figure_does(chromium, path, scheme, palette):
    page = chromium.open(path, scheme=scheme)
    page.evaluate("document.querySelector('.player input').value = 25")
    page.evaluate("document.querySelector('.player input').dispatchEvent(new Event('input'))")
    wait_until(page, "document.querySelector('.player output').textContent === 't = 1.02 s'")
    shown = "[...document.querySelectorAll('#figure-mechanism .player-body')].at(-1).getAttribute('d')"
    svg = _saved(page, _button(page, "mechanism", "SVG").click, "mechanism.svg")
    assert page.evaluate(shown) in [line.get("d") for line in ElementTree.fromstring(svg).iter(f"{SVG}path")]
    assert next(ElementTree.fromstring(svg).iter(f"{SVG}rect")).get("fill") == palette.surface


def test_a_film_in_space_is_saved_as_it_is_seen(chromium, tmp_path):
    from spatial_pendulum import motion as in_space

    page = chromium.open(report(in_space(), tmp_path / "space.html"))
    wait_until(page, "document.querySelector('#figure-mechanism span')?.style.transform")
    svg = ElementTree.fromstring(_saved(page, _button(page, "mechanism", "SVG").click, "mechanism.svg"))
    assert next(svg.iter(f"{SVG}image")).get("href", "").startswith("data:image/png")
    assert {"one", "two", "x", "y", "z"} <= {text.text for text in svg.iter(f"{SVG}text")}


def test_a_figure_in_space_is_saved(chromium, tmp_path):
    shape = stand_in(
        Deformation,
        frequency=10.0,
        places=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        faces=np.array([[0, 1, 2, 3]]),
        contacts=(),
        contact_places=np.zeros((0, 3)),
        states=np.zeros((0, 64), dtype=np.uint8),
        energies=np.zeros(0),
        motion=lambda phases: np.cos(phases)[:, None, None] * np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 1]]),
    )
    page = chromium.open(report(shape, tmp_path / "shape.html"))
    svg, png = (
        _saved(page, _button(page, "deformation", kind).click, f"deformation.{kind.lower()}") for kind in ("SVG", "PNG")
    )
    root = ElementTree.fromstring(svg)
    assert next(root.iter(f"{SVG}image")).get("href", "").startswith("data:image/png")
    words = {text.text for text in root.iter(f"{SVG}text")}
    assert {"largest displacement (m)", "0", "2"} <= words  # the bar of the colours
    assert _size(png)[0] >= 1999


def test_the_keyboard_saves_from_within_the_frame_of_the_studio(chromium, path, tmp_path):
    """The frame gives the page no origin, and leave for no more than scripts and downloads."""
    outer = tmp_path / "frame.html"
    source = f'src="{escape(path.as_uri())}" width="1190" height="880"'
    outer.write_text(f'<iframe sandbox="allow-scripts allow-downloads" {source}></iframe>')
    page = chromium.page()
    page.goto(outer.as_uri())
    frame = page.frames[-1]
    wait_for_figures(frame)
    assert frame.evaluate("origin") == "null"
    for kind, saved in (("SVG", _lines), ("PNG", _size)):
        _press_tab_to(page, frame, _button(frame, "responses-1", kind))
        press = partial(page.keyboard.press, "Enter")
        assert saved(_saved(page, press, f"responses-1.{kind.lower()}"))
    assert chromium.complaints == []


def _press_tab_to(page: Page, frame: Frame, control: Locator) -> None:
    """Press Tab until the focus comes to an element in a frame."""
    for _ in range(80):
        move_focus(page, inside=frame)
        if control.evaluate("(one) => one === document.activeElement"):
            return
    raise AssertionError(f"Tab does not reach {control}")


def test_tables_are_saved_as_csv(chromium, path):
    page = chromium.open(path)
    saved = _saved(page, page.locator('a[download="parameters.csv"]').click, "parameters.csv")
    rows = list(csv.reader(saved.decode().splitlines()))
    assert [row[0] for row in rows[1:]] == ["theta1", "theta2"]
    assert chromium.complaints == []
