"""What data can tell: before they are measured, and after they have been fitted."""

from dalembert.inverse.telling.design import design
from dalembert.inverse.telling.designs import Designs
from dalembert.inverse.telling.identifiability import identifiability
from dalembert.inverse.telling.predict import predict
from dalembert.inverse.telling.prediction import Prediction
from dalembert.inverse.telling.profile import profile
from dalembert.inverse.telling.profiles import Profile, Profiles

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
