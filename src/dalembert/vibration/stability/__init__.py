"""Stability of periodic motions."""
