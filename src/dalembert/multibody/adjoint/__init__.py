"""Gradients of motions by the discrete adjoint, at a price that does not grow with the number of parameters."""
