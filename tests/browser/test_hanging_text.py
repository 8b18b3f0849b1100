"""A text whose check never ends: the studio goes on, and the next text is checked."""

import pytest

from browser.running_studio import running_studio
from browser.visitor import wait_until

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"
MODEL = """
import time
import numpy as np
from dalembert.forward import PythonModel

def model(parameters, wait):
    time.sleep(wait)
    return PythonModel(lambda rate: np.exp(-rate * np.arange(3.0)), parameters, ["x"], np.arange(3.0))
"""
STUDY = """
[parameters]
rate = {{ lower = 0.01, upper = 10.0, start = 1.0, unit = "1/s" }}
[model]
forward = "model.py:model"
arguments = {{ wait = {wait} }}
[sweep]
at = 1.0
channels = ["x"]
over = {{ rate = {{ count = 3 }} }}
"""


def test_a_check_that_hangs_ends_with_the_next_text(chromium, tmp_path):
    folder = tmp_path / "studies" / "slow"
    folder.mkdir(parents=True)
    (folder / "model.py").write_text(MODEL)
    (folder / "study.toml").write_text(STUDY.format(wait=1000.0))
    with running_studio(tmp_path) as address:
        page, other = chromium.page(), chromium.page()
        page.goto(f"{address}/study/slow/study")
        page.get_by_text("arguments = { wait = 1000.0 }").click()
        other.goto(f"{address}/studies")
        wait_until(other, f"{TEXT}.includes('Your studies')")
        assert "Valid." not in page.inner_text("body")
        page.locator(".cm-line", has_text="1000.0").click()
        page.keyboard.press("End")
        for _ in "00.0 }":
            page.keyboard.press("Backspace")
        for _ in "10":
            page.keyboard.press("Backspace")
        page.keyboard.insert_text("0 }")
        wait_until(page, f"{TEXT}.includes('Valid.')")
