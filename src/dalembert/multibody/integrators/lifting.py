"""States along a direction of differentiation."""

from dalembert.kernels.kernel import inner
from dalembert.multibody.kernels.dual import STEP


@inner
def lift(n, state, direction, target):
    """Complex state: the real one plus the imaginary step along a direction."""
    for i in range(len(state.x)):
        target[0, i] = complex(state.x[i], STEP * direction.x[i])
    for i in range(n):
        target[1, i] = complex(state.v[i], STEP * direction.v[i])
        target[2, i] = complex(state.a[i], STEP * direction.a[i])
