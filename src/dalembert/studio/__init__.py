"""The studio: studies and runs in a browser."""

from dalembert.lazy import lazy_names

# The processes that compute for a study import a module of this package, and need no pages.
__getattr__, __dir__ = lazy_names(__name__, dict.fromkeys(("application", "serve"), f"{__name__}.server"))
