"""What the studio keeps of pages of studies that were left: no descriptors, no memory."""

import asyncio
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
import socketio

import counted_studio
from dalembert.study.template import begin

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="descriptors and memory are read from /proc")
PATIENCE = 60.0
"""Seconds until pages that were left must be gone; with a patience of 0.5 s they are gone after about 1 s."""
MEMORY = 30.0
"""Megabytes that 200 visits may add. They added 250 when their pages were kept."""


class Studio:
    """A studio, and what its process has."""

    def __init__(self, process: subprocess.Popen, address: str) -> None:
        self.address, self._folder = address, Path(f"/proc/{process.pid}")

    @property
    def descriptors(self) -> int:
        return len(list((self._folder / "fd").iterdir()))

    @property
    def megabytes(self) -> float:
        """Memory that is resident."""
        found = re.search(r"VmRSS:\s*(\d+) kB", (self._folder / "status").read_text())
        assert found is not None
        return int(found[1]) / 1024

    @property
    def pages(self) -> int:
        """Pages of studies in memory."""
        return int(httpx.get(self.address + counted_studio.PAGES, timeout=PATIENCE).text)

    def visit(self, times: int) -> None:
        """Open the page of a study some times, as a browser does, and leave it; return when what is left is gone."""
        asyncio.run(self._visits(times))
        before = self.descriptors
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:  # until nothing changes for a second
            time.sleep(1.0)
            if before == (before := self.descriptors) and self.pages <= 1:
                return

    async def _visits(self, times: int) -> None:
        async with httpx.AsyncClient(base_url=self.address, timeout=PATIENCE) as client:
            for number in range(times):
                page = (await client.get("/study/swing/swing")).raise_for_status().text
                name = re.search(r"client_id\W+([0-9a-f-]{36})", page)
                assert name is not None
                assert "No such study" not in page
                query = f"client_id={name[1]}&next_message_id=0&implicit_handshake=true"
                async with socketio.AsyncSimpleClient() as socket:
                    await socket.connect(
                        f"{self.address}?{query}&tab_id=tab{number}&document_id=document{number}",
                        socketio_path="/_nicegui_ws/socket.io",
                        transports=["websocket"],
                    )
                    await asyncio.sleep(0.2)  # the process of the page begins to compute


@pytest.fixture
def studio(tmp_path) -> Iterator[Studio]:
    begin("motion", tmp_path / "studies" / "swing")
    command = [sys.executable, counted_studio.__file__, tmp_path]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            found = re.search(r"http://\S+", process.stdout.readline())
            assert found is not None
            yield Studio(process, found[0].rstrip("/"))
        finally:
            process.terminate()


def test_left_pages_are_let_go_of(studio):
    studio.visit(1)
    before = studio.descriptors
    studio.visit(10)
    assert studio.descriptors <= before + 2
    assert studio.pages <= 1  # the newest one may be referred to by the last request


@pytest.mark.slow
def test_300_visits_take_no_descriptors_and_no_memory(studio):
    studio.visit(100)
    descriptors, memory = studio.descriptors, studio.megabytes
    studio.visit(200)
    assert studio.descriptors <= descriptors + 2
    assert studio.pages <= 1
    assert studio.megabytes < memory + MEMORY
