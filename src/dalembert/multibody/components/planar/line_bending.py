"""Curvature of a line r, and its part of a stiffness matrix: shared by the ANCF cable and the structural beam.

With t = r' and c = r'', kappa = (t x c)/|t|^2. Both are sums of an element's vectors, with factors ``s`` and ``c``.
"""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.kernels.elementary import reciprocal


@inlined
def curvature(tx, ty, cx, cy):
    """Curvature, and its derivatives by r' = (tx, ty); those by r'' are (-ty, tx) over the square, the last value."""
    square = reciprocal(tx * tx + ty * ty)
    kappa = (tx * cy - ty * cx) * square
    return kappa, (cy - 2 * kappa * tx) * square, -(cx + 2 * kappa * ty) * square, square
