"""The field that takes files."""

from collections.abc import Awaitable, Callable

from nicegui import events, ui

from dalembert.studio.workspace import MOST_BYTES


def upload(label: str, kinds: str, uploaded: Callable[[events.UploadEventArguments], Awaitable[None]]) -> None:
    """Build a field that takes files of some kinds, such as ``".csv,.txt"``."""
    field = ui.upload(label=label, auto_upload=True, on_upload=uploaded, max_file_size=MOST_BYTES)
    field.props(f'accept="{kinds}" flat bordered').classes("w-full max-w-md")
