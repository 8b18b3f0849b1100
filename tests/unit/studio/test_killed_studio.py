"""A studio that is killed while it saves: the study file is one of the texts, whole."""

import random
import subprocess
import sys
import time

import pytest

from dalembert.studio.editor.draft import Draft
from dalembert.studio.workspace import Workspace
from dalembert.study.template import templates

TEXT = templates()["motion"].text
SAVES = """
import sys
from pathlib import Path
from dalembert.studio.editor.draft import Draft

draft = Draft(Path(sys.argv[1]))
print("ready", flush=True)
number = 0
while True:
    number += 1
    draft.set_text(f"# {number}\\n" * 2000 + sys.argv[2])
    draft.save()
"""


@pytest.mark.slow
def test_a_file_is_whole_whenever_the_process_that_saves_it_is_killed(tmp_path):
    workspace, chance = Workspace(tmp_path), random.Random(1)
    name = workspace.create("mine", TEXT)
    path = workspace.study(name)
    for _ in range(8):
        process = subprocess.Popen([sys.executable, "-c", SAVES, path, TEXT], stdout=subprocess.PIPE, text=True)
        with process:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
            time.sleep(chance.uniform(0.02, 0.3))
            process.kill()
        text = Draft(path).text
        number = text.partition("\n")[0]
        assert text in (TEXT, f"{number}\n" * 2000 + TEXT)
        assert workspace.studies() == [name]


def test_files_that_were_being_written_are_no_studies(tmp_path):
    workspace = Workspace(tmp_path)
    name = workspace.create("mine", TEXT)
    (tmp_path / "studies" / "mine" / ".study-x1.toml").write_text(TEXT)
    assert workspace.studies() == [name]
