"""The report in a real browser: drawn, silent, dark where asked, and moving."""

import re

import numpy as np
import pytest

from browser.visitor import move_focus, wait_until
from dalembert.report import figures, report
from dalembert.report.look import DARK, LIGHT
from dalembert.vibration import Deformation
from stand_ins import band_fit, comparison, fit, motion, parameter_set, propagation, stand_in, sweep

pytestmark = pytest.mark.slow
NASTY = "<img src=x onerror=\"document.title='run'\">"
LAST_BODY = "[...document.querySelectorAll('#figure-mechanism .player-body')].at(-1).getAttribute('d')"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    result = fit(names=(NASTY, "theta2"), channels=("<b>AB</b>.x", "<b>AB</b>.y"))
    return report(result, tmp_path_factory.mktemp("page") / "fit.html", motion(), title="Pendulum")


def _colour(hexadecimal: str) -> str:
    return f"rgb({', '.join(str(int(hexadecimal[place : place + 2], 16)) for place in (1, 3, 5))})"


def test_every_figure_is_drawn_and_nothing_is_asked_for_or_refused(chromium, path):
    page = chromium.open(path)
    places = "[...document.querySelectorAll('.canvas[data-drawn], .dalembert-film[data-plays]')]"
    assert page.evaluate(f"{places}.map((place) => place.id)") == [
        f"figure-{name}" for name in figures(fit(), motion())
    ]
    assert chromium.requests == [path.as_uri()]
    assert chromium.complaints == []


def test_a_script_that_slipped_in_would_be_refused(chromium, path, tmp_path):
    copy = tmp_path / "slipped.html"
    copy.write_text(path.read_text().replace("</main>", "<script>document.title = 'run'</script></main>"))
    page = chromium.open(copy)
    assert page.evaluate("document.title") == "Pendulum"
    assert "Content Security Policy" in chromium.complaints[0]


def test_names_are_shown_and_never_run(chromium, path):
    page = chromium.open(path)
    assert page.evaluate("document.title") == "Pendulum"
    assert page.evaluate("document.images.length") == 0
    assert (
        page.evaluate("document.querySelector('#figure-responses-1 .legendtext').textContent") == "<b>AB</b>.x measured"
    )
    assert NASTY in page.evaluate(
        "[...document.querySelectorAll('#figure-parameters text')].map((text) => text.textContent)"
    )


@pytest.mark.parametrize(("scheme", "palette"), [("light", LIGHT), ("dark", DARK)])
def test_figures_follow_the_page_into_the_dark(chromium, path, scheme, palette):
    page = chromium.open(path, scheme=scheme)
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == _colour(palette.page)
    assert page.evaluate("document.querySelector('#figure-energies .main-svg').style.background") == _colour(
        palette.surface
    )
    line = "document.querySelector('#figure-energies .scatterlayer .js-line').style.stroke"
    assert page.evaluate(line) == _colour(palette.series[0])


def test_figures_change_with_the_system_and_are_light_in_print(chromium, path):
    page = chromium.open(path)
    ground = "document.querySelector('#figure-energies .main-svg').style.background"
    page.emulate_media(color_scheme="dark")
    wait_until(page, f"{ground} === '{_colour(DARK.surface)}'")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    wait_until(page, f"{ground} === '{_colour(LIGHT.surface)}'")


def test_play_moves_the_mechanism_to_its_end_in_real_time(chromium, path):
    page = chromium.open(path)
    before = page.evaluate(LAST_BODY)
    lasted = page.evaluate(
        """new Promise((done) => {
            const button = document.querySelector(".player button"), began = performance.now();
            button.click();
            const watch = setInterval(() => {
                if (button.getAttribute("aria-label") === "Pause") return;
                clearInterval(watch);
                done((performance.now() - began) / 1000);
            }, 10);
        })"""
    )
    assert 1.8 < lasted < 4.0
    assert page.evaluate("document.querySelector('.player output').textContent") == "t = 2.00 s"
    assert page.evaluate(LAST_BODY) != before


def test_a_film_begins_when_it_is_asked_for_and_follows_the_page_into_the_dark(chromium, path):
    page = chromium.open(path)
    page.wait_for_timeout(300)
    assert page.evaluate("document.querySelector('.player output').textContent") == "t = 0.00 s"
    stroke = "document.querySelector('#figure-mechanism .player-body').getAttribute('stroke')"
    assert page.evaluate(stroke) == LIGHT.series[0]
    page.emulate_media(color_scheme="dark")
    wait_until(page, f"{stroke} === '{DARK.series[0]}'")
    assert chromium.complaints == []


@pytest.mark.parametrize("printed", [True, False])
def test_the_picture_is_printed_and_the_player_is_seen(chromium, path, printed):
    page = chromium.open(path)
    page.emulate_media(media="print" if printed else "screen")
    assert page.locator(".film-still").is_visible() == printed
    assert page.locator("#figure-mechanism .player").is_visible() != printed


def test_the_player_obeys_the_keyboard(chromium, path):
    page = chromium.open(path)
    page.evaluate("document.querySelector('.player button').focus()")
    page.keyboard.press("Enter")
    wait_until(page, "document.querySelector('.player button').getAttribute('aria-label') === 'Pause'")
    page.keyboard.press("Enter")
    wait_until(page, "document.querySelector('.player button').getAttribute('aria-label') === 'Play'")
    page.keyboard.press("Tab")
    page.keyboard.press("Home")
    page.keyboard.press("ArrowRight")
    wait_until(page, "document.querySelector('.player input').getAttribute('aria-valuetext') === '0.04 seconds'")


def test_the_slider_shows_the_mechanism_at_its_time(chromium, path):
    page = chromium.open(path)
    page.evaluate(
        """(() => {
            const slider = document.querySelector(".player input");
            slider.value = 25;
            slider.dispatchEvent(new Event("input"));
        })()"""
    )
    scene = figures(fit(), motion())["mechanism"].scene
    joint, fixed = (next(one for one in scene.primitives if one.name == name).points for name in ("A", "O"))
    moved = [page.locator(f"#figure-mechanism [data-part={name}]").last.get_attribute("transform") for name in "AO"]
    pixels = np.array([re.findall(r"-?[\d.]+", one) for one in moved], dtype=float)
    right, down = pixels[0] - pixels[1]
    across, up = joint[25, 0] - fixed[0, 0]
    assert np.arctan2(-down, right) == pytest.approx(np.arctan2(up, across), abs=1e-3)
    assert page.evaluate("document.querySelector('.player output').textContent") == "t = 1.02 s"


def test_a_mechanism_in_space_moves_and_turns(chromium, tmp_path):
    from spatial_pendulum import motion as in_space

    path = report(in_space(), tmp_path / "space.html")
    page = chromium.open(path)
    page.evaluate(
        """(() => {
            const slider = document.querySelector(".player input");
            slider.value = 40;
            slider.dispatchEvent(new Event("input"));
        })()"""
    )
    label = "[...document.querySelectorAll('#figure-mechanism span')].find((one) => one.textContent === 'two')"
    seen = f"{label}?.style.transform"
    wait_until(page, seen)
    before = page.evaluate(seen)
    box = page.locator("#figure-mechanism canvas").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] / 2 + 90, box["y"] + box["height"] / 2 + 20, steps=4)
    page.mouse.up()
    wait_until(page, f"{seen} !== '{before}'")
    turned = page.evaluate(seen)
    page.locator(".player-scene").press("ArrowLeft")
    wait_until(page, f"{seen} !== '{turned}'")
    turned = page.evaluate(seen)
    page.locator(".player input").press("End")
    wait_until(page, f"{seen} !== '{turned}'")
    assert chromium.requests == [path.as_uri()]


NOTEBOOK = """html => {
    const cell = document.body.appendChild(document.createElement("div"));
    cell.innerHTML = html;
    for (const script of cell.querySelectorAll("script")) {
        const copy = document.createElement("script");
        for (const { name, value } of script.attributes) copy.setAttribute(name, value);
        copy.textContent = script.textContent;
        script.replaceWith(copy);
    }
}"""
"""Shows HTML as notebooks do, which start its scripts themselves."""


def test_notebooks_play_each_film_that_they_show(chromium):
    from spatial_pendulum import motion as in_space

    page = chromium.page()
    page.set_content("<!DOCTYPE html><body></body>")
    for count, trajectory in enumerate((motion(), in_space()), start=1):
        page.evaluate(NOTEBOOK, figures(trajectory)["mechanism"]._repr_html_())
        wait_until(page, f"document.querySelectorAll('.dalembert-film[data-plays] .player').length === {count}")
    page.get_by_role("button", name="Play").first.click()
    wait_until(page, "document.querySelector('.player output').textContent === 't = 2.00 s'")
    assert page.evaluate("document.querySelectorAll('.player').length") == 2
    assert chromium.complaints == []


def test_a_saved_film_plays(chromium, tmp_path):
    page = chromium.page()
    page.goto(figures(motion())["mechanism"].save(tmp_path / "film.html").as_uri())
    page.get_by_role("button", name="Play").click()
    wait_until(page, "document.querySelector('.player output').textContent === 't = 2.00 s'")
    assert chromium.complaints == []


def test_a_phone_scrolls_down_and_never_sideways(chromium, path):
    page = chromium.open(path, width=400, height=800, touch=True)
    assert page.evaluate("[innerWidth, document.documentElement.scrollWidth]") == [400, 400]
    assert page.evaluate(
        "[...document.querySelectorAll('.main-svg')].every((svg) => svg.getBoundingClientRect().right <= 400)"
    )
    assert page.evaluate("document.getElementById('figure-energies').layout.dragmode") is False


def test_each_control_can_be_reached_by_tab_and_each_has_a_name(chromium, path):
    page = chromium.open(path)
    names, wanted = [], {"To the result", "Play", "Time", "Download as CSV", "Identified values"}
    while not wanted <= set(names):
        assert len(names) < 100, f"Tab never came to {wanted - set(names)}"
        move_focus(page)
        names.append(
            page.evaluate(
                "(document.activeElement.getAttribute('aria-label') || document.activeElement.textContent).trim()"
            )
        )
    assert "" not in names[: names.index("Time") + 1]


def test_a_sweep_is_drawn(chromium, tmp_path):
    page = chromium.open(report(sweep(), tmp_path / "sweep.html"))
    assert page.evaluate("document.querySelectorAll('.canvas[data-drawn] .main-svg .js-line').length") >= 6
    assert chromium.complaints == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("make", [propagation, comparison, band_fit, parameter_set])
def test_reports_on_intervals_are_drawn(chromium, tmp_path, make, scheme):
    path = report(make(), tmp_path / "a.html")
    page = chromium.open(path, scheme=scheme)
    drawn = page.evaluate("[...document.querySelectorAll('.canvas[data-drawn]')].map((place) => place.id)")
    assert drawn == [f"figure-{name}" for name in figures(make())]
    assert chromium.complaints == []
    assert chromium.requests == [path.as_uri()]


@pytest.mark.parametrize(("scheme", "palette"), [("light", LIGHT), ("dark", DARK)])
def test_the_inside_of_a_band_is_faint_and_follows_the_page(chromium, tmp_path, scheme, palette):
    page = chromium.open(report(propagation(), tmp_path / "a.html"), scheme=scheme)
    fill = "document.querySelector('#figure-bands-1 .js-fill').style"
    assert page.evaluate(f"{fill}.fill") == _colour(palette.series[0])
    assert 0.1 < float(page.evaluate(f"{fill}.fillOpacity")) < 0.4


@pytest.mark.parametrize("make", [propagation, comparison, band_fit, parameter_set])
def test_reports_on_intervals_fit_a_phone(chromium, tmp_path, make):
    page = chromium.open(report(make(), tmp_path / "a.html"), width=400, height=800, touch=True)
    assert page.evaluate("[innerWidth, document.documentElement.scrollWidth]") == [400, 400]


@pytest.fixture(scope="module")
def shape_page(tmp_path_factory):
    phases = np.arange(64)
    states = np.where(phases < 32, 1, 2).astype(np.uint8)[None]
    shape = stand_in(
        Deformation,
        frequency=10.0,
        places=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        faces=np.array([[0, 1, 2, 3]]),
        contacts=("foot",),
        contact_places=np.array([[0.5, 0.5, 0.0]]),
        states=states,
        energies=np.array([1.0]),
        motion=lambda phases: np.cos(phases)[:, None, None] * np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 1]]),
    )
    return report(shape, tmp_path_factory.mktemp("shape") / "a.html")


def test_a_film_of_a_period_goes_on_without_end(chromium, shape_page):
    page = chromium.open(shape_page)
    fill = "document.querySelector('#figure-interface-map .scatterlayer .trace:last-child .point').style.fill"
    assert page.evaluate(fill) == _colour(LIGHT.series[0])
    page.evaluate("document.querySelector('.player[data-for=figure-interface-map] button').click()")
    wait_until(page, f"{fill} === '{_colour(LIGHT.series[1])}'")
    wait_until(page, f"{fill} === '{_colour(LIGHT.series[0])}'")
    pressed = "document.querySelector('.player[data-for=figure-interface-map] button').getAttribute('aria-pressed')"
    assert page.evaluate(pressed) == "true"


def test_a_deformed_shape_repeats_its_period_and_shows_values(chromium, shape_page):
    page = chromium.open(shape_page)
    words = "document.querySelector('#figure-deformation output').textContent"
    assert page.evaluate(words) == "phase 0 °"
    page.locator("#figure-deformation .player button").click()
    for _ in range(2):  # once more after the last frame
        wait_until(page, f"{words} === 'phase 345 °' || {words} === 'phase 330 °'")
        wait_until(page, f"{words} === 'phase 0 °' || {words} === 'phase 15 °'")
    page.locator("#figure-deformation .player button").click()
    bar = page.locator("#figure-deformation .player-bar text").all_text_contents()
    assert bar == ["0", "0.5", "1", "1.5", "2", "largest displacement (m)"]
    box = page.locator("#figure-deformation canvas").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    hint = "[...document.querySelectorAll('#figure-deformation span')].at(-1).textContent"
    wait_until(page, f"/^x [\\d.]+, y [\\d.]+, z -?[\\d.]+ m: [\\d.]+$/.test({hint})")
    x, y, _, value = map(float, re.findall(r"-?\d[\d.]*", page.evaluate(hint)))
    assert value == pytest.approx(x + y, abs=0.02)  # the shape is linear
    assert chromium.complaints == []
