"""The studio: studies and runs in a browser."""

from typing import TYPE_CHECKING

from dalembert.lazy import lazy_names

if TYPE_CHECKING:
    from dalembert.studio.server import application, serve

__all__ = ["application", "serve"]

# The processes that compute for a study import a module of this package, and need no pages.
__getattr__, __dir__ = lazy_names(__name__, dict.fromkeys(__all__, f"{__name__}.server"))
