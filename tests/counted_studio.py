"""A studio that lets go of left pages soon, and says how many it keeps: ``python counted_studio.py FOLDER``."""

import gc
import sys
from pathlib import Path

from dalembert.studio import server
from dalembert.studio.panels.data import DataPanel

PAGES = "/kept-pages"


def main() -> None:
    """Run the studio; the address of ``PAGES`` answers with the number of study pages in memory."""
    server.PATIENCE = 0.5
    build = server.application

    def application(root: Path, *, far: bool = False):
        app = build(root, far=far)

        def kept_pages() -> int:
            gc.collect()
            return sum(type(thing) is DataPanel for thing in gc.get_objects())

        app.get(PAGES)(kept_pages)
        app.router.routes.insert(0, app.router.routes.pop())  # before the pages, which take every address
        return app

    server.application = application
    server.serve(Path(sys.argv[1]), port=0, browser=False)


if __name__ == "__main__":
    main()
