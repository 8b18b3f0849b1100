"""``python -m benchmarks [name ...]``: all benchmarks, or the named ones."""

import sys
from importlib import import_module

from benchmarks import page

NAMES = (
    "steps",
    "chains",
    "beams",
    "joints",
    "sensitivities",
    "adjoint",
    "batches",
    "lanes",
    "cluster",
    "identification",
    "regressions",
    "coverage",
    "swarms",
    "collocation",
    "digits",
    "vibration",
    "events",
    "bolted",
    "interfaces",
    "plate",
    "flexible",
    "spatial",
    "robots",
    "startup",
    "sliders",
    "studio",
)

MORE = {
    "bolted": ("vibration-cost",),
    "flexible": ("flexible-elbow", "flexible-slider-crank", "flexible-chains"),
    "interfaces": ("interface-paths",),
    "spatial": ("spatial-sensitivities",),
}
PAGES = tuple(page for name in NAMES for page in (name, *MORE.get(name, ())))
"""Results that the page shows, in its order."""


def main(chosen: list[str]) -> int:
    unknown = [name for name in chosen if name not in NAMES]
    if unknown:
        print(f"unknown benchmark {unknown[0]!r}; expected some of {', '.join(NAMES)}", file=sys.stderr)
        return 2
    for name in chosen or NAMES:
        import_module(f"benchmarks.{name}").main()
    page.write(PAGES)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
