"""The wheel that `make wheel` builds, installed in a folder; benchmarks/startup.py measures it too."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
_PIP = sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"


def install_wheel(folder: Path) -> Path:
    """Build a wheel with all kernels and install it without its dependencies below ``folder``: the path to import from.

    It takes two minutes of processor time.
    """
    wheels, site = folder / "wheels", folder / "site"
    build = "wheel", "--no-build-isolation", "--no-deps", "--wheel-dir", wheels, ROOT
    subprocess.run([*_PIP, *build], check=True, env={**os.environ, "DALEMBERT_KERNELS": "1"})
    subprocess.run([*_PIP, "install", "--no-deps", "--target", site, *wheels.glob("*.whl")], check=True)
    return site
