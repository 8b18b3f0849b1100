"""Inputs of components: values of signals, or jets of them where a constraint is differentiated by time."""

from typing import Any, NamedTuple

import numpy as np
from numba.extending import overload

from dalembert.kernels.kernel import inlined
from dalembert.multibody.kernels.jets import Jet, jet


class TimeInputs(NamedTuple):
    """Inputs of a component whose signals are jets along time."""

    signals: np.ndarray
    callbacks: np.ndarray


def signal(inputs: Any, number: int) -> Any:
    """Value of a signal, with its rates where the function is differentiated by time."""
    return Jet(*inputs.signals[number]) if isinstance(inputs, TimeInputs) else inputs.signals[number, 0]


@overload(signal)
def _signal(inputs, number):
    if getattr(inputs, "instance_class", None) is TimeInputs:
        return lambda inputs, number: jet(
            inputs.signals[number, 0], inputs.signals[number, 1], inputs.signals[number, 2]
        )
    return lambda inputs, number: inputs.signals[number, 0]


@inlined
def in_time(inputs):
    """Inputs whose signals are jets along time."""
    return TimeInputs(inputs.signals, inputs.callbacks)
