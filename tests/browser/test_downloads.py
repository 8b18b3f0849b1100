"""Figures and tables of a report, saved from a real browser: from a file, and from the frame that the studio shows."""

import csv
import re
import time
import xml.etree.ElementTree as ElementTree
from html import escape
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from browser.chromium import Chromium, Tab
from dalembert.report import figures, report
from dalembert.report.look import DARK, LIGHT
from stand_ins import fit, motion

pytestmark = pytest.mark.slow
PATIENCE = 120.0
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return report(fit(), tmp_path_factory.mktemp("page") / "fit.html", title="Pendulum", trajectory=motion())


@pytest.fixture
def folder(chromium: Chromium, tmp_path: Path) -> Path:
    """Where the browser saves."""
    chromium.send("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    return tmp_path


def _saved(path: Path) -> bytes:
    """Content of a file once it is there."""
    end = time.monotonic() + PATIENCE
    while not path.exists():
        assert time.monotonic() < end, (
            f"{path.name} was never saved; there is {[one.name for one in path.parent.iterdir()]}"
        )
        time.sleep(0.05)
    return path.read_bytes()


def _button(name: str, kind: str) -> str:
    return f"[...document.querySelectorAll('[data-figure=figure-{name}]')].find((one) => one.textContent === '{kind}')"


def _size(png: bytes) -> tuple[int, int]:
    """Width and height of a PNG, after its signature and the head of its first chunk."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    return int.from_bytes(png[16:20]), int.from_bytes(png[20:24])


def _lines(svg: bytes) -> list[str]:
    return [
        line.get("d", "") for line in ElementTree.fromstring(svg).iter(f"{SVG}path") if line.get("class") == "js-line"
    ]


def _numbers(line: str) -> list[float]:
    return [float(number) for number in re.findall(r"-?[\d.]+", line)]


def test_every_figure_is_saved_as_svg_and_as_png(chromium, path, folder):
    names = list(figures(fit(), trajectory=motion()))
    assert 4 < len(names) <= 10
    for kind in ("SVG", "PNG"):  # one page each: Chromium drops downloads of a page beyond ten per second
        tab = chromium.open(path)
        for name in names:
            tab.click(_button(name, kind))
            _saved(folder / f"{name}.{kind.lower()}")
        assert tab.complaints == []
        assert tab.requests == [path.as_uri()]
    for name in names:
        root = ElementTree.fromstring(_saved(folder / f"{name}.svg"))
        assert root.tag == f"{SVG}svg"
        assert any(text.text for text in root.iter(f"{SVG}text"))
        width, height = _size(_saved(folder / f"{name}.png"))
        assert width >= 1999
        assert height / width == pytest.approx(float(root.get("height", "0")) / float(root.get("width", "1")), rel=0.01)


@pytest.mark.parametrize(("scheme", "palette"), [("light", LIGHT), ("dark", DARK)])
def test_a_picture_looks_as_the_figure_does(chromium, path, folder, scheme, palette):
    tab = chromium.open(path, scheme=scheme)
    tab.run("document.querySelector('.player input').value = 25")
    tab.run("document.querySelector('.player input').dispatchEvent(new Event('input'))")
    tab.until("document.querySelector('.player output').textContent === 't = 1.02 s'")
    shown = "[...document.querySelectorAll('#figure-mechanism .scatterlayer .js-line')].at(-1).getAttribute('d')"
    tab.until(f"({shown}) !== null")
    tab.click(_button("mechanism", "SVG"))
    svg = _saved(folder / "mechanism.svg")
    found = [_numbers(line) for line in _lines(svg) if len(_numbers(line)) == 4]
    wanted = _numbers(tab.run(shown))
    assert any(np.allclose(line, wanted, atol=1.0) for line in found)  # equal axes fit anew, to part of a pixel
    ground = next(ElementTree.fromstring(svg).iter(f"{SVG}rect")).get("style", "").replace(" ", "")
    assert f"fill:{_colour(palette.surface)}" in ground


def _colour(hexadecimal: str) -> str:
    return f"rgb({','.join(str(int(hexadecimal[place : place + 2], 16)) for place in (1, 3, 5))})"


def test_a_figure_in_space_is_saved(chromium, folder):
    shape = SimpleNamespace(
        frequency=10.0,
        places=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        faces=np.array([[0, 1, 2, 3]]),
        contacts=(),
        contact_places=np.zeros((0, 3)),
        states=np.zeros((0, 64), dtype=np.uint8),
        energies=np.zeros(0),
        motion=lambda phases: np.cos(phases)[:, None, None] * np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 1]]),
    )
    tab = chromium.open(report(shape, folder / "shape.html"))
    for kind in ("SVG", "PNG"):
        tab.click(_button("deformation", kind))
    root = ElementTree.fromstring(_saved(folder / "deformation.svg"))
    pictures = [image.get("{http://www.w3.org/1999/xlink}href", "") for image in root.iter(f"{SVG}image")]
    assert any(picture.startswith("data:image/png") for picture in pictures)
    assert _size(_saved(folder / "deformation.png"))[0] >= 1999


def test_the_keyboard_saves_from_within_the_frame_of_the_studio(chromium, path, folder):
    """The frame gives the page no origin, and leave for no more than scripts and downloads."""
    page = folder / "frame.html"
    source = f'src="{escape(path.as_uri())}" width="1190" height="880"'
    page.write_text(f'<iframe sandbox="allow-scripts allow-downloads" {source}></iframe>')
    tab = chromium.tab()
    tab.send("Page.navigate", url=page.as_uri())
    frame = _frame(chromium)
    frame.until("document.documentElement?.dataset.ready === 'yes'")
    assert frame.run("origin") == "null"
    for kind in ("SVG", "PNG"):
        _press_tab_to(tab, frame, _button("responses-1", kind))
        tab.press("Enter")
    assert len(_lines(_saved(folder / "responses-1.svg"))) >= 2
    assert _size(_saved(folder / "responses-1.png"))[0] >= 1999
    assert tab.complaints == []


def _frame(chromium: Chromium) -> Tab:
    """The page in a frame, which is a process of its own."""
    end = time.monotonic() + PATIENCE
    while True:
        targets = chromium.send("Target.getTargets")["targetInfos"]
        frames = [target for target in targets if target["type"] == "iframe"]
        if frames:
            break
        assert time.monotonic() < end, f"there is no frame among {targets}"
        time.sleep(0.05)
    session = chromium.send("Target.attachToTarget", targetId=frames[-1]["targetId"], flatten=True)["sessionId"]
    return Tab(chromium, session)


def _press_tab_to(tab: Tab, frame: Tab, script: str) -> None:
    """Press Tab until the focus comes to an element in a frame."""
    for _ in range(80):
        tab.move_focus(inside=frame)
        if frame.run(f"document.activeElement === {script}"):
            return
    raise AssertionError(f"Tab never came to {script}")


def test_tables_are_saved_as_csv(chromium, path, folder):
    tab = chromium.open(path)
    tab.click("document.querySelector('a[download=\"parameters.csv\"]')")
    rows = list(csv.reader(_saved(folder / "parameters.csv").decode().splitlines()))
    assert [row[0] for row in rows[1:]] == ["theta1", "theta2"]
    assert tab.complaints == []
