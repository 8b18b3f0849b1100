"""What a result came from."""

import json
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import scipy

import dalembert
from dalembert.forward.model import ForwardModel


def provenance(model: ForwardModel, method: object = None, **settings: Any) -> dict[str, Any]:
    """Versions, hashes of model and data, method if there is one, settings, as JSON holds them; no times, no paths."""
    options = {field.name: getattr(method, field.name) for field in fields(method)} if is_dataclass(method) else {}
    described = {} if method is None else {"method": {"name": type(method).__name__, "settings": options}}
    return json.loads(
        json.dumps(
            {
                "version": dalembert.__version__,
                "numpy": np.__version__,
                "scipy": scipy.__version__,
                "model": model.fingerprint,
                **described,
                **settings,
            },
            default=str,
            sort_keys=True,
        )
    )
