"""Harmonic balance: its equations, their Jacobian, and Newton's method."""
