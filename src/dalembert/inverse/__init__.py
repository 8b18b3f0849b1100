"""Parameters from measurements."""

from dalembert.inverse.bands import BandFit
from dalembert.inverse.estimate import Identifiability
from dalembert.inverse.events import Event, Finished, Screened, StartBegan, StartEnd, Step, as_record
from dalembert.inverse.fit import Fit
from dalembert.inverse.identify import identify
from dalembert.inverse.sets import ParameterSet

__all__ = [
    "BandFit",
    "Event",
    "Finished",
    "Fit",
    "Identifiability",
    "ParameterSet",
    "Screened",
    "StartBegan",
    "StartEnd",
    "Step",
    "as_record",
    "identify",
]
