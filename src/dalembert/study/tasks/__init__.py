"""The tasks that a study file can ask for, by the names of their tables."""

from dalembert.study.tasks.backbone import BackboneTask
from dalembert.study.tasks.compare_integrators import CompareIntegrators
from dalembert.study.tasks.design import Design
from dalembert.study.tasks.frequency_response import FrequencyResponseTask
from dalembert.study.tasks.identify import Identify
from dalembert.study.tasks.identify_bands import IdentifyBands
from dalembert.study.tasks.identify_set import IdentifySet
from dalembert.study.tasks.modes import Modes
from dalembert.study.tasks.propagate import Propagate
from dalembert.study.tasks.simulate import Simulate
from dalembert.study.tasks.sweep import SweepTask
from dalembert.study.tasks.task import Outcome, Task
from dalembert.study.tasks.track_resonance import TrackResonance

TASKS: dict[str, Task] = {
    "simulate": Simulate(),
    "identify": Identify(),
    "sweep": SweepTask(),
    "propagate": Propagate(),
    "identify_bands": IdentifyBands(),
    "identify_set": IdentifySet(),
    "design": Design(),
    "work_precision": CompareIntegrators(),
    "frequency_response": FrequencyResponseTask(),
    "track_resonance": TrackResonance(),
    "backbone": BackboneTask(),
    "modes": Modes(),
}

__all__ = ["TASKS", "Outcome", "Task"]
