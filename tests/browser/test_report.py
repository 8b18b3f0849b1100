"""The report in a real browser: drawn, silent, dark where asked, and moving."""

from types import SimpleNamespace

import numpy as np
import pytest

from dalembert.report import figures, report
from dalembert.report.look import DARK, LIGHT
from stand_ins import band_fit, comparison, fit, motion, parameter_set, propagation, sweep

pytestmark = pytest.mark.slow
NASTY = "<img src=x onerror=\"document.title='run'\">"
LAST_BODY = "[...document.querySelectorAll('#figure-mechanism .scatterlayer .js-line')].at(-1).getAttribute('d')"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    result = fit(names=(NASTY, "theta2"), channels=("<b>AB</b>.x", "<b>AB</b>.y"))
    return report(result, tmp_path_factory.mktemp("page") / "fit.html", title="Pendulum", trajectory=motion())


def _colour(hexadecimal: str) -> str:
    return f"rgb({', '.join(str(int(hexadecimal[place : place + 2], 16)) for place in (1, 3, 5))})"


def test_every_figure_is_drawn_and_nothing_is_asked_for_or_refused(chromium, path):
    tab = chromium.open(path)
    drawn = tab.run("[...document.querySelectorAll('.canvas[data-drawn]')].map((place) => place.id)")
    assert drawn == [f"figure-{name}" for name in figures(fit(), trajectory=motion())]
    assert tab.requests == [path.as_uri()]
    assert tab.complaints == []


def test_a_script_that_slipped_in_would_be_refused(chromium, path, tmp_path):
    copy = tmp_path / "slipped.html"
    copy.write_text(path.read_text().replace("</main>", "<script>document.title = 'run'</script></main>"))
    tab = chromium.open(copy)
    assert tab.run("document.title") == "Pendulum"
    assert "Content Security Policy" in tab.complaints[0]


def test_names_are_shown_and_never_run(chromium, path):
    tab = chromium.open(path)
    assert tab.run("document.title") == "Pendulum"
    assert tab.run("document.images.length") == 0
    assert tab.run("document.querySelector('#figure-responses-1 .legendtext').textContent") == "<b>AB</b>.x measured"
    assert NASTY in tab.run("[...document.querySelectorAll('#figure-parameters text')].map((text) => text.textContent)")


@pytest.mark.parametrize(("scheme", "palette"), [("light", LIGHT), ("dark", DARK)])
def test_figures_follow_the_page_into_the_dark(chromium, path, scheme, palette):
    tab = chromium.open(path, scheme=scheme)
    assert tab.run("getComputedStyle(document.body).backgroundColor") == _colour(palette.page)
    assert tab.run("document.querySelector('#figure-energies .main-svg').style.background") == _colour(palette.surface)
    line = "document.querySelector('#figure-energies .scatterlayer .js-line').style.stroke"
    assert tab.run(line) == _colour(palette.series[0])


def test_figures_change_with_the_system_and_are_light_in_print(chromium, path):
    tab = chromium.open(path)
    ground = "document.querySelector('#figure-energies .main-svg').style.background"
    tab.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    tab.until(f"{ground} === '{_colour(DARK.surface)}'")
    tab.run("dispatchEvent(new Event('beforeprint'))")
    tab.until(f"{ground} === '{_colour(LIGHT.surface)}'")


def test_play_moves_the_mechanism_to_its_end_in_real_time(chromium, path):
    tab = chromium.open(path)
    before = tab.run(LAST_BODY)
    lasted = tab.run(
        """new Promise((done) => {
            const button = document.querySelector(".player button"), began = performance.now();
            button.click();
            const watch = setInterval(() => {
                if (button.getAttribute("aria-pressed") === "true") return;
                clearInterval(watch);
                done((performance.now() - began) / 1000);
            }, 10);
        })"""
    )
    assert 1.8 < lasted < 4.0
    assert tab.run("document.querySelector('.player output').textContent") == "t = 2.00 s"
    assert tab.run(LAST_BODY) != before


def test_the_player_obeys_the_keyboard(chromium, path):
    tab = chromium.open(path)
    tab.run("document.querySelector('.player button').focus()")
    tab.press("Enter")
    tab.until("document.querySelector('.player button').getAttribute('aria-pressed') === 'true'")
    tab.press("Enter")
    tab.until("document.querySelector('.player button').getAttribute('aria-pressed') === 'false'")
    tab.press("Tab")
    tab.press("Home")
    tab.press("ArrowRight")
    tab.until("document.querySelector('.player input').getAttribute('aria-valuetext') === '0.04 seconds'")


def test_the_slider_shows_the_mechanism_at_its_time(chromium, path):
    tab = chromium.open(path)
    tab.run(
        """(() => {
            const slider = document.querySelector(".player input");
            slider.value = 25;
            slider.dispatchEvent(new Event("input"));
        })()"""
    )
    figure = figures(fit(), trajectory=motion())["mechanism"]
    shown = "document.getElementById('figure-mechanism').calcdata.at(-1)[0].x"
    tab.until(f"Math.abs({shown} - {float(figure.frames[25].data[-1].x[0])}) < 1e-6")
    assert tab.run("document.querySelector('.player output').textContent") == "t = 1.02 s"


def test_a_phone_scrolls_down_and_never_sideways(chromium, path):
    tab = chromium.open(path, width=400, height=800, touch=True)
    assert tab.run("[innerWidth, document.documentElement.scrollWidth]") == [400, 400]
    assert tab.run(
        "[...document.querySelectorAll('.main-svg')].every((svg) => svg.getBoundingClientRect().right <= 400)"
    )
    assert tab.run("document.getElementById('figure-energies').layout.dragmode") is False


def test_each_control_can_be_reached_by_tab_and_each_has_a_name(chromium, path):
    tab = chromium.open(path)
    names, wanted = [], {"To the result", "▶ Play", "Time in seconds", "Download as CSV", "Identified values"}
    while not wanted <= set(names):
        assert len(names) < 100, f"Tab never came to {wanted - set(names)}"
        tab.move_focus()
        names.append(
            tab.run("(document.activeElement.getAttribute('aria-label') || document.activeElement.textContent).trim()")
        )
    assert "" not in names[: names.index("Time in seconds") + 1]


def test_a_sweep_is_drawn(chromium, tmp_path):
    tab = chromium.open(report(sweep(), tmp_path / "sweep.html"))
    assert tab.run("document.querySelectorAll('.canvas[data-drawn] .main-svg .js-line').length") >= 6
    assert tab.complaints == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("make", [propagation, comparison, band_fit, parameter_set])
def test_reports_on_intervals_are_drawn(chromium, tmp_path, make, scheme):
    path = report(make(), tmp_path / "a.html")
    tab = chromium.open(path, scheme=scheme)
    drawn = tab.run("[...document.querySelectorAll('.canvas[data-drawn]')].map((place) => place.id)")
    assert drawn == [f"figure-{name}" for name in figures(make())]
    assert tab.complaints == []
    assert tab.requests == [path.as_uri()]


@pytest.mark.parametrize(("scheme", "palette"), [("light", LIGHT), ("dark", DARK)])
def test_the_inside_of_a_band_is_faint_and_follows_the_page(chromium, tmp_path, scheme, palette):
    tab = chromium.open(report(propagation(), tmp_path / "a.html"), scheme=scheme)
    fill = "document.querySelector('#figure-bands-1 .js-fill').style"
    assert tab.run(f"{fill}.fill") == _colour(palette.series[0])
    assert 0.1 < float(tab.run(f"{fill}.fillOpacity")) < 0.4


@pytest.mark.parametrize("make", [propagation, comparison, band_fit, parameter_set])
def test_reports_on_intervals_fit_a_phone(chromium, tmp_path, make):
    tab = chromium.open(report(make(), tmp_path / "a.html"), width=400, height=800, touch=True)
    assert tab.run("[innerWidth, document.documentElement.scrollWidth]") == [400, 400]


def test_a_film_of_a_period_goes_on_without_end(chromium, tmp_path):
    phases = np.arange(64)
    states = np.where(phases < 32, 1, 2).astype(np.uint8)[None]
    shape = SimpleNamespace(
        frequency=10.0,
        places=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        faces=np.array([[0, 1, 2, 3]]),
        contacts=("foot",),
        contact_places=np.array([[0.5, 0.5, 0.0]]),
        states=states,
        energies=np.array([1.0]),
        motion=lambda phases: np.cos(phases)[:, None, None] * np.array([[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 1]]),
    )
    tab = chromium.open(report(shape, tmp_path / "a.html"))
    fill = "document.querySelector('#figure-interface-map .scatterlayer .trace:last-child .point').style.fill"
    assert tab.run(fill) == _colour(LIGHT.series[0])
    tab.run("document.querySelector('.player[data-for=figure-interface-map] button').click()")
    tab.until(f"{fill} === '{_colour(LIGHT.series[1])}'")
    tab.until(f"{fill} === '{_colour(LIGHT.series[0])}'")
    pressed = "document.querySelector('.player[data-for=figure-interface-map] button').getAttribute('aria-pressed')"
    assert tab.run(pressed) == "true"
