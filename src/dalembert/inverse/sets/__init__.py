"""All parameters that are consistent with measurements of bounded error."""

from dalembert.inverse.sets.identify_set import identify_set
from dalembert.inverse.sets.parameter_set import ParameterSet

__all__ = ["ParameterSet", "identify_set"]
