"""What the residuals of a fit say about its model and its data."""

from dalembert.inverse.misfit.delays import SuspectDelay, suspect_delays
from dalembert.inverse.misfit.halves import Halves, halves
from dalembert.inverse.misfit.local_noise import local_deviation
from dalembert.inverse.misfit.misfit import misfit_conclusions
from dalembert.inverse.misfit.model_misfit import ModelMisfit, model_misfits

__all__ = [
    "Halves",
    "ModelMisfit",
    "SuspectDelay",
    "halves",
    "local_deviation",
    "misfit_conclusions",
    "model_misfits",
    "suspect_delays",
]
