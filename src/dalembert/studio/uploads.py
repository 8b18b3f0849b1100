"""The field that takes files."""

from collections.abc import Awaitable, Callable

from nicegui import events, ui

from dalembert.studio.frame import complain
from dalembert.studio.workspace import MOST_BYTES

_HEADER = """
<div class="row items-center no-wrap q-gutter-x-sm q-pa-xs">
    <q-btn flat no-caps icon="upload_file" label="%s" class="col" align="left" @click="props.pickFiles" />
    <q-spinner v-if="props.isUploading" size="sm" role="img" aria-label="Uploading" />
    <span style="display: none"><q-uploader-add-trigger /></span>
</div>
"""
"""A button, in place of Quasar's icon without a name."""


def upload(label: str, kinds: str, uploaded: Callable[[events.UploadEventArguments], Awaitable[None]]) -> None:
    """Build a field that takes files of some kinds, such as ``".csv,.txt"``."""

    def refuse() -> None:
        ui.notify(
            f"The file was not taken. Choose one of at most {MOST_BYTES // 10**6} MB whose name ends in "
            f"{', '.join(kinds.split(','))}.",
            type="negative",
            multi_line=True,
            close_button="Close",
            timeout=0,
        )

    def fail() -> None:
        complain(OSError(0, "the upload failed", "The file"))

    takers = [uploaded]

    async def take(arguments: events.UploadEventArguments) -> None:
        for taker in takers:
            await taker(arguments)

    # FastAPI remembers the function of each route, and with it the field: the page behind it must not stay, too.
    ui.context.client.on_delete(takers.clear)
    field = ui.upload(label=label, auto_upload=True, on_upload=take, on_rejected=refuse, max_file_size=MOST_BYTES)
    field.on("failed", fail, args=[])
    field.props(f'accept="{kinds}" flat bordered color=transparent text-color=primary').classes("w-full max-w-md")
    field.add_slot("header", _HEADER % label)
