"""The directors of a body: their internal constraints, and the chart by which a rotation changes them."""

from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import stack
from dalembert.multibody.components.spatial.vectors import add_at, at, cross, dot, plus, times
from dalembert.multibody.kernels.charts import Chart, flat
from dalembert.multibody.kernels.elementary import is_any, real, reciprocal, size_of, where
from dalembert.multibody.kernels.kind import Kind


@inlined
def _rotated(x, d, dx):
    """Rates of the directors: delta theta x d_i."""
    for i in range(0, 9, 3):
        dx[i], dx[i + 1], dx[i + 2] = cross(at(d, 0), at(x, i))


@inlined
def _cayley(x, d, dx):
    """Change by Cayley's map, without roots: C(t) d - d = (t x d + t x (t x d) / 2) / (1 + t . t / 4)."""
    t = at(d, 0)
    factor = reciprocal(1.0 + 0.25 * dot(t, t))
    for i in range(0, 9, 3):
        once = cross(t, at(x, i))
        dx[i], dx[i + 1], dx[i + 2] = times(factor, plus(once, times(0.5, cross(t, once))))


@inlined
def _projected(x, r, s):
    """Moments of forces on the directors: d_i x r_i."""
    s[0], s[1], s[2] = plus(plus(cross(at(x, 0), at(r, 0)), cross(at(x, 3), at(r, 3))), cross(at(x, 6), at(r, 6)))


@inlined
def _orthonormal(x, p, m, dx):
    """Newton's iteration for the nearest rotation, D <- 1.5 D - 0.5 D (D^T D), to rounding."""
    before, active = stack(x, 9), 0.0 * real(x[0]) + 1.0
    for i in range(9):
        dx[i] = 0.0 * x[i]
    for _ in range(20):
        largest = 0.0 * active
        for i in range(9):
            before[i] = x[i] + dx[i]
        for i in range(0, 9, 3):
            for j in range(0, 9, 3):
                product = dot(at(before, i), at(before, j))
                if i == j:
                    product -= 1.0
                largest = where(size_of(product) > largest, size_of(product), largest)
                # A lane that has converged keeps its directors, as a sample alone does: the factor is 1 or 0.
                add_at(dx, i, times(-0.5 * active * product, at(before, j)))
        active = where(largest < 1e-8, 0.0, active)  # its square is rounding
        if not is_any(active > 0.0):
            break


@inlined
def _balanced(x, r, dx):
    """Multipliers whose forces on orthonormal directors, as in `_forces`, take off the symmetric part of d_i . r_j."""
    row = 0
    for i in range(0, 9, 3):
        dx[row] = -dot(at(x, i), at(r, i))
        row += 1
        for j in range(i + 3, 9, 3):
            dx[row] = -0.5 * (dot(at(x, i), at(r, j)) + dot(at(x, j), at(r, i)))
            row += 1


@inlined
def _constraint(x, p, m, inputs, g):
    """(d_i . d_i - 1) / 2 and d_i . d_j, i < j."""
    row = 0
    for i in range(0, 9, 3):
        g[row] = 0.5 * (dot(at(x, i), at(x, i)) - 1.0)
        row += 1
        for j in range(i + 3, 9, 3):
            g[row] = dot(at(x, i), at(x, j))
            row += 1


@inlined
def _forces(x, p, m, r):
    row = 9
    for i in range(0, 9, 3):
        add_at(r, i, times(x[row], at(x, i)))
        row += 1
        for j in range(i + 3, 9, 3):
            add_at(r, i, times(x[row], at(x, j)))
            add_at(r, j, times(x[row], at(x, i)))
            row += 1


CHART = Chart(9, 3, _rotated, _cayley, _orthonormal, _projected, _balanced)
DIRECTORS = Kind(
    "directors",
    coordinates=9,
    multipliers=6,
    numbers=(),
    constraint=_constraint,
    forces=_forces,
    chart=CHART,
)
#: Charts of the coordinates of a body: origin and directors.
POSE = (flat(3), CHART)
