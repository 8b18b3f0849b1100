"""The studio: studies and runs in a browser."""

from dalembert.studio.server import application, serve

__all__ = ["application", "serve"]
