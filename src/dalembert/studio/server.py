"""The studio as a web application: its pages, the files of its runs, and where it listens."""

import asyncio
import secrets
import socket
from functools import partial
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Query
from fastapi.middleware.gzip import GZipMiddleware
from fastapi.responses import FileResponse, PlainTextResponse, Response

from dalembert.errors import InputError
from dalembert.studio.guard import Guard
from dalembert.studio.jobs import Jobs
from dalembert.studio.processes import prepare
from dalembert.studio.runs.compare_page import ADDRESS, compare_page, comparison_file
from dalembert.studio.runs.continue_page import continue_page
from dalembert.studio.runs.run_list import RunList
from dalembert.studio.runs.run_page import FILES, run_page
from dalembert.studio.runs.runs_page import runs_page
from dalembert.studio.studies.model_page import model_page
from dalembert.studio.studies.new_page import new_page
from dalembert.studio.studies.pictures import Pictures
from dalembert.studio.studies.studies_page import studies_page
from dalembert.studio.studies.study_page import study_page
from dalembert.studio.worker import Worker
from dalembert.studio.workspace import Workspace, checked

PATIENCE = 30.0  # s that a browser may be out of reach, on a machine that runs are busy on
LOOPBACK = ("127.0.0.1", "localhost", "::1")
POLICY = (
    "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; connect-src 'self' ws: wss:; frame-ancestors 'self'"
)
"""Nothing is loaded from elsewhere; NiceGUI's pages build their scripts inline."""


def application(root: Path, *, far: bool = False) -> FastAPI:
    """The studio's pages for a folder.

    Parameters
    ----------
    root : Path
        Studies lie in ``studies/``, runs in ``runs/``.
    far : bool
        Compress what is sent, for browsers on other machines. On this one, compression takes longer than it saves.
    """
    from nicegui import app as pages
    from nicegui import ui

    workspace, jobs, pictures = Workspace(root.resolve()), Jobs(), Pictures()
    watcher = Worker(spares=True)  # of the pages of runs
    listed = RunList(workspace.runs_folder)
    app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
    _add_pages(workspace, jobs, watcher, listed)
    _add_files(app, workspace, pictures)

    @app.middleware("http")
    async def headers(request: Any, follow: Any) -> Response:
        answer = await follow(request)
        if not request.url.path.startswith(("/files/", ADDRESS)):  # a report has a policy of its own, and a sandbox
            answer.headers["Content-Security-Policy"] = POLICY
        answer.headers["X-Content-Type-Options"] = "nosniff"
        answer.headers["Referrer-Policy"] = "no-referrer"
        return answer

    ui.run_with(
        app,
        title="dalembert",
        dark=None,
        show_welcome_message=False,
        language="en-US",
        reconnect_timeout=PATIENCE,
        gzip_middleware_factory=GZipMiddleware if far else None,
    )
    pages.on_startup(partial(asyncio.to_thread, listed.rows))  # the first page of runs finds them read
    pages.on_shutdown(watcher.stop)
    pages.on_shutdown(pictures.close)
    return app


def _add_pages(workspace: Workspace, jobs: Jobs, watcher: Worker, listed: RunList) -> None:
    from nicegui import ui

    @ui.page("/")
    async def runs() -> None:
        await runs_page(workspace, jobs, listed)

    ui.page("/new")(lambda: new_page(workspace))
    ui.page("/studies")(lambda: studies_page(workspace))

    @ui.page("/study/{folder}/{file}")
    def study(folder: str, file: str) -> None:
        study_page(workspace, jobs, f"{folder}/{file}")

    @ui.page("/study/{folder}/{file}/model")
    def model(folder: str, file: str) -> None:
        model_page(workspace, f"{folder}/{file}")

    @ui.page("/run/{name}")
    def run(name: str) -> Any:
        try:
            checked(name)
        except InputError as error:
            if name not in [folder.path.name for folder in workspace.runs()]:  # another program may have named it
                return PlainTextResponse(str(error), status_code=404)
        return run_page(workspace, jobs, watcher, name)

    @ui.page("/continue/{name}")
    def go_on(name: str, code: str = "", number: int = 0) -> None:
        continue_page(workspace, name, code, number)

    @ui.page("/compare")
    def compare(run: list[str] = Query(default=[])) -> None:  # noqa: B008  FastAPI reads the default
        compare_page(workspace, run)


def _add_files(app: FastAPI, workspace: Workspace, pictures: Pictures) -> None:
    """Add what pages load: comparisons, files of runs and pictures."""

    @app.get(ADDRESS)
    def comparison(run: list[str] = Query(default=[])) -> Response:  # noqa: B008
        return comparison_file(workspace, run)

    @app.get(f"{ADDRESS}.csv")
    def values(run: list[str] = Query(default=[])) -> Response:  # noqa: B008
        return comparison_file(workspace, run, csv=True)

    @app.get("/files/{name}/{file}")
    def files(name: str, file: str) -> Response:
        try:
            path = workspace.run(name).path / file
        except InputError as error:
            return PlainTextResponse(str(error), status_code=404)
        if file not in FILES or not path.is_file():
            return PlainTextResponse(f"there is no {file} to read", status_code=404)
        return FileResponse(path)

    @app.get("/picture/{folder}/{file}")
    async def picture(folder: str, file: str) -> Response:
        try:
            path = workspace.study(f"{folder}/{file}")
        except InputError as error:
            return PlainTextResponse(str(error), status_code=404)
        return Response(await pictures.of(path), media_type="image/svg+xml")

    @app.get("/picture-of-template/{name}")
    async def picture_of_template(name: str) -> Response:
        return Response(await pictures.of_template(name), media_type="image/svg+xml")


def serve(root: Path, host: str = "127.0.0.1", port: int = 8080, token: str = "", browser: bool = True) -> None:
    """Run the studio until it is stopped.

    Parameters
    ----------
    root : Path
    host : str
        Beyond this machine's own addresses a token is needed, and made if none is given.
    port : int
        Another free one is taken if 0.
    token : str
    browser : bool
        Whether to open the page.

    Raises
    ------
    InputError
        For a port that is taken, an address that is not this machine's, and a token that is too short.
    """
    import uvicorn

    if token and len(token) < 16:
        raise InputError(f"the token has {len(token)} characters; expected at least 16, which cannot be guessed")
    if host not in LOOPBACK and not token:
        token = secrets.token_urlsafe(24)
    listening = _listening(host, port)
    prepare()
    port = listening.getsockname()[1]
    shown = "localhost" if host in ("0.0.0.0", "::") else host
    address = f"http://{f'[{shown}]' if ':' in shown else shown}:{port}/" + (f"?token={token}" if token else "")
    print(f"The studio: {address}\nStop it with Ctrl-C. Runs continue without it.", flush=True)  # noqa: T201
    if browser:
        import webbrowser

        webbrowser.open(address)
    pages = application(root, far=host not in LOOPBACK)
    config = uvicorn.Config(Guard(pages, token), log_level="warning", ws_max_size=16_000_000)
    uvicorn.Server(config).run(sockets=[listening])


def _listening(host: str, port: int) -> socket.socket:
    """Return a socket that listens at an address. Connections wait in it until the pages are ready."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
        listening.listen()
    except OSError as error:
        listening.close()
        raise InputError(
            f"the studio cannot listen at {host}:{port}: {error.strerror}; choose another with --port or --host"
        ) from None
    return listening
