"""Build hook: a wheel with all kernels as one object file, where DALEMBERT_KERNELS=1 asks for it."""

import os
import platform
import sys
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class KernelHook(BuildHookInterface):
    """Compiles the kernels, and names the platform in the wheel's tag."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if version == "editable" or os.environ.get("DALEMBERT_KERNELS") != "1":
            return
        sys.path.insert(0, str(Path(self.root) / "src"))
        from dalembert.kernels.everything import build

        for path in build(Path(self.root) / "build" / "kernels", self._progress):
            build_data["force_include"][str(path)] = f"dalembert/kernels/{path.name}"
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{_platform()}"

    def _progress(self, count: int, total: int, symbol: str) -> None:
        self.app.display_info(f"kernel {count}/{total}: {symbol}")


def _platform() -> str:
    """The wheel's platform: the object calls mathematical functions alone, which any C library of Linux has."""
    if platform.system() == "Linux":
        return f"manylinux_2_17_{platform.machine()}"
    return sysconfig.get_platform().replace("-", "_").replace(".", "_")
