"""What a result came from."""

import json
from dataclasses import asdict, is_dataclass
from typing import Any

import numpy as np
import scipy

import dalembert
from dalembert.data import Measurements
from dalembert.forward import ForwardModel


def provenance(model: ForwardModel, data: Measurements, method: object, **settings: Any) -> dict[str, Any]:
    """Versions, hashes of model and data, method and settings, in what JSON can hold; no times and no paths."""
    own = asdict(method) if is_dataclass(method) and not isinstance(method, type) else {}
    return json.loads(
        json.dumps(
            {
                "version": dalembert.__version__,
                "numpy": np.__version__,
                "scipy": scipy.__version__,
                "model": model.fingerprint,
                "data": data.fingerprint,
                "method": {"name": type(method).__name__, "settings": own},
                **settings,
            },
            default=str,
            sort_keys=True,
        )
    )
