"""The measured data as the study reads them, and a field to add files."""

from nicegui import events, run, ui

from dalembert.errors import DalembertError
from dalembert.report.charts.identification.measured import measured
from dalembert.studio.draft import Draft
from dalembert.studio.figures import on_any_page, plot
from dalembert.studio.frame import complaints
from dalembert.studio.latest import Latest
from dalembert.studio.room import Room
from dalembert.studio.uploads import upload
from dalembert.study.study import Study

KINDS = ".csv,.txt,.dat,.parquet,.mat,.uff,.unv,.nc,.npz"


def show(draft: Draft, room: Room) -> None:
    """Build the panel."""
    drawn = ui.column().classes("w-full")

    async def draw() -> None:
        study = draft.study
        drawn.clear()
        if study is not None and study.file.data is not None:
            with drawn:
                await _draw(study)

    async def uploaded(event: events.UploadEventArguments) -> None:
        with complaints():
            placed = room.workspace.put(draft.name, event.file.name, await event.file.read())
            ui.notify(f"{placed.name} lies beside the study now: name it in [data].", type="positive")
            draft.check()

    draft.follow("study", Latest(draw))
    upload("Add measured data", KINDS, uploaded)


async def _draw(study: Study) -> None:
    """Plot the data, or show why they cannot be read."""
    try:
        data = await run.io_bound(study.data)
        if data is None:  # the studio is ending
            return
    except DalembertError as error:
        ui.label(str(error)).classes("text-negative").props("role=alert")
        return
    plot(on_any_page(measured(data))).classes("w-full h-80").props('role=img aria-label="Measured data"')
