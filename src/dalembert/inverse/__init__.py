"""Parameters from measurements."""

from dalembert.inverse.estimate import Identifiability
from dalembert.inverse.events import Event, Finished, Screened, StartBegan, StartEnd, Step, as_record
from dalembert.inverse.fit import Fit
from dalembert.inverse.identify import identify

__all__ = [
    "Event",
    "Finished",
    "Fit",
    "Identifiability",
    "Screened",
    "StartBegan",
    "StartEnd",
    "Step",
    "as_record",
    "identify",
]
