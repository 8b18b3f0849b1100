"""Chromium by its DevTools protocol over a pipe: messages are JSON, each ended by a zero byte."""

import base64
import json
import os
import select
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--no-startup-window",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-pipe",
)
PATIENCE = 120.0
LAUNCH = """
import fcntl, os, sys
there = [fcntl.fcntl(int(pipe), fcntl.F_DUPFD, 10) for pipe in sys.argv[1:3]]
os.dup2(there[0], 3)
os.dup2(there[1], 4)
os.execv(sys.argv[3], sys.argv[3:])
"""
"""The browser reads at descriptor 3 and writes at 4, whatever the pipes' ends are called here."""
STILL = """(async () => {
    const found = %s;
    if (!found || found.disabled) return null;
    found.scrollIntoView({block: "center", behavior: "instant"});
    const middle = () => {
        const box = found.getBoundingClientRect();
        return [box.x + box.width / 2, box.y + box.height / 2];
    };
    const before = middle();
    await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
    const [x, y] = middle();
    return x === before[0] && y === before[1] && found.contains(document.elementFromPoint(x, y)) ? [x, y] : null;
})()"""
"""Middle of an element if it is enabled, not covered, and at rest over two animation frames; else null."""


class Chromium:
    """A running browser."""

    def __init__(self, program: Path, profile: Path) -> None:
        read_here, write_there = os.pipe()
        read_there, write_here = os.pipe()
        command = [sys.executable, "-c", LAUNCH, str(read_there), str(write_there), str(program), *OPTIONS]
        self.process = subprocess.Popen(
            [*command, f"--user-data-dir={profile}"],
            pass_fds=(read_there, write_there),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(read_there)
        os.close(write_there)
        self.reader, self.writer = read_here, write_here
        self.buffer, self.number = b"", 0
        self.events: list[dict[str, Any]] = []
        # Without a page the window would close after each test; a new window costs processor time.
        self.kept = self.send("Target.createTarget", url="about:blank")["targetId"]

    def open(
        self, path: Path, *, width: int = 1200, height: int = 900, scheme: str = "light", touch: bool = False
    ) -> "Tab":
        """A new tab with a file in it, once it says that its figures are drawn."""
        tab = self.tab(width=width, height=height, scheme=scheme, touch=touch)
        tab.send("Page.navigate", url=path.as_uri())
        tab.until("document.documentElement?.dataset.ready === 'yes'")
        return tab

    def tab(self, *, width: int = 1200, height: int = 900, scheme: str = "light", touch: bool = False) -> "Tab":
        """A new tab, with nothing in it."""
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        tab = Tab(self, session)
        for domain in ("Page", "Runtime", "Log", "Network"):
            tab.send(f"{domain}.enable")
        tab.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        tab.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=touch)
        tab.send("Emulation.setTouchEmulationEnabled", enabled=touch)
        return tab

    @property
    def pages(self) -> list[dict[str, Any]]:
        """Open pages except the one that is kept, and frames in separate processes."""
        targets = self.send("Target.getTargets")["targetInfos"]
        return [one for one in targets if one["type"] in ("page", "iframe") and one["targetId"] != self.kept]

    def close_pages(self) -> None:
        """Close all pages, wait until they are closed, and delete their events."""
        for page in self.pages:
            if page["type"] == "page":
                self.send("Target.closeTarget", targetId=page["targetId"])
        end = time.monotonic() + PATIENCE
        while open_ := self.pages:
            assert time.monotonic() < end, f"pages stay open: {open_}"
            time.sleep(0.05)
        self.events.clear()

    def send(self, method: str, session: str | None = None, **parameters: Any) -> dict[str, Any]:
        """Answer to one command; events that come meanwhile are kept."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        os.write(self.writer, json.dumps(message | ({"sessionId": session} if session else {})).encode() + b"\0")
        while True:
            answer = self._read()
            if answer.get("id") == self.number:
                assert "error" not in answer, f"{method}: {answer['error']}"
                return answer["result"]
            self.events.append(answer)

    def close(self) -> None:
        with suppress(AssertionError):  # it may end before it answers
            self.send("Browser.close")
        self.process.wait(PATIENCE)
        os.close(self.reader)
        os.close(self.writer)

    def _read(self) -> dict[str, Any]:
        while b"\0" not in self.buffer:
            assert select.select([self.reader], [], [], PATIENCE)[0], "the browser does not answer"
            piece = os.read(self.reader, 1 << 20)
            assert piece, "the browser ended"
            self.buffer += piece
        message, _, self.buffer = self.buffer.partition(b"\0")
        return json.loads(message)


class Tab:
    """A page in the browser."""

    def __init__(self, browser: Chromium, session: str) -> None:
        self.browser, self.session = browser, session

    def send(self, method: str, **parameters: Any) -> dict[str, Any]:
        return self.browser.send(method, self.session, **parameters)

    def run(self, script: str) -> Any:
        """Value of a script, of its promise if it gives one."""
        answer = self.send("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def until(self, script: str) -> Any:
        """Wait until the value of a script is true, and return the value."""
        end = time.monotonic() + PATIENCE
        while not (answer := self._asked(script)):
            assert time.monotonic() < end, f"never came true: {script}"
            time.sleep(0.05)
        return answer

    def _asked(self, script: str) -> Any:
        """Value of a script; nothing while one page gives way to another."""
        try:
            return self.run(script)
        except AssertionError as error:
            if "navigated" in str(error) or "context" in str(error):
                return None
            raise

    def press(self, key: str) -> None:
        """Press and release a key."""
        text = {"Enter": "\r", "Space": " "}.get(key, "")
        name = " " if key == "Space" else key
        code = {"Tab": 9, "Enter": 13, "Space": 32, "End": 35, "Home": 36, "ArrowRight": 39}[key]
        for kind in ("keyDown", "keyUp"):
            self.send("Input.dispatchKeyEvent", type=kind, key=name, code=key, text=text, windowsVirtualKeyCode=code)

    def move_focus(self, inside: "Tab | None" = None) -> None:
        """Press Tab and wait until the focus has moved. ``inside``: the page in a frame that receives the focus."""
        page = inside or self
        page.run("window.focused = document.hasFocus() && document.activeElement; true")
        self.press("Tab")
        page.until("document.hasFocus() && document.activeElement !== window.focused")

    def click(self, script: str) -> None:
        """Click in the middle of an element that a script finds, once it is enabled, not covered and at rest."""
        place = self.until(STILL % script)
        for kind in ("mousePressed", "mouseReleased"):
            self.send("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left", clickCount=1)

    def write(self, text: str) -> None:
        """Write a text where the focus is."""
        self.send("Input.insertText", text=text)

    def upload(self, selector: str, path: Path) -> None:
        """Choose a file for an input."""
        root = self.send("DOM.getDocument")["root"]["nodeId"]
        node = self.send("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self.send("DOM.setFileInputFiles", files=[str(path)], nodeId=node)

    def picture(self, path: Path) -> None:
        """The page as a PNG."""
        path.write_bytes(base64.b64decode(self.send("Page.captureScreenshot", captureBeyondViewport=True)["data"]))

    @property
    def complaints(self) -> list[str]:
        """What the page wrote to the console, threw, or was refused."""
        kinds = ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")
        return [json.dumps(event["params"]) for event in self._own(*kinds)]

    @property
    def requests(self) -> list[str]:
        """Addresses that the page asked for, those it holds in itself left out."""
        asked = [event["params"]["request"]["url"] for event in self._own("Network.requestWillBeSent")]
        return [address for address in asked if not address.startswith(("data:", "blob:"))]

    def _own(self, *methods: str) -> list[dict[str, Any]]:
        return [
            event
            for event in self.browser.events
            if event.get("sessionId") == self.session and event["method"] in methods
        ]
