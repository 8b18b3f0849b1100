"""What the studio imports and reads before it answers, and what its processes have ready."""

import asyncio
import subprocess
import sys
from pathlib import Path

import pytest

from dalembert.studio.editor.reading import Reading, reading, study_of
from dalembert.studio.model.picture import model_picture
from dalembert.studio.simulation.answers import Source, simulated
from dalembert.studio.worker import Kept, Worker
from dalembert.study.template import begin
from worker_functions import loaded

HEAVY = {"numba", "scipy", "h5py", "dalembert.multibody", "dalembert.study.tables.study", "dalembert.study.schema"}


@pytest.fixture
def study(tmp_path: Path) -> Path:
    return begin("identify", tmp_path / "pendulum")


def test_the_studio_starts_without_models_and_solvers() -> None:
    code = "import sys, dalembert.studio.server; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not HEAVY & set(run.stdout.split())


@pytest.mark.skipif(sys.platform != "linux", reason="processes are forked on Linux only")
def test_a_process_has_imported_all_before_it_is_asked() -> None:
    worker = Worker()
    try:
        assert asyncio.run(worker.ask("loaded", loaded, sorted(HEAVY - {"h5py"})))
    finally:
        worker.stop()


def test_a_study_is_read_once_for_its_text_its_drawing_and_its_simulation(study: Path, monkeypatch) -> None:
    kept, text = Kept(), study.read_text()
    found = reading(kept, study, text)
    assert found.study is not None
    values = {
        name: float(value) for name, value in found.study.parameters.mapping(found.study.parameters.start).items()
    }
    with monkeypatch.context() as changed:
        changed.setattr("dalembert.study.loader.load", None)
        assert model_picture(kept, study, text, values).svg
        assert simulated(kept, Source.of(found.study, study, text), "", values).film is not None


def test_a_study_is_read_again_when_its_data_changed(study: Path) -> None:
    kept, text = Kept(), study.read_text()
    first = study_of(kept, study, text)
    assert study_of(kept, study, text) is first
    data = next(iter(first.files.values()))
    data.write_text(data.read_text() + "\n")
    assert study_of(kept, study, text) is not first


def test_an_outline_says_what_the_page_shows(study: Path) -> None:
    outline = reading(Kept(), study, study.read_text()).study
    assert outline is not None
    assert (outline.name, outline.task, list(outline.parts)) == ("pendulum", "identify", [""])
    assert "rod.end.x" in outline.channels
    assert isinstance(reading(Kept(), study, "[model"), Reading)
