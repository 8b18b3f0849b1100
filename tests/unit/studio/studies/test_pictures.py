"""Pictures of studies in the studio: drawn once, in a process that a study can only end itself."""

import asyncio

import pytest

from dalembert.studio.studies.pictures import Pictures
from dalembert.studio.worker import Limits, Worker
from dalembert.study.picture import picture_or_message
from dalembert.study.template import begin

MODEL = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
[model]
function = "model.py:model"
[solver]
step = "1 ms"
[simulate]
times = { end = "1 s", every = "10 ms" }
channels = ["rod.end.x"]
"""


@pytest.fixture
def pictures():
    made = Pictures(Worker(Limits(seconds=100.0, bytes=1_000_000_000)))
    yield made
    made.close()


def of_model(tmp_path, body):
    (tmp_path / "model.py").write_text(f"import os\nimport time\n\n\ndef model(rate):\n    {body}\n")
    (tmp_path / "study.toml").write_text(MODEL)
    return tmp_path / "study.toml"


def test_a_picture_is_drawn_again_only_after_a_change(tmp_path, pictures):
    study = begin("motion", tmp_path / "mine")

    async def twice():
        first = await pictures.of(study)
        drawn, pictures._drawn = pictures._drawn, None
        same = await pictures.of(study)
        pictures._drawn = drawn
        study.write_text(study.read_text().replace('name = "rod"', 'name = "rod2"').replace("rod.", "rod2."))
        return first, same, await pictures.of(study)

    first, same, other = asyncio.run(twice())
    assert 'data-part="rod"' in first
    assert same is first
    assert other != first


def test_templates_have_pictures(pictures):
    assert 'data-part="pin"' in asyncio.run(pictures.of_template("motion"))
    assert "No such template" in asyncio.run(pictures.of_template("../x"))


@pytest.mark.slow
def test_a_model_that_crashes_hangs_or_fills_the_memory_ends_its_process_only(tmp_path, pictures):
    study = of_model(tmp_path, "os._exit(3)")
    assert "No drawing: the model ended its process" in asyncio.run(pictures.of(study))
    assert 'data-part="pin"' in asyncio.run(pictures.of_template("motion"))
    of_model(tmp_path, "held = [bytearray(10**8) for _ in range(10**4)]")
    assert "No drawing: it needs too much memory" in asyncio.run(pictures.of(study))
    of_model(tmp_path, "time.sleep(1000)")
    pictures.worker.limits = Limits(seconds=1.0)
    assert "No drawing: it takes too long" in asyncio.run(pictures.of(study))
    pictures.worker.limits = Limits()
    assert "data-part=" in asyncio.run(pictures.of_template("spatial"))


def test_a_study_with_mistakes_says_so(tmp_path):
    (tmp_path / "study.toml").write_text("a = [")
    assert "No drawing: the study has errors" in picture_or_message(tmp_path / "study.toml")


def test_a_model_that_raises_an_error_says_so(tmp_path):
    assert "No drawing: the model raised ValueError" in picture_or_message(of_model(tmp_path, "raise ValueError('no')"))
