"""What data can tell: before they are measured, and after they have been fitted."""

from dalembert.inverse.assessment.design import design
from dalembert.inverse.assessment.designs import Designs
from dalembert.inverse.assessment.identifiability import identifiability
from dalembert.inverse.assessment.predict import predict
from dalembert.inverse.assessment.prediction import Prediction
from dalembert.inverse.assessment.profile import profile
from dalembert.inverse.assessment.profiles import Profile, Profiles

__all__ = [
    "Designs",
    "Prediction",
    "Profile",
    "Profiles",
    "design",
    "identifiability",
    "predict",
    "profile",
]
