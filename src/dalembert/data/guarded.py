"""Compiled readers of other packages, in separate processes, since some damaged files crash the process."""

import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

from dalembert.errors import DataError


def guarded(path: Path, what: str, module: str, function: str, **options: Any) -> Any:
    """Return ``module.function(path, **options)``, computed in another process; ``what``: kind of the file, for
    messages.
    """
    command = [sys.executable, "-c", _READER, module, function, str(path), json.dumps(options)]
    done = subprocess.run(command, capture_output=True, check=False)
    if done.returncode < 0:
        raise DataError(f"{path}: cannot be read as {what} (it is damaged: the reader broke down over it)")
    if done.returncode > 0:
        last = done.stderr.decode(errors="replace").strip().splitlines()[-1:]
        raise ValueError(*last)
    return pickle.loads(done.stdout)


_READER = """
import json, pickle, sys
from importlib import import_module
module, function, path, options = sys.argv[1:]
pickle.dump(getattr(import_module(module), function)(path, **json.loads(options)), sys.stdout.buffer)
"""
