"""The generalized-alpha method, and its discrete adjoint."""
