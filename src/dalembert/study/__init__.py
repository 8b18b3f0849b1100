"""Study files: read, checked, run in folders of their own."""

from dalembert.study.folder import RunFolder
from dalembert.study.loader import load
from dalembert.study.runner import report_run, resume_run, run_study
from dalembert.study.schema import json_schema
from dalembert.study.study import Study
from dalembert.study.validation import plan

__all__ = ["RunFolder", "Study", "json_schema", "load", "plan", "report_run", "resume_run", "run_study"]
