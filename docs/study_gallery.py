"""The gallery of studies: a page for each folder of ``studies/``, with a drawing of its model and its files.

Sphinx calls :func:`write` before it reads the pages. ``docs/gallery/index.md`` and ``docs/index.md`` say by a comment,
``<!-- gallery: six-joint-robot duffing -->`` or ``<!-- gallery -->``, where pictures stand.
"""

import logging
import re
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from dalembert.errors import DalembertError
from dalembert.files import write_text
from dalembert.study import load
from dalembert.study.picture import picture_or_message
from dalembert.study.tables.study import Study

STUDIES = Path(__file__).parents[1] / "studies"
SUFFIX = ".gallery"
"""Of generated pages, which are Markdown; not ``.md``, since their examples are those of ``studies/``."""
GROUPS = ("Mechanisms in the plane", "Mechanisms in space", "Structures that vibrate")
COMMENT = re.compile(r"<!-- gallery(?::([^>]*))? -->")


@dataclass(frozen=True)
class Shown:
    """A folder with studies.

    Parameters
    ----------
    folder : Path
    title, text : str
        Heading of its README, and what follows.
    studies : tuple of Study
        Those without mistakes; the first one is drawn.
    """

    folder: Path
    title: str
    text: str
    studies: tuple[Study, ...]

    @property
    def name(self) -> str:
        return self.folder.name

    @property
    def group(self) -> str:
        """Part of the gallery that the folder belongs to."""
        if self.studies[0].file.vibrates:
            return GROUPS[2]
        return GROUPS[self.studies[0].file.model.space is True]

    @property
    def files(self) -> list[Path]:
        """The study files, and the models that they share."""
        return sorted(path for path in self.folder.glob("*.toml") if path.name != "expected.toml")

    def page(self) -> str:
        """The page in Markdown: the drawing, what there is to learn, and the study files."""
        text = re.sub(r"\]\(\.\./([\w-]+)/README\.md\)", rf"](\1{SUFFIX})", self.text)
        parts = [f"# {self.title}", f"![Drawing of the model](pictures/{self.name}.svg)", text, "## Study files"]
        return "\n\n".join([*parts, *map(_file, self.files)]) + "\n"


def shown(folders: Iterable[Path]) -> list[Shown]:
    """Return the folders that have studies, by name."""
    found = []
    for folder in sorted(folders):
        readme = folder / "README.md"
        if readme.is_file() and (studies := tuple(_studies(folder))):
            heading, _, text = readme.read_text(encoding="utf-8").partition("\n")
            found.append(Shown(folder, heading.removeprefix("# ").strip(), text.strip(), studies))
    return found


def write(target: Path, folders: Iterable[Path] | None = None) -> None:
    """Write the pages and their pictures into a folder; remove those of former builds."""
    logging.getLogger("skfem").setLevel(logging.WARNING)  # Sphinx shows what it says of each mesh
    known = shown(STUDIES.iterdir() if folders is None else folders)
    for page in target.glob(f"*{SUFFIX}"):
        page.unlink()
    shutil.rmtree(target / "pictures", ignore_errors=True)
    (target / "pictures").mkdir(parents=True)
    for one in known:
        write_text(target / "pictures" / f"{one.name}.svg", picture_or_message(one.studies[0].path))
        write_text(target / f"{one.name}{SUFFIX}", one.page())


def with_pictures(text: str, below: str = "") -> str:
    """Return a page with pictures in the place of its comments.

    Parameters
    ----------
    text : str
        A page in Markdown.
    below : str
        Path from the page to the gallery, such as ``"gallery/"``.
    """
    if not COMMENT.search(text):
        return text
    known = {one.name: one for one in shown(STUDIES.iterdir())}

    def grid(found: re.Match[str]) -> str:
        if found[1]:
            return _grid([known[name] for name in found[1].split()], below)
        groups = {group: [one for one in known.values() if one.group == group] for group in GROUPS}
        return "\n\n".join(f"## {group}\n\n{_grid(own, below)}" for group, own in groups.items())

    return COMMENT.sub(grid, text)


def _grid(studies: Iterable[Shown], below: str) -> str:
    cards = [
        f"```{{figure}} {below}pictures/{one.name}.svg\n:target: {below}{one.name}.html\n:alt: Drawing\n\n"
        f"[{one.title}]({below}{one.name}{SUFFIX})\n```"
        for one in studies
    ]
    return "\n".join(["::::{container} gallery", *cards, "::::"])


def _file(path: Path) -> str:
    """A file, folded away."""
    text = path.read_text(encoding="utf-8").rstrip()
    return f"<details>\n<summary><code>{path.name}</code></summary>\n\n```toml\n{text}\n```\n\n</details>"


def _studies(folder: Path) -> Iterator[Study]:
    """Studies of a folder, the one that its README names first at the front."""
    readme = (folder / "README.md").read_text(encoding="utf-8")
    places = {path: readme.find(path.name) for path in folder.glob("*.toml") if path.name != "expected.toml"}
    for path in sorted(places, key=lambda path: (places[path] < 0, places[path], path.name)):
        try:
            yield load(path)
        except DalembertError:
            continue  # a model that studies share
