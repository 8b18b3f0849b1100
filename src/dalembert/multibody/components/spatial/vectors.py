"""Vectors of three numbers, as tuples, in kernels: real or complex numbers, or jets."""

from dalembert.kernels.kernel import inlined


@inlined
def plus(a, b):
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inlined
def minus(a, b):
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inlined
def times(factor, a):
    """factor a."""
    return factor * a[0], factor * a[1], factor * a[2]


@inlined
def dot(a, b):
    """a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def cross(a, b):
    """a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inlined
def combined(c, d1, d2, d3):
    """c_1 d_1 + c_2 d_2 + c_3 d_3."""
    return (
        c[0] * d1[0] + c[1] * d2[0] + c[2] * d3[0],
        c[0] * d1[1] + c[1] * d2[1] + c[2] * d3[1],
        c[0] * d1[2] + c[1] * d2[2] + c[2] * d3[2],
    )


@inlined
def at(x, k):
    """Entries k, k + 1 and k + 2 of an array."""
    return x[k], x[k + 1], x[k + 2]


@inlined
def add_at(r, k, a):
    """Add a to entries k, k + 1 and k + 2 of an array."""
    r[k] += a[0]
    r[k + 1] += a[1]
    r[k + 2] += a[2]
