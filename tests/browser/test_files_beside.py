"""Studies whose model and data are in files beside them: mistakes, forms, and changes of these files."""

from pathlib import Path

import pytest

from browser.running_studio import opener, running_studio
from browser.visitor import wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("beside")


@pytest.fixture(scope="module")
def address(root):
    with running_studio(root) as found:
        yield found


@pytest.fixture
def visit(chromium, address):
    return opener(chromium, address)


def with_model_file(root: Path, name: str) -> tuple[Path, Path]:
    """A study and the file of its model."""
    study = begin("identify", root / "studies" / name)
    head, _, rest = study.read_text().partition("[model]")
    model, at, task = f"[model]{rest}".partition("[solver]")
    other = study.with_name("pendulum.toml")
    other.write_text(model)
    study.write_text(f'{head}[model]\nfile = "pendulum.toml"\n\n{at}{task}')
    return study, other


def test_a_repair_of_the_model_file_is_noticed(visit, root):
    _, other = with_model_file(root, "repaired")
    page = visit("/study/repaired/repaired")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    whole = other.read_text()
    other.write_text(whole.replace('mass = "1.5 kg"', 'mass = "1.5 m"'))
    wait_until(page, f"{TEXT}.includes(\"pendulum.toml: [[model.body]] 'rod', mass: \")")
    assert page.locator(".cm-line.wrong").inner_text() == 'file = "pendulum.toml"'
    assert page.get_by_role("button", name="Run", exact=True).is_disabled()
    other.write_text(whole)
    wait_until(page, f"{TEXT}.includes('Valid.')")
    assert page.get_by_role("button", name="Run", exact=True).is_enabled()


def test_parts_are_not_added_beside_a_model_file(visit, root):
    with_model_file(root, "elsewhere")
    page = visit("/study/elsewhere/elsewhere")
    page.get_by_role("tab", name="Forms").click()
    wait_until(page, f"{TEXT}.includes('are in pendulum.toml. Change them there.')")
    for name in ("body", "joint", "force"):
        assert page.get_by_role("button", name=f"Add a {name}").is_disabled()
    assert page.get_by_role("button", name="Add a parameter").is_enabled()


def test_new_rows_of_the_data_are_shown(visit, root):
    study, _ = with_model_file(root, "longer")
    data = study.with_name("motion.csv")
    page = visit("/study/longer/longer")
    page.get_by_role("tab", name="Data").click()
    lines = data.read_text().splitlines()
    wait_until(page, f"{TEXT}.includes('{len(lines) - 1} rows.')")
    data.write_text("\n".join(lines[:-10]) + "\n")
    wait_until(page, f"{TEXT}.includes('{len(lines) - 11} rows.')")


def test_a_copy_with_a_mistake_opens_and_is_listed(visit, root):
    study, _ = with_model_file(root, "copied")
    page = visit("/study/copied/copied")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    page.locator(".cm-content").click()
    page.keyboard.press("Control+Home")
    page.keyboard.insert_text("mine\n")
    wait_until(page, f"{TEXT}.includes('Save •')")
    study.write_text(f"# theirs\n{study.read_text()}")
    page.get_by_role("button", name="Save as a copy").click()
    wait_until(page, f"location.pathname === '/study/copied/copied-2' && {TEXT}.includes('1 error:')")
    page.goto(page.url.replace("/study/copied/copied-2", "/studies"))
    page.get_by_label("Search studies").fill("copied-2")
    wait_until(page, f"{TEXT}.includes('has errors')")


def test_the_model_file_is_edited_in_a_page_of_its_own(visit, root):
    _, other = with_model_file(root, "opened")
    page = visit("/study/opened/opened")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    page.get_by_role("link", name="Open the model file pendulum.toml").click()
    wait_until(page, f"location.pathname === '/study/opened/opened/model' && {TEXT}.includes('Valid.')")
    page.locator(".cm-line", has_text="1.5 kg").click()
    page.keyboard.press("End")
    page.keyboard.type("x")
    wait_until(page, "document.querySelector('.cm-line.wrong')?.innerText.startsWith('mass = ')")
    page.keyboard.press("Backspace")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    page.keyboard.type(" # weighed")
    page.keyboard.press("Control+s")
    wait_until(page, f"{TEXT}.includes('Saved.')")
    assert 'mass = "1.5 kg" # weighed' in other.read_text()
    page.keyboard.type(" twice")
    wait_until(page, f"{TEXT}.includes('Save •')")
    other.write_text(f"# theirs\n{other.read_text()}")
    wait_until(page, f"{TEXT}.includes('pendulum.toml changed on disk, and the text here has changes too.')")
    page.get_by_role("button", name="Save as a copy").click()
    wait_until(page, f"{TEXT}.includes('Saved as pendulum-2.toml.')")
    assert "# weighed twice" in other.with_name("pendulum-2.toml").read_text()
    assert other.read_text().startswith("# theirs")
    page.get_by_role("link", name="Study opened").click()
    wait_until(page, "location.pathname === '/study/opened/opened'")


def test_the_model_file_is_drawn_and_has_forms(visit, root):
    _, other = with_model_file(root, "drawn")
    page = visit("/study/drawn/drawn")
    page.locator("g.body[data-part=rod]").click()
    wait_until(page, f"{TEXT}.includes('are in pendulum.toml. Change them there.')")
    page.get_by_role("link", name="Open the model file pendulum.toml").click()
    wait_until(page, "document.querySelector('g.body[data-part=rod]')")
    page.locator("g.body[data-part=rod]").click()
    wait_until(page, "document.querySelector('.cm-line.chosen')?.innerText.includes('[[model.body]]')")
    page.get_by_role("tab", name="Forms").click()
    page.get_by_label("mass, kg").fill("2 kg")
    page.keyboard.press("Tab")
    wait_until(page, f"{TEXT}.includes('mass = \"2 kg\"') && {TEXT}.includes('Valid.')")
    assert page.get_by_role("button", name="Add a body").is_enabled()
    assert not page.get_by_role("button", name="Add a parameter").count()
    page.get_by_role("button", name="Save").click()
    wait_until(page, f"{TEXT}.includes('Saved.')")
    assert 'mass = "2 kg"' in other.read_text()
