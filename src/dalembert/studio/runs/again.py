"""Repeat a run: with the same study and the same files, in a new folder."""

from dalembert.studio.jobs import Jobs
from dalembert.studio.runs.run_list import study_name
from dalembert.studio.workspace import Workspace


def run_again(workspace: Workspace, jobs: Jobs, name: str) -> str:
    """Start the study of a run again; return the name of the new run."""
    old = workspace.run(name)
    folder = workspace.new_run(study_name(old, old.state()) or name)
    jobs.rerun(old.path, folder)
    return folder.name
