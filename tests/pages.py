"""Written reports, read as a browser would."""

import base64
import csv
import io
from html.parser import HTMLParser
from pathlib import Path


class Page(HTMLParser):
    """Tags, links and scripts of a page, as a browser would find them."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags, self.addresses, self.scripts, self.words = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self.addresses += [value for name, value in attrs if name in ("src", "href", "srcset", "action", "data")]

    def handle_data(self, data):
        if self.tags and self.tags[-1][0] == "script" and self.cdata_elem == "script":
            self.scripts.append((self.tags[-1][1], data))
        else:
            self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())

    def table(self, name: str) -> list[list[str]]:
        """Content of the CSV that is offered under this name."""
        link = next(attrs["href"] for tag, attrs in self.tags if tag == "a" and attrs.get("download") == f"{name}.csv")
        return list(csv.reader(io.StringIO(base64.b64decode(link.partition(",")[2]).decode())))


def read_page(path: Path) -> Page:
    """The page in a file."""
    return Page(path.read_text(encoding="utf-8"))
